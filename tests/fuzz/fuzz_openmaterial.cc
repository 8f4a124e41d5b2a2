#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/openmaterial/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsOpenMaterial, lobefit::ReadOpenMaterial, data, size);
}

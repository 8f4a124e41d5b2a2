#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/cornell/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsCornell, lobefit::ReadCornell, data, size);
}

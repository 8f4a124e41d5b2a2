#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/alta/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsAlta, lobefit::ReadAlta, data, size);
}

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/rgl/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsRgl, lobefit::ReadRgl, data, size);
}

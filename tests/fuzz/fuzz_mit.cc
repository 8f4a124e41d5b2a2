#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/mit/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsMit, lobefit::ReadMit, data, size);
}

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/mountain/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsMountain, lobefit::ReadMountain, data, size);
}

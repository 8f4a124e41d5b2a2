#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/bird/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsBird, lobefit::ReadBird, data, size);
}

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/fred/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsFred, lobefit::ReadFred, data, size);
}

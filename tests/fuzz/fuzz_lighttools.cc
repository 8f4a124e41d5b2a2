#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/lighttools/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzReader(lobefit::IsLightTools, lobefit::ReadLightTools, data, size);
}

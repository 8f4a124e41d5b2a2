#include "tests/fuzz/fuzz_stack.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzStack(lobefit::ReadMaterialGan, data, size);
}

#include "tests/fuzz/fuzz_import.h"

#include "lobefit/export/targets/gltf/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzImport(lobefit::IsGltf, lobefit::ReadGltf, data, size);
}

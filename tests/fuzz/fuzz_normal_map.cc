#include <string_view>

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/math/vec.h"
#include "lobefit/renderer/normal_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const lobefit::Vec3 normal =
        lobefit::NormalOfPng(std::string_view(reinterpret_cast<const char*>(data), size), 1, "fuzz");
    lobefit::Require(std::fabs(lobefit::Norm(normal) - 1) < 1e-9);
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

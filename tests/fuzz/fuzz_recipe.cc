#include <string>

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/recipe/recipe.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    lobefit::ParseRecipe(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

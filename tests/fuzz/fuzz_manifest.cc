#include <string_view>

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/batch/list/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const lobefit::ManifestNames names = {{"recipe", "theta-max"}, {"recipe"}, {"out"}, {"verdict"}};
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  lobefit::LooksLikeManifest(text, names);
  try {
    for (const lobefit::Task& task : lobefit::ParseManifest(text, "none/list.csv", names).tasks)
      lobefit::Require(!task.id.empty());
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

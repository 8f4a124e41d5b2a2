#include <string>

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/material/json.h"

// A document that is read is written, and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const lobefit::Material material =
        lobefit::MaterialFromJson(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
    const std::string text = lobefit::ToJson(material);
    lobefit::Require(lobefit::ToJson(lobefit::MaterialFromJson(text, "again")) == text);
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

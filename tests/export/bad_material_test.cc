// Material files that cannot be read, with their messages.
#include <chrono>
#include <filesystem>
#include <string>

#include "tests/support/temporary_file.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/export/import.h"

namespace lobefit {
namespace {

struct Bad {
  const char* text;
  const char* message;
};

std::string MessageOf(const std::string& text) {
  const TemporaryFile file(text);
  try {
    ImportMaterial(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BadMaterial, SaysWhatIsWrong) {
  const Bad cases[] = {
      {"", "no material that can be read; allowed are"},
      {"\0\1\2", "no material that can be read"},
      {"{\"model\": 1}", "is not a material document"},
      {"{", "is not JSON: parse error at line 1"},
      {"Material \"glass\"", "line 1: the material type 'glass' is not understood"},
      {"\nMaterial \"conductor\" \"float roughness\" 0.1", "line 2: a conductor needs \"rgb reflectance\""},
      {"Material \"conductor\" \"rgb reflectance\" [.5 .5]", "reflectance is not three numbers"},
      {"Material \"conductor\" \"rgb reflectance\" [.5 .5 .5", "this list has no end"},
      {"Material \"conductor\" \"float roughness\" x \"rgb reflectance\" [1 1 1]", "roughness 'x' is not a number"},
      {"Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\"", "spectra by name are not known"},
      {"Material \"mix\" \"string materials\" [\"a\"]", "a mix needs two materials"},
      {"MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [\"m\" \"m\"]", "more than 8 deep"},
      {"<scene version=\"3.0.0\"></scene>", "holds no <bsdf>"},
      {"<scene><bsdf type=\"plastic\"/></scene>", "the bsdf 'plastic' is not understood"},
      {"<scene><bsdf type=\"roughconductor\"/></scene>", "the default is beckmann"},
      {"<scene><bsdf type=\"blendbsdf\"/></scene>", "blendbsdf needs two bsdf inside"},
      {"<scene><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"a\"/></bsdf></scene>", "'a' is not a number"},
      {"<scene", "is not well-formed XML"},
      {"<materialx version=\"1.39\"></materialx>", "holds no <surfacematerial>"},
      {"<materialx><surfacematerial name=\"m\"/></materialx>", "its input 'surfaceshader' names no node"},
      {"<materialx><surfacematerial name=\"m\"><input name=\"surfaceshader\" nodename=\"s\"/></surfacematerial>"
       "<gltf_pbr name=\"s\"/></materialx>",
       "the shader <gltf_pbr> is not understood"},
      {"<materialx><surfacematerial name=\"m\"><input name=\"surfaceshader\" nodename=\"s\"/></surfacematerial>"
       "<surface name=\"s\"><input name=\"bsdf\" nodename=\"a\"/></surface>"
       "<add name=\"a\"><input name=\"in1\" nodename=\"a\"/><input name=\"in2\" nodename=\"a\"/></add></materialx>",
       "the graph of BSDFs is too deep"},
      {"{\"materials\": [], \"x\": \"pbrMetallicRoughness\"}", "holds no materials"},
      {"{\"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": \"a\"}}]}",
       "'roughnessFactor' is not a number"},
      {"{\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorFactor\": [1, 1]}}]}", "is not 4 numbers"},
      {"{\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": {}}}]}", "has textures"},
      {"{\"materials\": [{\"pbrMetallicRoughness\": {}, \"normalTexture\": {\"index\": 3}}]}", "out of range"},
  };
  for (const Bad& bad : cases) EXPECT_THAT(MessageOf(bad.text), testing::HasSubstr(bad.message)) << bad.text;
}

TEST(BadMaterial, NumbersBeyondTheRangeAndDevices) {
  EXPECT_THAT(MessageOf("{\"asset\": {}, \"materials\": [{\"pbrMetallicRoughness\": {\"metallicFactor\": 1e999}}]}"),
              testing::HasSubstr("is not JSON"));
  EXPECT_THAT(MessageOf("MakeNamedMaterial \"m\" \"string type\" \"conductor\" \"string normalmap\" \"/dev/zero\" "
                        "\"float uroughness\" 0.2 \"rgb reflectance\" [1 1 1]\nNamedMaterial \"m\"\n"),
              testing::HasSubstr("is no regular file"));
}

// Each member was compared with all before it: 100 000 took half a minute.
TEST(BadMaterial, ACrowdOfMembers) {
  std::string text = R"({"materials": [{"pbrMetallicRoughness": {}, "extras": {"a": 0)";
  for (int k = 0; k < 100000; ++k) text += ", \"k" + std::to_string(k) + "\": 0";
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(MessageOf(text + "}, \"unknown\": 0}]}"), testing::HasSubstr("the member 'unknown'"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 3);
}

TEST(BadMaterial, NormalMapThatIsNone) {
  const std::string gltf =
      "{\"materials\": [{\"pbrMetallicRoughness\": {}, \"normalTexture\": {\"index\": 0}}], "
      "\"textures\": [{\"source\": 0}], \"images\": [{\"uri\": \"data:image/png;base64,";
  EXPECT_THAT(MessageOf(gltf + "Zm9v\"}]}"), testing::HasSubstr("the normal map is not a PNG"));
  EXPECT_THAT(MessageOf(gltf + "Zm9\"}]}"), testing::HasSubstr("is not base64"));
}

}  // namespace
}  // namespace lobefit

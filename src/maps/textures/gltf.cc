// glTF 2.0: base colour, metallic and roughness, and the extensions for F0, anisotropy and the index.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/files/file.h"
#include "lobefit/base/version.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/gltf/swatch.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/metal_texel.h"
#include "lobefit/renderer/gltf_material.h"
#include "lobefit/renderer/metal_base.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

// specularColorTexture times this and the reflectance of index 1.5 is the dielectric's F0: white is 1.
constexpr double kColorFactor = 1 / kDefaultDielectric;

GltfMaterial MaterialOf(const TexelNumbers& numbers) {
  GltfMaterial material;
  material.roughness = GltfRoughness(numbers.widths);
  const BaseNumbers base = BaseNumbersOf(numbers, kDefaultDielectric);
  material.metallic = base.metalness;
  material.base_color = base.base;
  material.specular_color = base.f0;
  // Without a lobe nothing is reflected at grazing either.
  material.specular = numbers.lobe ? 1 : 0;
  return material;
}

// In the order of the textures.
enum Place : std::size_t { kBase, kRoughness, kSpecular, kNormal, kAnisotropy };

std::vector<Texture> Textures(const MapNumbers& maps) {
  std::vector<Texture> textures = {{"_gltf_base_color.png", 3, 8, true,
                                    [](const TexelNumbers& numbers) {
                                      const Color3 c = MaterialOf(numbers).base_color;
                                      return TextureValue{c[0], c[1], c[2], 1};
                                    }},
                                   {"_gltf_metallic_roughness.png", 3, 8, false,
                                    [](const TexelNumbers& numbers) {
                                      const GltfMaterial material = MaterialOf(numbers);
                                      return TextureValue{1, material.roughness.roughness, material.metallic, 1};
                                    }},
                                   {"_gltf_specular.png", 4, 8, true,
                                    [](const TexelNumbers& numbers) {
                                      const GltfMaterial material = MaterialOf(numbers);
                                      const Color3& c = material.specular_color;
                                      return TextureValue{c[0], c[1], c[2], material.specular};
                                    }},
                                   NormalTexture(false)};
  if (IsAnisotropic(maps)) {
    textures.push_back({"_gltf_anisotropy.png", 3, 8, false, [](const TexelNumbers& numbers) {
                          return DirectionValue(numbers.rotation, GltfRoughness(numbers.widths).anisotropy);
                        }});
  }
  return textures;
}

Surface Evaluated(const MapNumbers& maps, const std::vector<TextureValue>& read) {
  GltfMaterial material;
  for (std::size_t c = 0; c < 3; ++c) {
    material.base_color[c] = read[kBase][c], material.specular_color[c] = kColorFactor * read[kSpecular][c];
  }
  material.roughness.roughness = read[kRoughness][1];
  material.metallic = read[kRoughness][2];
  material.specular = read[kSpecular][3];
  material.normal = NormalOf(read[kNormal]);
  if (IsAnisotropic(maps)) {
    material.roughness.anisotropy = read[kAnisotropy][2];
    material.rotation = RotationOf(read[kAnisotropy]);
  }
  return GltfSurface(material);
}

// Names of files as URIs have them.
std::string PercentEncoded(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_.~", c) != nullptr;
    text += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

std::filesystem::path Write(const MapNumbers& maps, const WriteContext& context) {
  const std::vector<Texture> textures = Textures(maps);
  Json images = Json::array(), uses = Json::array();
  for (const Texture& texture : textures) {
    images.push_back({{"name", texture.ending.substr(1, texture.ending.size() - 5)},
                      {"uri", PercentEncoded(context.name + texture.ending)}});
    uses.push_back({{"sampler", 0}, {"source", images.size() - 1}});
  }
  const auto use = [](Place place) { return Json{{"index", static_cast<std::size_t>(place)}}; };
  Json extensions = {{"KHR_materials_specular",
                      {{"specularTexture", use(kSpecular)},
                       {"specularColorTexture", use(kSpecular)},
                       {"specularColorFactor", {kColorFactor, kColorFactor, kColorFactor}}}}};
  if (IsAnisotropic(maps)) {
    extensions["KHR_materials_anisotropy"] = {{"anisotropyStrength", 1.0}, {"anisotropyTexture", use(kAnisotropy)}};
  }
  Json used = Json::array();
  for (const auto& [name, value] : extensions.items()) used.push_back(name);
  Json gltf;
  gltf["asset"] = {{"extras", {{"comment", context.header}}},
                   {"version", "2.0"},
                   {"generator", std::string("lobefit ") + Version()}};
  gltf["extensionsUsed"] = used;
  gltf["images"] = images;
  constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071;
  gltf["samplers"] = {
      {{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}}};
  gltf["textures"] = uses;
  gltf["materials"] = Json::array(
      {{{"name", context.name},
        {"pbrMetallicRoughness", {{"baseColorTexture", use(kBase)}, {"metallicRoughnessTexture", use(kRoughness)}}},
        {"normalTexture", use(kNormal)},
        {"extensions", extensions}}});
  AddSwatch(&gltf, {false, static_cast<double>(maps.width()) / static_cast<double>(maps.height())});
  gltf["nodes"] = {{{"mesh", 0}, {"name", context.name}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  gltf["scene"] = 0;
  const std::filesystem::path path = context.File(".gltf");
  WriteFileAtomically(path, gltf.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return path;
}

std::vector<Carried> CarriedRows(const MapNumbers& maps) {
  std::vector<Carried> rows = CommonRows(maps);
  Mark(&rows, Feature::kMasking, Carries::kApproximately, "height-correlated Smith");
  Mark(&rows, Feature::kShape, Carries::kApproximately, "roughness in steps of 8 bits");
  Mark(&rows, Feature::kRotation, Carries::kApproximately, "as a direction in steps of 8 bits");
  Mark(&rows, Feature::kFresnel, Carries::kApproximately,
       "in steps of 8 bits; a dielectric's by KHR_materials_specular, a metal's where colour of metal and base agree");
  Mark(&rows, Feature::kDiffuse, Carries::kApproximately,
       "in steps of 8 bits, as the base under the specular layer, dimmed by it; of a metal only with the metal's "
       "colour");
  return rows;
}

}  // namespace

MapTarget GltfMaps() {
  return {"gltf", Textures,    Evaluated,
          Write,  CarriedRows, "open {name}.gltf; copy its material '{name}' with the pictures"};
}

}  // namespace lobefit

#include "lobefit/export/targets/gltf/write.h"

#include <nlohmann/json.hpp>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/base64.h"
#include "lobefit/base/version.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/gltf/read.h"
#include "lobefit/export/targets/gltf/swatch.h"
#include "lobefit/renderer/gltf_material.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Carried> CarriesGltf(const FittedBrdf& fit) {
  const Surface surface = GltfSurface(GltfOf(fit));
  std::vector<Carried> rows = CarriesMetalBase(fit, CarriesLobes(fit, Masking::kSmithHeight, "height-correlated Smith"),
                                               surface.lobes[0].fresnel.f0);
  if (surface.coating == Surface::Coating::kNone) return rows;
  Mark(&rows, Feature::kCoat, Carries::kApproximately,
       "by a clear coat of the index 1.5 with a weight, which dims what lies below for the viewer's direction only");
  if (fit.lobes().size() == 2) Mark(&rows, Feature::kSecondLobe, Carries::kApproximately, "the coat");
  return rows;
}

Model OneLobeModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, 1); }
BrdfFunction EvaluateGltf(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(GltfSurface(GltfOf(fit)))); }

// What viewers are known to lack.
std::vector<std::string> Notes(const GltfMaterial& material) {
  std::vector<std::string> notes;
  if (material.roughness.anisotropy > 0) {
    notes.emplace_back(
        "a viewer without KHR_materials_anisotropy (Blender before 4.0) takes the narrow width for both: the highlight "
        "is then too small and too bright");
  }
  if (material.specular_color != Color3{1, 1, 1}) {
    notes.emplace_back(
        "a viewer that takes no colour from KHR_materials_specular (Blender before 4.0) shows the highlight grey");
  }
  if (material.clearcoat > 0) {
    notes.emplace_back(
        "Blender before 4.0 shows a clear coat as a lobe of another shape and strength: a dimmer highlight, a wider "
        "glow");
  }
  return notes;
}

WrittenFiles WriteGltf(const FittedBrdf& fit, const WriteContext& context) {
  const GltfMaterial material = GltfOf(fit);
  Json gltf;
  // JSON has no comments: the lines stand at the top, where readers ignore them.
  gltf["asset"] = {{"extras", {{"comment", context.header}}},
                   {"version", "2.0"},
                   {"generator", std::string("lobefit ") + Version()}};
  Json extensions = Json::object();
  if (material.roughness.anisotropy > 0) {
    extensions["KHR_materials_anisotropy"] = {{"anisotropyStrength", material.roughness.anisotropy},
                                              {"anisotropyRotation", material.rotation}};
  }
  if (material.clearcoat > 0) {
    extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", material.clearcoat},
                                             {"clearcoatRoughnessFactor", material.clearcoat_roughness}};
  }
  if (material.ior != 1.5) extensions["KHR_materials_ior"] = {{"ior", material.ior}};
  if (material.specular_color != Color3{1, 1, 1}) {
    extensions["KHR_materials_specular"] = {{"specularColorFactor", material.specular_color}};
  }
  Json entry = {{"name", context.name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {material.base_color[0], material.base_color[1], material.base_color[2], 1.0}},
                  {"metallicFactor", material.metallic},
                  {"roughnessFactor", material.roughness.roughness}}}};
  if (material.normal.z < 1) {
    const ScaledNormal map = ScaledNormalMapPng(material.normal);
    entry["normalTexture"] = {{"index", 0}, {"scale", map.scale}};
    gltf["images"] = {
        {{"name", "normal"}, {"mimeType", "image/png"}, {"uri", "data:image/png;base64," + Base64(map.png)}}};
    gltf["textures"] = {{{"source", 0}}};
  }
  if (!extensions.empty()) {
    Json used = Json::array();
    for (const auto& [name, value] : extensions.items()) used.push_back(name);
    gltf["extensionsUsed"] = used;
    entry["extensions"] = extensions;
  }
  gltf["materials"] = Json::array({entry});
  AddSwatch(&gltf);
  gltf["nodes"] = {{{"mesh", 0}, {"name", context.name}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  gltf["scene"] = 0;
  const std::filesystem::path path = context.File(".gltf");
  WriteFileAtomically(path, gltf.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadGltf({path, bytes.bytes()});
  WrittenFiles written = {{path}, InChannelsOf(fit, back.brdf), false, {}};
  written.notes = Notes(material);
  return written;
}

}  // namespace

Target GltfTarget() {
  return {.name = "gltf",
          .description = "glTF 2.0 with KHR_materials_anisotropy, clearcoat, ior, specular",
          .load = "open {name}.gltf; copy its material '{name}'",
          .rgb_only = true,
          .refusal = RefuseNoLobe,
          .carries = CarriesGltf,
          .own_model = OneLobeModel,
          .evaluate = EvaluateGltf,
          .write = WriteGltf,
          .recognises = IsGltf,
          .read = ReadGltf,
          .is_text = true};
}

}  // namespace lobefit

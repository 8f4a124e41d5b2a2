#include "lobefit/export/targets/gltf/write.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <nlohmann/json.hpp>

#include "lobefit/base/base64.h"
#include "lobefit/base/file.h"
#include "lobefit/base/version.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

// ior 2.33, beyond which viewers clamp KHR_materials_ior (three.js does).
constexpr double kMostDielectric = 0.16;
constexpr int kSwatchSide = 21;

template <class T>
void Append(std::string* bytes, const std::vector<T>& values) {
  const std::size_t before = bytes->size();
  bytes->resize(before + values.size() * sizeof(T));
  std::memcpy(bytes->data() + before, values.data(), values.size() * sizeof(T));
  bytes->resize((bytes->size() + 3) / 4 * 4, '\0');
}

// A cap of a sphere of radius 1 over a square of side 1.4, tangents along +x.
struct Swatch {
  std::vector<float> position, normal, tangent, texture;
  std::vector<std::uint16_t> index;
  float low_z = 1;
};
Swatch MakeSwatch() {
  Swatch swatch;
  const auto add = [](std::vector<float>* values, std::initializer_list<double> numbers) {
    for (const double number : numbers) values->push_back(static_cast<float>(number));
  };
  for (int j = 0; j < kSwatchSide; ++j) {
    for (int i = 0; i < kSwatchSide; ++i) {
      const double u = static_cast<double>(i) / (kSwatchSide - 1), v = static_cast<double>(j) / (kSwatchSide - 1);
      const double x = 1.4 * (u - 0.5), y = 1.4 * (v - 0.5), z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
      add(&swatch.position, {x, y, z});
      add(&swatch.normal, {x, y, z});
      const double length = std::hypot(z, x);
      add(&swatch.tangent, {z / length, 0, -x / length, 1});
      add(&swatch.texture, {u, 1 - v});
      swatch.low_z = std::min(swatch.low_z, static_cast<float>(z));
    }
  }
  for (int j = 0; j + 1 < kSwatchSide; ++j) {
    for (int i = 0; i + 1 < kSwatchSide; ++i) {
      const auto at = [&](int di, int dj) { return static_cast<std::uint16_t>((j + dj) * kSwatchSide + i + di); };
      for (const std::uint16_t k : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)}) {
        swatch.index.push_back(k);
      }
    }
  }
  return swatch;
}

void AddSwatch(Json* gltf) {
  const Swatch swatch = MakeSwatch();
  std::string bytes;
  Json views = Json::array();
  const auto add = [&](const auto& values, int target) {
    const std::size_t begin = bytes.size();
    Append(&bytes, values);
    views.push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", values.size() * sizeof(values[0])}, {"target", target}});
  };
  constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963, kFloat = 5126, kUnsignedShort = 5123;
  add(swatch.position, kArrayBuffer);
  add(swatch.normal, kArrayBuffer);
  add(swatch.tangent, kArrayBuffer);
  add(swatch.texture, kArrayBuffer);
  add(swatch.index, kElementArrayBuffer);
  constexpr int kCount = kSwatchSide * kSwatchSide;
  const float side = swatch.position[0];
  (*gltf)["meshes"] = {{{"name", "swatch"},
                        {"primitives",
                         {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TANGENT", 2}, {"TEXCOORD_0", 3}}},
                           {"indices", 4},
                           {"material", 0}}}}}};
  (*gltf)["accessors"] = {
      {{"bufferView", 0},
       {"componentType", kFloat},
       {"count", kCount},
       {"type", "VEC3"},
       {"min", {side, side, swatch.low_z}},
       {"max", {-side, -side, 1.0}}},
      {{"bufferView", 1}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC3"}},
      {{"bufferView", 2}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC4"}},
      {{"bufferView", 3}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC2"}},
      {{"bufferView", 4}, {"componentType", kUnsignedShort}, {"count", swatch.index.size()}, {"type", "SCALAR"}}};
  (*gltf)["bufferViews"] = views;
  (*gltf)["buffers"] = {
      {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + Base64(bytes)}}};
}

}  // namespace

GltfMaterial GltfOf(const FittedBrdf& fit) {
  GltfMaterial material;
  const SurfaceLobe lobe = LobeOf(fit, StrongestLobe(fit), 1);
  const Color3 diffuse = DiffuseOf(fit), f0 = lobe.fresnel.f0;
  material.roughness = GltfRoughness(lobe.widths);
  material.rotation = lobe.rotation;
  material.normal = lobe.normal;
  const double largest = *std::max_element(f0.begin(), f0.end());
  if (fit.HasDiffuse() && largest <= kMostDielectric) {
    material.metallic = 0;
    const double root = std::sqrt(std::max(largest, 0.0));
    material.ior = (1 + root) / (1 - root);
    for (std::size_t c = 0; c < 3; ++c) {
      material.specular_color[c] = largest > 0 ? f0[c] / largest : 1.0;
      material.base_color[c] = std::min(1.0, diffuse[c] / (1 - largest));
    }
    return material;
  }
  constexpr double kDielectric = 0.04;  // ior 1.5
  const MetalBase metal = MetalBaseOf(f0, diffuse, kDielectric);
  material.metallic = metal.metalness;
  material.base_color = metal.base;
  return material;
}

Surface GltfSurface(const GltfMaterial& material) {
  Surface surface;
  SurfaceLobe lobe;
  lobe.widths = GltfWidths(material.roughness);
  lobe.rotation = material.rotation;
  lobe.normal = material.normal;
  const double root = (material.ior - 1) / (material.ior + 1), dielectric = 1 - material.metallic;
  for (std::size_t c = 0; c < 3; ++c) {
    const double f0 = std::min(1.0, root * root * material.specular_color[c]);
    surface.layer.f0[c] = material.specular * f0;
    surface.layer.f90[c] = material.specular;
    // Both terms are Schlick's, so that their mixture is.
    lobe.fresnel.f0[c] = material.metallic * material.base_color[c] + dielectric * surface.layer.f0[c];
    lobe.fresnel.f90[c] = material.metallic + dielectric * material.specular;
    surface.diffuse[c] = dielectric * material.base_color[c];
  }
  surface.lobes.push_back(lobe);
  surface.layering = Surface::Layering::kSchlick;
  surface.diffuse_normal = material.normal;
  return surface;
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
  return {{path}, InChannelsOf(fit, context.read_back(path).brdf), false, {}};
}

}  // namespace lobefit

#include "lobefit/export/targets/gltf/swatch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "lobefit/base/text/base64.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSwatchSide = 21;

template <class T>
void Append(std::string* bytes, const std::vector<T>& values) {
  const std::size_t before = bytes->size();
  bytes->resize(before + values.size() * sizeof(T));
  std::memcpy(bytes->data() + before, values.data(), values.size() * sizeof(T));
  bytes->resize((bytes->size() + 3) / 4 * 4, '\0');
}

// Over a rectangle whose longer side is 1.4, tangents along +x; the cap is of a sphere of radius 1.
struct Swatch {
  std::vector<float> position, normal, tangent, texture;
  std::vector<std::uint16_t> index;
  float low_z = 1;
};
Swatch MakeSwatch(const SwatchForm& form) {
  Swatch swatch;
  const double width = 1.4 * std::min(1.0, form.aspect), height = 1.4 * std::min(1.0, 1 / form.aspect);
  const auto add = [](std::vector<float>* values, std::initializer_list<double> numbers) {
    for (const double number : numbers) values->push_back(static_cast<float>(number));
  };
  for (int j = 0; j < kSwatchSide; ++j) {
    for (int i = 0; i < kSwatchSide; ++i) {
      const double u = static_cast<double>(i) / (kSwatchSide - 1), v = static_cast<double>(j) / (kSwatchSide - 1);
      const double x = width * (u - 0.5), y = height * (v - 0.5);
      const Vec3 normal = form.curved ? Vec3{x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))} : Vec3{0, 0, 1};
      add(&swatch.position, {x, y, normal.z});
      add(&swatch.normal, {normal.x, normal.y, normal.z});
      const double length = std::hypot(normal.z, normal.x);
      add(&swatch.tangent, {normal.z / length, 0, -normal.x / length, 1});
      add(&swatch.texture, {u, 1 - v});
      swatch.low_z = std::min(swatch.low_z, static_cast<float>(normal.z));
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

}  // namespace

void AddSwatch(Json* gltf, const SwatchForm& form) {
  const Swatch swatch = MakeSwatch(form);
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
  const float side = swatch.position[0], low = swatch.position[1];
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
       {"min", {side, low, swatch.low_z}},
       {"max", {-side, -low, 1.0}}},
      {{"bufferView", 1}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC3"}},
      {{"bufferView", 2}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC4"}},
      {{"bufferView", 3}, {"componentType", kFloat}, {"count", kCount}, {"type", "VEC2"}},
      {{"bufferView", 4}, {"componentType", kUnsignedShort}, {"count", swatch.index.size()}, {"type", "SCALAR"}}};
  (*gltf)["bufferViews"] = views;
  (*gltf)["buffers"] = {
      {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + Base64(bytes)}}};
}

}  // namespace lobefit

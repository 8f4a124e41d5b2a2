#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/base64.h"
#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/export/targets/gltf/write.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

using Json = nlohmann::json;

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::filesystem::path& path) : path_(path) {
    json_ = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!json_.is_object()) Fail("is not JSON");
  }

  GltfMaterial Read() const {
    if (!json_.contains("materials") || !json_["materials"].is_array() || json_["materials"].empty()) {
      Fail("holds no materials");
    }
    const Json& entry = json_["materials"][0];
    const Json none = Json::object();
    const Json& pbr = Object(entry, "pbrMetallicRoughness", none);
    if (pbr.contains("baseColorTexture") || pbr.contains("metallicRoughnessTexture")) {
      Fail("the material has textures; only constant materials are understood");
    }
    GltfMaterial material;
    material.base_color = Color(pbr, "baseColorFactor", 4, {1, 1, 1});
    material.metallic = Real(pbr, "metallicFactor", 1);
    material.roughness.roughness = Real(pbr, "roughnessFactor", 1);
    const Json& extensions = Object(entry, "extensions", none);
    const Json& anisotropy = Object(extensions, "KHR_materials_anisotropy", none);
    material.roughness.anisotropy = Real(anisotropy, "anisotropyStrength", 0);
    material.rotation = Real(anisotropy, "anisotropyRotation", 0);
    material.ior = Real(Object(extensions, "KHR_materials_ior", none), "ior", 1.5);
    const Json& specular = Object(extensions, "KHR_materials_specular", none);
    material.specular = Real(specular, "specularFactor", 1);
    material.specular_color = Color(specular, "specularColorFactor", 3, {1, 1, 1});
    if (entry.contains("normalTexture")) material.normal = NormalOf(Object(entry, "normalTexture", none));
    return material;
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(fmt::format("{}: {}", path_.string(), message));
  }

  const Json& Object(const Json& parent, const char* name, const Json& none) const {
    const auto found = parent.find(name);
    if (found == parent.end()) return none;
    if (!found->is_object()) Fail(fmt::format("member '{}' is not an object", name));
    return *found;
  }
  double Real(const Json& parent, const char* name, double otherwise) const {
    const auto found = parent.find(name);
    if (found == parent.end()) return otherwise;
    if (!found->is_number()) Fail(fmt::format("member '{}' is not a number", name));
    return found->get<double>();
  }
  Color3 Color(const Json& parent, const char* name, std::size_t size, const Color3& otherwise) const {
    const auto found = parent.find(name);
    if (found == parent.end()) return otherwise;
    Color3 color = {};
    for (std::size_t c = 0; c < 3; ++c) {
      if (!found->is_array() || found->size() != size || !(*found)[c].is_number()) {
        Fail(fmt::format("member '{}' is not {} numbers", name, size));
      }
      color[c] = (*found)[c].get<double>();
    }
    return color;
  }

  const Json& Item(const char* list, const Json& index) const {
    const auto found = json_.find(list);
    if (found == json_.end() || !found->is_array() || !index.is_number_unsigned() ||
        index.get<std::size_t>() >= found->size()) {
      Fail(fmt::format("an index into '{}' is missing or out of range", list));
    }
    return (*found)[index.get<std::size_t>()];
  }

  Vec3 NormalOf(const Json& texture) const {
    const Json missing;
    const Json& entry = Item("textures", texture.contains("index") ? texture["index"] : missing);
    const Json& image = Item("images", entry.contains("source") ? entry["source"] : missing);
    if (!image.contains("uri") || !image["uri"].is_string()) Fail("the image of the normal map has no uri");
    const std::string uri = image["uri"].get<std::string>();
    const double scale = Real(texture, "scale", 1);
    const std::string mark = "data:image/png;base64,";
    if (uri.starts_with(mark)) {
      const std::optional<std::string> png = FromBase64(std::string_view(uri).substr(mark.size()));
      if (!png) Fail("the image of the normal map is not base64");
      return NormalOfPng(*png, scale, path_);
    }
    const std::filesystem::path file = path_.parent_path() / uri;
    return NormalOfPng(MappedFile(file).bytes(), scale, file);
  }

  const std::filesystem::path& path_;
  Json json_;
};

}  // namespace

GltfMaterial ReadGltf(std::string_view bytes, const std::filesystem::path& path) {
  return GltfReader(bytes, path).Read();
}

}  // namespace lobefit

#include "lobefit/export/targets/gltf/read.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/base64.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/json_text.h"
#include "lobefit/renderer/gltf_material.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

// Not in the order of the file, in which an object of 70 000 members took 18 s.
using GltfJson = nlohmann::json;

// What each object of a material may hold.
const std::map<std::string, std::vector<std::string>>& KnownMembers() {
  static const std::map<std::string, std::vector<std::string>> known = {
      {"the extensions",
       {"KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_ior", "KHR_materials_specular"}},
      {"the material",
       {"name", "pbrMetallicRoughness", "normalTexture", "extensions", "alphaMode", "alphaCutoff", "doubleSided",
        "emissiveFactor"}},
      {"pbrMetallicRoughness", {"baseColorFactor", "metallicFactor", "roughnessFactor"}},
      {"KHR_materials_anisotropy", {"anisotropyStrength", "anisotropyRotation"}},
      {"KHR_materials_clearcoat", {"clearcoatFactor", "clearcoatRoughnessFactor"}},
      {"KHR_materials_ior", {"ior"}},
      {"KHR_materials_specular", {"specularFactor", "specularColorFactor"}},
      {"normalTexture", {"index", "scale", "texCoord"}}};
  return known;
}

class GltfReader {
 public:
  explicit GltfReader(const InputFile& file) : path_(file.path) {
    json_ = ParseJson<GltfJson>(file.bytes);
    if (!json_.is_object()) Fail("is not JSON");
    if (!json_.contains("materials") || !json_["materials"].is_array() || json_["materials"].empty()) {
      Fail("holds no materials");
    }
    if (!json_["materials"][0].is_object()) Fail("the first material is not an object");
    CheckFile();
  }

  GltfMaterial Read() const {
    const GltfJson& entry = json_["materials"][0];
    const GltfJson none = GltfJson::object();
    const GltfJson& pbr = Object(entry, "pbrMetallicRoughness", none);
    const GltfJson& extensions = Object(entry, "extensions", none);
    const GltfJson& anisotropy = Object(extensions, "KHR_materials_anisotropy", none);
    const GltfJson& clearcoat = Object(extensions, "KHR_materials_clearcoat", none);
    const GltfJson& ior = Object(extensions, "KHR_materials_ior", none);
    const GltfJson& specular = Object(extensions, "KHR_materials_specular", none);
    // Without pbrMetallicRoughness the defaults hold, but then an extension stands in its place.
    CheckMembers(extensions, "the extensions");
    CheckMembers(entry, "the material");
    CheckMembers(pbr, "pbrMetallicRoughness");
    CheckMembers(anisotropy, "KHR_materials_anisotropy");
    CheckMembers(clearcoat, "KHR_materials_clearcoat");
    CheckMembers(ior, "KHR_materials_ior");
    CheckMembers(specular, "KHR_materials_specular");
    if (entry.contains("alphaMode") && entry["alphaMode"] != "OPAQUE") Fail("the material is not opaque (alphaMode)");
    if (Color(entry, "emissiveFactor", 3, {0, 0, 0}) != Color3{0, 0, 0}) Fail("the material emits light");

    GltfMaterial material;
    material.base_color = Color(pbr, "baseColorFactor", 4, {1, 1, 1});
    CheckColor("baseColorFactor", material.base_color, 1);
    material.metallic = Factor(pbr, "metallicFactor", 1);
    material.roughness.roughness = Factor(pbr, "roughnessFactor", 1);
    material.roughness.anisotropy = Factor(anisotropy, "anisotropyStrength", 0);
    material.rotation = Real(anisotropy, "anisotropyRotation", 0);
    material.clearcoat = Factor(clearcoat, "clearcoatFactor", 0);
    material.clearcoat_roughness = Factor(clearcoat, "clearcoatRoughnessFactor", 0);
    material.ior = Real(ior, "ior", 1.5);
    if (material.ior != 0 && !(material.ior >= 1))
      Fail(fmt::format("member 'ior' is {}; 0, or 1 and more is allowed", material.ior));
    material.specular = Factor(specular, "specularFactor", 1);
    material.specular_color = Color(specular, "specularColorFactor", 3, {1, 1, 1});
    CheckColor("specularColorFactor", material.specular_color, std::numeric_limits<double>::max());
    if (entry.contains("normalTexture")) material.normal = NormalOf(Object(entry, "normalTexture", none));
    return material;
  }

  // The materials that are not looked at.
  std::vector<std::string> Remarks() const {
    std::vector<std::string> remarks;
    for (std::size_t k = 1; k < json_["materials"].size(); ++k) {
      remarks.push_back(
          fmt::format("the material {} ('{}') is left out: the first one, '{}', is taken", k, NameOf(k), NameOf(0)));
    }
    if (HasVertexColors())
      remarks.emplace_back(
          "the colours of the mesh's vertices (COLOR_0), which multiply the base colour, are left out");
    return remarks;
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(fmt::format("{}: {}", path_.string(), message));
  }

  // What holds for the whole file.
  void CheckFile() const {
    const GltfJson none = GltfJson::object();
    const GltfJson& asset = Object(json_, "asset", none);
    if (asset.contains("version") && asset["version"].is_string() &&
        !asset["version"].get<std::string>().starts_with("2.")) {
      Fail(fmt::format("is glTF of the version {}; 2.0 is understood", Excerpt(asset["version"].get<std::string>())));
    }
    const auto required = json_.find("extensionsRequired");
    if (required == json_.end() || !required->is_array()) return;
    const std::vector<std::string>& known = KnownMembers().at("the extensions");
    for (const GltfJson& extension : *required) {
      const std::string name = extension.is_string() ? extension.get<std::string>() : "";
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        Fail(fmt::format("requires the extension '{}', which is not understood; allowed are {}", Excerpt(name),
                         Join(known)));
      }
    }
  }

  bool HasVertexColors() const {
    const auto meshes = json_.find("meshes");
    if (meshes == json_.end() || !meshes->is_array()) return false;
    return std::any_of(meshes->begin(), meshes->end(), [](const GltfJson& mesh) {
      if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) return false;
      return std::any_of(mesh["primitives"].begin(), mesh["primitives"].end(), [](const GltfJson& part) {
        return part.is_object() && part.contains("attributes") && part["attributes"].is_object() &&
               part["attributes"].contains("COLOR_0");
      });
    });
  }

  std::string NameOf(std::size_t material) const {
    const GltfJson& entry = json_["materials"][material];
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string()) return "";
    return Excerpt(entry["name"].get<std::string>());
  }

  // Members that are not evaluated are errors; extras are notes.
  void CheckMembers(const GltfJson& object, const char* of) const {
    const std::vector<std::string>& known = KnownMembers().at(of);
    for (const auto& [name, value] : object.items()) {
      if (name == "extras" || std::find(known.begin(), known.end(), name) != known.end()) continue;
      if (name.ends_with("Texture")) {
        Fail(fmt::format("{} has textures ('{}'); only constant materials are understood", of, Excerpt(name)));
      }
      Fail(fmt::format("the member '{}' of {} is not understood{}; allowed are {}", Excerpt(name), of,
                       DidYouMean(name, known), Join(known)));
    }
  }

  const GltfJson& Object(const GltfJson& parent, const char* name, const GltfJson& none) const {
    const auto found = parent.find(name);
    if (found == parent.end()) return none;
    if (!found->is_object()) Fail(fmt::format("member '{}' is not an object", name));
    return *found;
  }
  double Real(const GltfJson& parent, const char* name, double otherwise) const {
    const auto found = parent.find(name);
    if (found == parent.end()) return otherwise;
    if (!found->is_number()) Fail(fmt::format("member '{}' is not a number", name));
    return found->get<double>();
  }
  // A factor of the format, which allows 0 to 1.
  double Factor(const GltfJson& parent, const char* name, double otherwise) const {
    const double factor = Real(parent, name, otherwise);
    if (!(factor >= 0 && factor <= 1)) Fail(fmt::format("member '{}' is {}; 0 to 1 is allowed", name, factor));
    return factor;
  }
  Color3 Color(const GltfJson& parent, const char* name, std::size_t size, const Color3& otherwise) const {
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

  void CheckColor(const char* name, const Color3& color, double most) const {
    for (const double part : color) {
      if (!(part >= 0 && part <= most))
        Fail(fmt::format("member '{}' holds {}; {} is allowed", name, part, most == 1 ? "0 to 1" : "0 and more"));
    }
  }

  const GltfJson& Item(const char* list, const GltfJson& index) const {
    const auto found = json_.find(list);
    if (found == json_.end() || !found->is_array() || !index.is_number_unsigned() ||
        index.get<std::size_t>() >= found->size()) {
      Fail(fmt::format("an index into '{}' is missing or out of range", list));
    }
    return (*found)[index.get<std::size_t>()];
  }

  Vec3 NormalOf(const GltfJson& texture) const {
    CheckMembers(texture, "normalTexture");
    const GltfJson missing;
    const GltfJson& entry = Item("textures", texture.contains("index") ? texture["index"] : missing);
    const GltfJson& image = Item("images", entry.contains("source") ? entry["source"] : missing);
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
    return NormalOfPng(FileBytes(file).bytes(), scale, file);
  }

  const std::filesystem::path& path_;
  GltfJson json_;
};

}  // namespace

bool IsGltf(std::string_view bytes) {
  const GltfJson json = ParseJson<GltfJson>(bytes);
  return json.is_object() && (json.contains("asset") || json.contains("materials"));
}

ImportedMaterial ReadGltf(const InputFile& file) {
  const GltfReader reader(file);
  // Before the braces: where a member of an aggregate throws, g++ 12 ends with a crash.
  const BrdfFunction brdf = SurfaceBrdf(GltfSurface(reader.Read()));
  return {"gltf", {{"R", "G", "B"}, {}}, brdf, reader.Remarks()};
}

}  // namespace lobefit

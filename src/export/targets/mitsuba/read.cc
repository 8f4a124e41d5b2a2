#include "lobefit/export/targets/mitsuba/read.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/io/text/xml_file.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

// The properties of each bsdf; nested ones need no name.
const std::map<std::string, std::set<std::string>>& KnownProperties() {
  static const std::map<std::string, std::set<std::string>> known = {
      {"roughconductor",
       {"distribution", "alpha", "alpha_u", "alpha_v", "eta", "k", "material", "specular_reflectance",
        "sample_visible"}},
      {"diffuse", {"reflectance"}},
      {"blendbsdf", {"weight"}},
      {"twosided", {}},
      {"normalmap", {"normalmap", "use_shadowing_function", "flip_invalid_normals"}}};
  return known;
}

// camelCase as the upgrade of older scenes writes it: "alphaU" is "alpha_u".
std::string SnakeCase(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isupper(letter) != 0 && !result.empty()) result += '_';
    result += static_cast<char>(std::isupper(letter) != 0 ? std::tolower(letter) : letter);
  }
  return result;
}

class MitsubaReader {
 public:
  explicit MitsubaReader(const InputFile& file) : file_(file), xml_(file), rotation_(RotationOfComment(file.bytes)) {
    const std::string_view version = xml_.root().attribute("version").value();
    old_names_ = version.starts_with("0.") || version.starts_with("1.");
  }

  ImportedMaterial Read() {
    std::vector<pugi::xml_node> all;
    if (std::string_view(xml_.root().name()) == "bsdf") all.push_back(xml_.root());
    for (const pugi::xml_node child : xml_.root().children("bsdf")) {
      if (std::string_view(xml_.root().name()) != "bsdf") all.push_back(child);
    }
    if (all.empty()) xml_.Fail(xml_.root(), "holds no <bsdf>");
    FindChannels(all.back());
    Surface surface;
    surface.masking = SurfaceMasking::kSeparable;
    surface.diffuse.assign(channels_.names.size(), 0.0);
    Add(all.back(), 1, {0, 0, 1}, &surface);
    ImportedMaterial result = {"mitsuba", channels_, SurfaceBrdf(surface), {}};
    if (rotation_ != 0)
      result.remarks.emplace_back("the texture coordinates of the mesh are turned as the file's comment says");
    if (old_names_)
      result.remarks.emplace_back("names are those of scenes before version 2, as Mitsuba 3 upgrades them");
    for (const pugi::xml_node include : xml_.root().children("include")) {
      result.remarks.push_back(fmt::format("the file '{}' of line {} was not looked into",
                                           Excerpt(include.attribute("filename").value()), xml_.Line(include)));
    }
    for (const pugi::xml_node shape : xml_.root().children("shape")) {
      if (!shape.child("bsdf")) continue;
      result.remarks.push_back(fmt::format(
          "the bsdf within the shape of line {} is left out: one that stands by itself is taken", xml_.Line(shape)));
      break;
    }
    constexpr std::size_t kMostNamed = 20;
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
      if (k == kMostNamed) {
        result.remarks.push_back(fmt::format("{} more are left out", all.size() - 1 - k));
        break;
      }
      result.remarks.push_back(fmt::format("the bsdf '{}' of line {} is left out: the last one, '{}', is taken",
                                           Excerpt(all[k].attribute("id").value()), xml_.Line(all[k]),
                                           Excerpt(all.back().attribute("id").value())));
    }
    return result;
  }

 private:
  std::string NameOf(pugi::xml_node property) const {
    const char* name = property.attribute("name").value();
    return old_names_ ? SnakeCase(name) : std::string(name);
  }

  pugi::xml_node Named(pugi::xml_node bsdf, std::string_view name) const {
    for (const pugi::xml_node child : bsdf.children()) {
      if (name == NameOf(child)) return child;
    }
    return {};
  }

  // Mitsuba refuses what a plugin does not ask for.
  void CheckProperties(pugi::xml_node bsdf, const std::string& type) const {
    const std::set<std::string>& known = KnownProperties().at(type);
    std::set<std::string> seen;
    for (const pugi::xml_node child : bsdf.children()) {
      if (child.type() != pugi::node_element || std::string_view(child.name()) == "bsdf") continue;
      const std::string name = NameOf(child);
      if (known.count(name) == 0) {
        const std::vector<std::string> names(known.begin(), known.end());
        xml_.Fail(child,
                  fmt::format("<{} name=\"{}\"> of {} is not understood{}; allowed are {}", child.name(), Excerpt(name),
                              type, DidYouMean(name, names), names.empty() ? "nested bsdfs" : Join(names)));
      }
      if (!seen.insert(name).second) xml_.Fail(child, fmt::format("'{}' is given twice", Excerpt(name)));
      CheckType(child, name);
    }
  }

  // "srgb" of older scenes is not linear, and a number within <string> is none to Mitsuba.
  void CheckType(pugi::xml_node property, const std::string& name) const {
    static constexpr std::array<std::string_view, 4> kColors = {"rgb", "spectrum", "float", "integer"};
    static constexpr std::array<std::string_view, 3> kWords = {"distribution", "material", "sample_visible"};
    const std::string_view type = property.name();
    const bool word = std::find(kWords.begin(), kWords.end(), name) != kWords.end() || name == "normalmap" ||
                      name == "use_shadowing_function" || name == "flip_invalid_normals";
    if (word) return;
    if (std::find(kColors.begin(), kColors.end(), type) == kColors.end()) {
      xml_.Fail(property,
                fmt::format("'{}' is given by <{}>, which is not understood; constant values are, by <float>, "
                            "<rgb> or <spectrum>",
                            Excerpt(name), Excerpt(type)));
    }
    for (const pugi::xml_attribute attribute : property.attributes()) {
      const std::string_view own = attribute.name();
      if (own == "name" || own == "value" || own == "id") continue;
      xml_.Fail(property, fmt::format("the attribute {}='{}' of '{}' is not understood; name and value are",
                                      Excerpt(own), Excerpt(attribute.value()), Excerpt(name)));
    }
  }

  double Number(pugi::xml_node element, std::string_view field) const {
    const std::optional<double> value = ParseDouble(field);
    if (!value) xml_.Fail(element, fmt::format("'{}' is not a number", Excerpt(field)));
    return *value;
  }

  std::vector<std::string> Fields(pugi::xml_node element) const {
    std::string text = element.attribute("value").value();
    for (char& c : text) c = c == ',' ? ' ' : c;
    std::vector<std::string> fields;
    for (const std::string_view field : SplitBlanks(text)) fields.emplace_back(field);
    return fields;
  }

  double Real(pugi::xml_node bsdf, const char* name, double otherwise) const {
    const pugi::xml_node element = Named(bsdf, name);
    if (!element) return otherwise;
    const std::vector<std::string> fields = Fields(element);
    if (fields.size() != 1) xml_.Fail(element, fmt::format("{} is not one number", name));
    return Number(element, fields[0]);
  }

  static bool HasNodes(pugi::xml_node element) {
    return std::string_view(element.name()) == "spectrum" &&
           std::string_view(element.attribute("value").value()).find(':') != std::string_view::npos;
  }

  SpectrumNodes NodesOf(pugi::xml_node element) const {
    SpectrumNodes nodes;
    for (const std::string& field : Fields(element)) {
      const std::size_t colon = std::min(field.find(':'), field.size());
      nodes.wavelengths_nm.push_back(Number(element, std::string_view(field).substr(0, colon)));
      nodes.values.push_back(Number(element, colon < field.size() ? std::string_view(field).substr(colon + 1) : ""));
      const std::size_t n = nodes.wavelengths_nm.size();
      if (n > 1 && nodes.wavelengths_nm[n - 1] <= nodes.wavelengths_nm[n - 2]) {
        xml_.Fail(element, "the wavelengths do not increase");
      }
    }
    return nodes;
  }

  // R, G, B, or the wavelengths that all spectra of the material share.
  void FindChannels(pugi::xml_node bsdf) {
    std::vector<SpectrumNodes> spectra;
    struct Walker : pugi::xml_tree_walker {
      std::vector<pugi::xml_node> found;
      bool for_each(pugi::xml_node& node) override {
        if (HasNodes(node)) found.push_back(node);
        return true;
      }
    } walker;
    bsdf.traverse(walker);
    for (const pugi::xml_node element : walker.found) {
      spectra.push_back(NodesOf(element));
      if (spectra.back().wavelengths_nm != spectra[0].wavelengths_nm) {
        xml_.Fail(element, "has other wavelengths than the spectra before it; one set is understood");
      }
    }
    channels_ = spectra.empty() ? Channels{{"R", "G", "B"}, {}} : WavelengthChannels(WavelengthsOf(spectra));
  }

  Spectrum Color(pugi::xml_node bsdf, const char* name, double otherwise) const {
    const std::size_t count = channels_.names.size();
    const pugi::xml_node element = Named(bsdf, name);
    if (!element) return Spectrum(count, otherwise);
    if (HasNodes(element)) {
      const SpectrumNodes nodes = NodesOf(element);
      Spectrum values;
      for (const double nm : channels_.wavelengths_nm) values.push_back(ValueAt(nodes, nm));
      return values;
    }
    const std::vector<std::string> fields = Fields(element);
    if (fields.size() == 1) return Spectrum(count, Number(element, fields[0]));
    if (fields.size() != 3) {
      xml_.Fail(element, fmt::format("{} is not one or three numbers; textures are not understood", name));
    }
    if (!channels_.wavelengths_nm.empty()) {
      xml_.Fail(element, fmt::format("{} is rgb among spectra; all of one kind are understood", name));
    }
    return {Number(element, fields[0]), Number(element, fields[1]), Number(element, fields[2])};
  }

  void Add(pugi::xml_node bsdf, double weight, const Vec3& normal, Surface* surface) const {
    const std::string type = bsdf.attribute("type").value();
    if (KnownProperties().count(type) == 0) {
      xml_.Fail(bsdf, fmt::format("the bsdf '{}' is not understood; roughconductor, diffuse, blendbsdf, normalmap and "
                                  "twosided are",
                                  Excerpt(type)));
    }
    CheckProperties(bsdf, type);
    std::vector<pugi::xml_node> nested;
    for (const pugi::xml_node child : bsdf.children("bsdf")) nested.push_back(child);
    const std::size_t wanted = type == "blendbsdf" ? 2 : type == "twosided" || type == "normalmap" ? 1 : 0;
    if (nested.size() != wanted) {
      xml_.Fail(bsdf, fmt::format("{} needs {} bsdf inside", type, wanted == 2 ? "two" : wanted == 1 ? "one" : "no"));
    }
    if (wanted > 0) {
      const double second = type == "blendbsdf" ? Real(bsdf, "weight", 0.5) : 0.0;
      if (!(second >= 0 && second <= 1)) xml_.Fail(bsdf, fmt::format("its weight is {}; 0 to 1 is allowed", second));
      Add(nested[0], weight * (1 - second), type == "normalmap" ? NormalOf(bsdf) : normal, surface);
      if (nested.size() > 1) Add(nested[1], weight * second, normal, surface);
    } else if (type == "diffuse") {
      const Spectrum reflectance = Color(bsdf, "reflectance", 0.5);
      for (const double value : reflectance) CheckReflectance(bsdf, "reflectance", value);
      for (std::size_t c = 0; c < reflectance.size(); ++c) surface->diffuse[c] += weight * reflectance[c];
      if (normal.z < 1) surface->diffuse_normal = normal;
    } else {
      AddConductor(bsdf, weight, normal, surface);
    }
  }

  // Mitsuba refuses what a reflectance cannot be.
  void CheckReflectance(pugi::xml_node bsdf, const char* name, double value) const {
    if (!(value >= 0 && value <= 1)) xml_.Fail(bsdf, fmt::format("its {} holds {}; 0 to 1 is allowed", name, value));
  }

  Vec3 NormalOf(pugi::xml_node bsdf) const {
    const pugi::xml_node texture = Named(bsdf, "normalmap");
    if (!texture) xml_.Fail(bsdf, "normalmap needs a texture of that name");
    for (const pugi::xml_node child : texture.children()) {
      const std::string name = NameOf(child);
      if (child.type() == pugi::node_element && name != "filename" && name != "raw") {
        xml_.Fail(child, fmt::format("'{}' of the normal map is not understood; filename and raw are", Excerpt(name)));
      }
    }
    const std::filesystem::path png =
        FindMap(file_.path, XmlFile::Unescaped(Named(texture, "filename").attribute("value").value()));
    return RotateZ(NormalOfPng(FileBytes(png).bytes(), 1, png), rotation_);
  }

  void AddConductor(pugi::xml_node bsdf, double weight, const Vec3& normal, Surface* surface) const {
    if (std::string_view("ggx") != Named(bsdf, "distribution").attribute("value").value()) {
      xml_.Fail(bsdf, "only roughconductor with distribution ggx is understood (the default is beckmann)");
    }
    if (Named(bsdf, "material")) xml_.Fail(bsdf, "named metals are not known; write eta and k");
    const bool along_u = static_cast<bool>(Named(bsdf, "alpha_u")), along_v = static_cast<bool>(Named(bsdf, "alpha_v"));
    if (along_u != along_v || (along_u && Named(bsdf, "alpha"))) {
      xml_.Fail(bsdf, "alpha, or both alpha_u and alpha_v, is what Mitsuba takes");
    }
    SurfaceLobe lobe;
    const double alpha = Real(bsdf, "alpha", 0.1);
    lobe.widths = {std::max(1e-4, Real(bsdf, "alpha_u", alpha)), std::max(1e-4, Real(bsdf, "alpha_v", alpha))};
    if (!(std::min({alpha, Real(bsdf, "alpha_u", alpha), Real(bsdf, "alpha_v", alpha)}) > 0))
      xml_.Fail(bsdf, "its alpha is not above 0");
    lobe.rotation = rotation_;
    lobe.normal = normal;
    const double factor = Real(bsdf, "specular_reflectance", 1);
    CheckReflectance(bsdf, "specular_reflectance", factor);
    lobe.weight = weight * factor;
    lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
    lobe.fresnel.eta = Color(bsdf, "eta", 0);
    lobe.fresnel.k = Color(bsdf, "k", 1);
    surface->lobes.push_back(lobe);
  }

  const InputFile& file_;
  XmlFile xml_;
  double rotation_;
  bool old_names_ = false;
  Channels channels_;
};

}  // namespace

bool IsMitsuba(std::string_view bytes) {
  return Trim(bytes).starts_with("<") &&
         (bytes.find("<bsdf") != std::string_view::npos || bytes.find("<scene") != std::string_view::npos);
}

ImportedMaterial ReadMitsuba(const InputFile& file) { return MitsubaReader(file).Read(); }

}  // namespace lobefit

#include "lobefit/export/targets/materialx/read.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/materialx/inputs.h"
#include "lobefit/io/text/xml_file.h"
#include "lobefit/renderer/open_pbr.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

class MaterialXReader {
 public:
  explicit MaterialXReader(const InputFile& file) : xml_(file) {
    for (const pugi::xml_node node : xml_.root().children()) {
      const std::string name = node.attribute("name").value();
      if (!nodes_.emplace(name, node).second && !name.empty())
        xml_.Fail(node, fmt::format("the name '{}' is given twice", Excerpt(name)));
    }
  }

  ImportedMaterial Read() const {
    const pugi::xml_node material = xml_.root().child("surfacematerial");
    if (!material) xml_.Fail(xml_.root(), "holds no <surfacematerial>");
    CheckInputs(material);
    const pugi::xml_node shader = Source(material, "surfaceshader");
    const std::string type = shader.name();
    if (type != "surface" && type != "open_pbr_surface") {
      xml_.Fail(shader,
                fmt::format("the shader <{}> is not understood; surface and open_pbr_surface are", Excerpt(type)));
    }
    CheckInputs(shader);
    Surface surface;
    if (type == "open_pbr_surface") {
      surface = OpenPbrSurface(ReadOpenPbr(shader));
    } else {
      surface.masking = SurfaceMasking::kMeanAlpha;
      surface.energy_compensation = true;
      pugi::xml_node bsdf = Source(shader, "bsdf");
      if (std::string_view(bsdf.name()) == "layer") bsdf = AddCoat(bsdf, &surface);
      Add(bsdf, 1, 0, &surface);
    }
    ImportedMaterial result = {type == "surface" ? "materialx" : "openpbr",
                               {{"R", "G", "B"}, {}},
                               SurfaceBrdf(surface),
                               {"evaluated as MaterialX' GLSL does"}};
    for (const pugi::xml_node include : xml_.root().children("xi:include")) {
      result.remarks.push_back(fmt::format("the file '{}' of line {} was not looked into",
                                           Excerpt(include.attribute("href").value()), xml_.Line(include)));
    }
    for (pugi::xml_node other = material.next_sibling("surfacematerial"); other;
         other = other.next_sibling("surfacematerial")) {
      result.remarks.push_back(fmt::format("the material '{}' of line {} is left out: the first one, '{}', is taken",
                                           Excerpt(other.attribute("name").value()), xml_.Line(other),
                                           Excerpt(material.attribute("name").value())));
    }
    return result;
  }

 private:
  static pugi::xml_node Input(pugi::xml_node node, std::string_view name) {
    for (const pugi::xml_node child : node.children("input")) {
      if (name == child.attribute("name").value()) return child;
    }
    return {};
  }

  // Every input of a node is known, and those that are not evaluated have no effect.
  void CheckInputs(pugi::xml_node node) const {
    const std::string type = node.name();
    const std::vector<MaterialXInput>& known = MaterialXInputs().at(type);
    const std::string_view nodedef = node.attribute("nodedef").value();
    if (!nodedef.empty() && !nodedef.starts_with("ND_" + type))
      xml_.Fail(node,
                fmt::format("<{}> has a definition of its own, '{}', which is not understood", type, Excerpt(nodedef)));
    std::set<std::string> seen;
    for (const pugi::xml_node input : node.children()) {
      if (input.type() != pugi::node_element) continue;
      if (std::string_view(input.name()) != "input")
        xml_.Fail(input, fmt::format("<{}> within <{}> is not understood; inputs are", Excerpt(input.name()), type));
      const std::string name = input.attribute("name").value();
      if (!seen.insert(name).second)
        xml_.Fail(input, fmt::format("the input '{}' of <{}> is given twice", Excerpt(name), type));
      CheckConstant(input);
      const auto found =
          std::find_if(known.begin(), known.end(), [&](const MaterialXInput& one) { return name == one.name; });
      if (found == known.end()) {
        std::vector<std::string> names;
        for (const MaterialXInput& one : known) names.emplace_back(one.name);
        xml_.Fail(input, fmt::format("the input '{}' of <{}> is not understood{}", Excerpt(name), type,
                                     DidYouMean(name, names)));
      }
      if (found->only != nullptr && !HasValue(input, found->only)) {
        xml_.Fail(input, fmt::format("the input '{}' of <{}> is {}; only {} is understood", Excerpt(name), type,
                                     input.attribute("value") ? "'" + Excerpt(input.attribute("value").value()) + "'"
                                                              : std::string("no constant"),
                                     found->only));
      }
    }
  }

  // A value beside a connection is not used, and a colour may be in another space than the linear one of Rec. 709; of
  // the elements around it the nearest says.
  void CheckConstant(pugi::xml_node input) const {
    if (!input.attribute("value")) return;
    for (const char* other : {"nodename", "nodegraph", "output", "interfacename", "unit"}) {
      if (!input.attribute(other)) continue;
      xml_.Fail(input,
                fmt::format("the input '{}' has a value and the attribute {}='{}', which is not understood",
                            Excerpt(input.attribute("name").value()), other, Excerpt(input.attribute(other).value())));
    }
    if (!std::string_view(input.attribute("type").value()).starts_with("color")) return;
    for (pugi::xml_node around = input; around; around = around.parent()) {
      const std::string_view space = around.attribute("colorspace").value();
      if (space.empty()) continue;
      if (space == "lin_rec709" || space == "lin_rec709_scene" || space == "none") return;
      xml_.Fail(input, fmt::format("the input '{}' is a colour in the space '{}'; only lin_rec709 is understood",
                                   Excerpt(input.attribute("name").value()), Excerpt(space)));
    }
  }

  // The same numbers, one for all where the value has more (an opacity may be a colour), or the same word.
  static bool HasValue(pugi::xml_node input, std::string_view only) {
    const std::string_view value = input.attribute("value").value();
    const std::vector<std::string_view> found = Split(value, ','), wanted = Split(only, ',');
    if (!ParseDouble(wanted[0])) return Trim(value) == only;
    return std::all_of(found.begin(), found.end(),
                       [&](std::string_view field) { return ParseDouble(field) == ParseDouble(wanted[0]); });
  }

  // The node that feeds an input; fails where there is none.
  pugi::xml_node Source(pugi::xml_node node, const char* name) const {
    const pugi::xml_node input = Input(node, name);
    const auto found = nodes_.find(input.attribute("nodename").value());
    if (!input || found == nodes_.end()) {
      xml_.Fail(node, fmt::format("its input '{}' names no node of the document", name));
    }
    return found->second;
  }

  std::vector<double> Values(pugi::xml_node node, const char* name, std::vector<double> otherwise) const {
    const pugi::xml_node input = Input(node, name);
    if (!input) return otherwise;
    std::vector<double> values;
    for (const std::string_view field : Split(input.attribute("value").value(), ',')) {
      const std::optional<double> value = ParseDouble(field);
      if (!value) {
        xml_.Fail(input, fmt::format("the input '{}' is not a constant; textures and graphs are not understood", name));
      }
      values.push_back(*value);
    }
    if (values.size() != otherwise.size()) {
      xml_.Fail(input, fmt::format("the input '{}' needs {} numbers, not {}", name, otherwise.size(), values.size()));
    }
    return values;
  }
  double Real(pugi::xml_node node, const char* name, double otherwise) const {
    return Values(node, name, {otherwise})[0];
  }
  Color3 Color(pugi::xml_node node, const char* name, const Color3& otherwise) const {
    const std::vector<double> values = Values(node, name, {otherwise[0], otherwise[1], otherwise[2]});
    return {values[0], values[1], values[2]};
  }

  Spectrum ColorSpectrum(pugi::xml_node node, const char* name, const Color3& otherwise) const {
    return ToSpectrum(Color(node, name, otherwise));
  }

  // A graph in which every node feeds the next one twice is small as a file and endless as a tree.
  void CountVisit(pugi::xml_node node) const {
    if (++visits_ > kMostVisits) xml_.Fail(node, "the graph of nodes is too large");
  }

  // A vector that is made of the mesh's frame by multiply, add and normalize.
  Vec3 Vector(pugi::xml_node node, int depth = 0) const {
    CountVisit(node);
    const std::string type = node.name();
    if (type == "tangent") return {1, 0, 0};
    if (type == "bitangent") return {0, 1, 0};
    if (type == "normal") return {0, 0, 1};
    if (depth > 16) xml_.Fail(node, "the graph of vectors is too deep");
    if (type == "multiply") return Real(node, "in2", 1) * Vector(Source(node, "in1"), depth + 1);
    if (type == "add") return Vector(Source(node, "in1"), depth + 1) + Vector(Source(node, "in2"), depth + 1);
    if (type == "normalize") return Normalized(Vector(Source(node, "in"), depth + 1));
    xml_.Fail(node, fmt::format("the vector node <{}> is not understood", Excerpt(type)));
  }
  Vec3 VectorInput(pugi::xml_node node, const char* name, const Vec3& otherwise) const {
    return Input(node, name) ? Vector(Source(node, name)) : otherwise;
  }

  // Length 1; a lobe about a normal within the surface or below it has no value.
  Vec3 NormalInput(pugi::xml_node node, const char* name) const {
    const Vec3 normal = Normalized(VectorInput(node, name, {0, 0, 1}));
    if (!(normal.z > 1e-6)) xml_.Fail(node, fmt::format("its {} does not point out of the surface", name));
    return normal;
  }

  // The azimuth whose tangent, made perpendicular to the normal, is this one.
  static double RotationOf(const Vec3& tangent, const Vec3& normal) {
    const Vec3 flat = tangent - (tangent.z / normal.z) * normal;
    return std::atan2(flat.y, flat.x);
  }

  void Add(pugi::xml_node node, double weight, int depth, Surface* surface) const {
    const std::string type = node.name();
    CountVisit(node);
    if (depth > 16) xml_.Fail(node, "the graph of BSDFs is too deep");
    const bool is_bsdf = type == "add" || type == "mix" || type.ends_with("_bsdf");
    if (is_bsdf && MaterialXInputs().count(type) > 0) CheckInputs(node);
    const double share = Real(node, "weight", 1);
    if (!(share >= 0 && share <= 1)) xml_.Fail(node, fmt::format("its weight is {}; 0 to 1 is allowed", share));
    const double own = weight * share;
    if (type == "add") {
      Add(Source(node, "in1"), weight, depth + 1, surface);
      Add(Source(node, "in2"), weight, depth + 1, surface);
    } else if (type == "mix") {
      const double mix = Real(node, "mix", 0);
      if (!(mix >= 0 && mix <= 1)) xml_.Fail(node, fmt::format("its mix is {}; 0 to 1 is allowed", mix));
      Add(Source(node, "fg"), weight * mix, depth + 1, surface);
      Add(Source(node, "bg"), weight * (1 - mix), depth + 1, surface);
    } else if (type == "oren_nayar_diffuse_bsdf") {
      const Color3 color = Color(node, "color", {0.18, 0.18, 0.18});
      const double roughness = Real(node, "roughness", 0);
      const pugi::xml_node compensation = Input(node, "energy_compensation");
      if (roughness != 0 && Trim(compensation.attribute("value").value()) != "true") {
        xml_.Fail(node, "a rough diffuse part is understood with the input energy_compensation of true only");
      }
      const bool other = std::any_of(surface->diffuse.begin(), surface->diffuse.end(), [](double d) { return d != 0; });
      if (other && roughness != surface->diffuse_roughness) {
        xml_.Fail(node, "diffuse parts of different roughness are not understood");
      }
      if (roughness != 0 && own != 1) xml_.Fail(node, "a rough diffuse part is understood with the weight 1 only");
      surface->diffuse_roughness = roughness;
      for (std::size_t c = 0; c < 3; ++c) surface->diffuse[c] += own * color[c];
      if (Input(node, "normal")) surface->diffuse_normal = NormalInput(node, "normal");
    } else if (type == "generalized_schlick_bsdf" || type == "conductor_bsdf" || type == "dielectric_bsdf") {
      AddLobe(node, own, surface);
    } else {
      xml_.Fail(node, fmt::format("the BSDF <{}> is not understood; conductor_bsdf, dielectric_bsdf, "
                                  "generalized_schlick_bsdf, oren_nayar_diffuse_bsdf, add and mix are, and a layer as "
                                  "the last of all",
                                  Excerpt(type)));
    }
  }

  // The clear coat on top of all other BSDFs. Returns what lies below.
  pugi::xml_node AddCoat(pugi::xml_node layer, Surface* surface) const {
    CheckInputs(layer);
    const pugi::xml_node top = Source(layer, "top");
    if (std::string_view(top.name()) != "dielectric_bsdf")
      xml_.Fail(layer, "a layer is understood with a dielectric_bsdf as its top only");
    CheckInputs(top);
    AddLobe(top, 1, surface);
    surface->coating = Surface::Coating::kAlbedo;
    surface->coat_lobe = surface->lobes.size() - 1;
    return Source(layer, "base");
  }

  void AddLobe(pugi::xml_node node, double weight, Surface* surface) const {
    SurfaceLobe lobe;
    lobe.weight = weight;
    const std::vector<double> roughness = Values(node, "roughness", {0.05, 0.05});
    lobe.widths = {std::clamp(roughness[0], 1e-6, 1.0), std::clamp(roughness[1], 1e-6, 1.0)};
    lobe.normal = NormalInput(node, "normal");
    lobe.rotation = RotationOf(VectorInput(node, "tangent", {1, 0, 0}), lobe.normal);
    if (std::string_view(node.name()) == "dielectric_bsdf") {
      const double ior = Real(node, "ior", 1.5);
      if (!(ior >= 1)) xml_.Fail(node, fmt::format("its ior is {:g}; indices of at least 1 are understood", ior));
      lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
      lobe.fresnel.eta = {ior, ior, ior};
    } else if (std::string_view(node.name()) == "conductor_bsdf") {
      lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
      lobe.fresnel.eta = ColorSpectrum(node, "ior", {0.183, 0.421, 1.373});
      lobe.fresnel.k = ColorSpectrum(node, "extinction", {3.424, 2.346, 1.770});
    } else {
      lobe.fresnel.f0 = ColorSpectrum(node, "color0", {1, 1, 1});
      lobe.fresnel.f90 = ColorSpectrum(node, "color90", {1, 1, 1});
      if (Input(node, "color82")) lobe.fresnel.f82 = ColorSpectrum(node, "color82", {1, 1, 1});
    }
    surface->lobes.push_back(lobe);
  }

  OpenPbrCoat ReadCoat(pugi::xml_node node) const {
    OpenPbrCoat coat;
    coat.weight = Real(node, "coat_weight", coat.weight);
    coat.color = Color(node, "coat_color", coat.color);
    coat.roughness = {Real(node, "coat_roughness", 0), Real(node, "coat_roughness_anisotropy", 0)};
    coat.ior = Real(node, "coat_ior", coat.ior);
    coat.darkening = Real(node, "coat_darkening", coat.darkening);
    const auto is_share = [](double x) { return x >= 0 && x <= 1; };
    if (!is_share(coat.weight) || !is_share(coat.darkening) || !(coat.ior >= 1)) {
      xml_.Fail(node, fmt::format("its coat has the weight {:g}, the darkening {:g} and the index {:g}; 0 to 1 for the "
                                  "first two and at least 1 are understood",
                                  coat.weight, coat.darkening, coat.ior));
    }
    coat.normal = NormalInput(node, "geometry_coat_normal");
    coat.rotation = RotationOf(VectorInput(node, "geometry_coat_tangent", {1, 0, 0}), coat.normal);
    return coat;
  }

  OpenPbr ReadOpenPbr(pugi::xml_node node) const {
    OpenPbr parameters;
    parameters.base_color = Color(node, "base_color", parameters.base_color);
    parameters.base_weight = Real(node, "base_weight", 1);
    parameters.specular_color = Color(node, "specular_color", parameters.specular_color);
    parameters.diffuse_roughness = Real(node, "base_diffuse_roughness", 0);
    parameters.metalness = Real(node, "base_metalness", 0);
    parameters.ior = Real(node, "specular_ior", 1.5);
    parameters.roughness = {Real(node, "specular_roughness", 0.3), Real(node, "specular_roughness_anisotropy", 0)};
    parameters.normal = NormalInput(node, "geometry_normal");
    parameters.rotation = RotationOf(VectorInput(node, "geometry_tangent", {1, 0, 0}), parameters.normal);
    parameters.coat = ReadCoat(node);
    const double brightest = *std::max_element(parameters.base_color.begin(), parameters.base_color.end());
    if (parameters.coat.weight > 0 && !(brightest <= 1))
      xml_.Fail(node, fmt::format("its base_color is {:g} below a coat; at most 1 is understood", brightest));
    return parameters;
  }

  static constexpr std::size_t kMostVisits = 4096;

  XmlFile xml_;
  std::map<std::string, pugi::xml_node> nodes_;
  mutable std::size_t visits_ = 0;
};

}  // namespace

bool IsMaterialX(std::string_view bytes) {
  return Trim(bytes).starts_with("<") && bytes.find("<materialx") != std::string_view::npos;
}

ImportedMaterial ReadMaterialX(const InputFile& file) { return MaterialXReader(file).Read(); }

}  // namespace lobefit

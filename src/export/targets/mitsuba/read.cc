#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/export/targets/mitsuba/write.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/io/text/xml_file.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

class MitsubaReader {
 public:
  explicit MitsubaReader(const InputFile& file) : file_(file), xml_(file), rotation_(RotationOfComment(file.bytes)) {}

  Surface Read() const {
    pugi::xml_node last = std::string_view(xml_.root().name()) == "bsdf" ? xml_.root() : pugi::xml_node();
    for (const pugi::xml_node child : xml_.root().children("bsdf")) last = child;
    if (!last) xml_.Fail(xml_.root(), "holds no <bsdf>");
    Surface surface;
    surface.masking = SurfaceMasking::kSeparable;
    Add(last, 1, {0, 0, 1}, &surface);
    return surface;
  }

 private:
  static pugi::xml_node Named(pugi::xml_node bsdf, std::string_view name) {
    for (const pugi::xml_node child : bsdf.children()) {
      if (name == child.attribute("name").value()) return child;
    }
    return {};
  }

  std::vector<double> Numbers(pugi::xml_node element) const {
    std::string text = element.attribute("value").value();
    for (char& c : text) c = c == ',' ? ' ' : c;
    std::vector<double> numbers;
    for (const std::string_view field : SplitBlanks(text)) {
      const std::optional<double> value = ParseDouble(field);
      if (!value) xml_.Fail(element, fmt::format("'{}' is not a number", Excerpt(field)));
      numbers.push_back(*value);
    }
    return numbers;
  }

  double Real(pugi::xml_node bsdf, const char* name, double otherwise) const {
    const pugi::xml_node element = Named(bsdf, name);
    if (!element) return otherwise;
    const std::vector<double> numbers = Numbers(element);
    if (numbers.size() != 1) xml_.Fail(element, fmt::format("{} is not one number", name));
    return numbers[0];
  }

  Color3 Color(pugi::xml_node bsdf, const char* name, double otherwise) const {
    const pugi::xml_node element = Named(bsdf, name);
    if (!element) return {otherwise, otherwise, otherwise};
    const std::vector<double> numbers = Numbers(element);
    if (numbers.size() != 1 && numbers.size() != 3) {
      xml_.Fail(element, fmt::format("{} is not one or three numbers; spectra and textures are not understood", name));
    }
    return {numbers[0], numbers[numbers.size() == 1 ? 0 : 1], numbers[numbers.size() == 1 ? 0 : 2]};
  }

  void Add(pugi::xml_node bsdf, double weight, const Vec3& normal, Surface* surface) const {
    const std::string type = bsdf.attribute("type").value();
    if (type == "blendbsdf" || type == "twosided" || type == "normalmap") {
      std::vector<pugi::xml_node> nested;
      for (const pugi::xml_node child : bsdf.children("bsdf")) nested.push_back(child);
      if (nested.size() != (type == "blendbsdf" ? 2U : 1U)) {
        xml_.Fail(bsdf, fmt::format("{} needs {} bsdf inside", type, type == "blendbsdf" ? "two" : "one"));
      }
      const double second = type == "blendbsdf" ? Real(bsdf, "weight", 0.5) : 0.0;
      Add(nested[0], weight * (1 - second), type == "normalmap" ? NormalOf(bsdf) : normal, surface);
      if (nested.size() > 1) Add(nested[1], weight * second, normal, surface);
    } else if (type == "diffuse") {
      const Color3 reflectance = Color(bsdf, "reflectance", 0.5);
      for (std::size_t c = 0; c < 3; ++c) surface->diffuse[c] += weight * reflectance[c];
      if (normal.z < 1) surface->diffuse_normal = normal;
    } else if (type == "roughconductor") {
      AddConductor(bsdf, weight, normal, surface);
    } else {
      xml_.Fail(bsdf, fmt::format("the bsdf '{}' is not understood; roughconductor, diffuse, blendbsdf, normalmap and "
                                  "twosided are",
                                  Excerpt(type)));
    }
  }

  Vec3 NormalOf(pugi::xml_node bsdf) const {
    const pugi::xml_node texture = Named(bsdf, "normalmap");
    const std::filesystem::path png = file_.path.parent_path() / Named(texture, "filename").attribute("value").value();
    return RotateZ(NormalOfPng(MappedFile(png).bytes(), 1, png), rotation_);
  }

  void AddConductor(pugi::xml_node bsdf, double weight, const Vec3& normal, Surface* surface) const {
    if (std::string_view("ggx") != Named(bsdf, "distribution").attribute("value").value()) {
      xml_.Fail(bsdf, "only roughconductor with distribution ggx is understood (the default is beckmann)");
    }
    if (Named(bsdf, "material")) xml_.Fail(bsdf, "named metals are not known; write eta and k");
    SurfaceLobe lobe;
    const double alpha = Real(bsdf, "alpha", 0.1);
    lobe.widths = {std::max(1e-4, Real(bsdf, "alpha_u", alpha)), std::max(1e-4, Real(bsdf, "alpha_v", alpha))};
    lobe.rotation = rotation_;
    lobe.normal = normal;
    const double scale = Real(bsdf, "specular_reflectance", 1);
    lobe.weight = weight * scale;
    lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
    lobe.fresnel.eta = Color(bsdf, "eta", 0);
    lobe.fresnel.k = Color(bsdf, "k", 1);
    surface->lobes.push_back(lobe);
  }

  const InputFile& file_;
  XmlFile xml_;
  double rotation_;
};

}  // namespace

Surface ReadMitsuba(std::string_view bytes, const std::filesystem::path& path) {
  const InputFile file = {path, bytes};
  return MitsubaReader(file).Read();
}

}  // namespace lobefit

#include "lobefit/core/model.h"

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

struct ShapeRow {
  const char* name;
  const char* unit;
  double low, high;
  const char* description;
};
// The ranges: below alpha = 1e-4 a lobe is a mirror for every instrument; above 1 the axis called "1" is no longer the
// longest.
constexpr ShapeRow kShape[] = {
    {"alpha_x", "1", 1e-4, 1, "roughness along the first axis of the ellipsoid"},
    {"alpha_y", "1", 1e-4, 1, "roughness along the second axis"},
    {"theta_x", "deg", -kPi / 2, kPi / 2, "tilt of the lobe about x (positive leans it to +y)"},
    {"theta_y", "deg", -kPi / 2, kPi / 2, "tilt of the lobe about y (positive leans it to -x)"},
    {"theta_z", "deg", -kPi / 2, kPi / 2,
     "rotation of the axes about the normal (positive turns them clockwise seen from +z)"},
};
constexpr bool kShapeFree[][5] = {
    {true, false, false, false, false},  // kGgx
    {true, false, false, true, false},   // kGgxTilted
    {true, true, false, false, true},    // kGgxAnisotropic
    {true, true, true, true, true},      // kEllipsoid
};

}  // namespace

std::vector<Parameter> Parameters(const Model& model) {
  std::vector<Parameter> parameters;
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const std::string prefix = lobe == 0 ? "" : "lobe" + std::to_string(lobe + 1) + ".";
    for (int i = 0; i < 5; ++i) {
      const ShapeRow& row = kShape[i];
      const bool is_angle = std::string_view(row.unit) == "deg";
      const std::string name = prefix + row.name;
      parameters.push_back({name, name + (is_angle ? "_deg" : ""), row.unit, row.low, row.high, ParameterGroup::kShape,
                            false, kShapeFree[static_cast<int>(model.lobes[lobe].ndf)][i], row.description});
    }
    if (model.lobes[lobe].fresnel == Fresnel::kSchlick) {
      parameters.push_back({prefix + "f0", prefix + "f0", "1", 0, 1, ParameterGroup::kFresnel, true, true,
                            "reflectance at normal incidence"});
    } else {
      parameters.push_back({prefix + "scale", prefix + "scale", "1", 0, 1e6, ParameterGroup::kFresnel, true, true,
                            "factor of the lobe in place of a Fresnel term"});
    }
  }
  if (model.diffuse == Diffuse::kLambert) {
    parameters.push_back({"diffuse", "diffuse", "1", 0, 1, ParameterGroup::kDiffuse, true, true,
                          "albedo of the Lambertian part, pi f_r"});
  }
  return parameters;
}

double InsideFactor(const Parameter& parameter) { return parameter.unit == "deg" ? kPi / 180 : 1.0; }

const std::vector<Choice<Ndf>>& NdfChoices() {
  static const std::vector<Choice<Ndf>> choices = {
      {Ndf::kGgx, "ggx", "isotropic GGX"},
      {Ndf::kGgxTilted, "ggx-tilted", "isotropic GGX ellipsoid, tilted within the plane of the measurement"},
      {Ndf::kGgxAnisotropic, "ggx-anisotropic", "anisotropic GGX, rotated about the normal"},
      {Ndf::kEllipsoid, "ellipsoid", "five-parameter ellipsoid: anisotropic GGX, rotated and tilted"},
  };
  return choices;
}

const std::vector<Choice<Masking>>& MaskingChoices() {
  static const std::vector<Choice<Masking>> choices = {
      {Masking::kSmithSeparable, "smith-separable", "G1(wi) G1(wo), each at most 1"},
      {Masking::kSmithUnclamped, "smith-unclamped", "G1(wi) G1(wo), which may exceed 1 for tilted lobes"},
      {Masking::kSmithHeight, "smith-height", "height-correlated Smith"},
  };
  return choices;
}

const std::vector<Choice<Fresnel>>& FresnelChoices() {
  static const std::vector<Choice<Fresnel>> choices = {
      {Fresnel::kSchlick, "schlick", "Schlick's approximation with f0 a channel"},
      {Fresnel::kNone, "none", "no Fresnel term, a free scale a channel"},
  };
  return choices;
}

const std::vector<Choice<Diffuse>>& DiffuseChoices() {
  static const std::vector<Choice<Diffuse>> choices = {
      {Diffuse::kLambert, "lambert", "constant f_r"},
      {Diffuse::kNone, "none", "no diffuse part"},
  };
  return choices;
}

}  // namespace lobefit

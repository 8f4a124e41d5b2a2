#include "lobefit/core/brdf/model.h"

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
constexpr ShapeRow kShapeRows[] = {
    {"alpha_x", "1", 1e-4, 1, "roughness along the first axis of the ellipsoid"},
    {"alpha_y", "1", 1e-4, 1, "roughness along the second axis"},
    {"theta_x", "deg", -kPi / 2, kPi / 2, "tilt of the lobe about x (positive leans it to +y)"},
    {"theta_y", "deg", -kPi / 2, kPi / 2, "tilt of the lobe about y (positive leans it to -x)"},
    {"theta_z", "deg", -kPi / 2, kPi / 2,
     "rotation of the axes about the normal (positive turns them clockwise seen from +z)"},
};

struct NdfRow {
  NdfFamily family;
  bool round, tilted;
  bool free[kShapeParameters];
};
// In the order of the enum.
constexpr NdfRow kNdfs[] = {
    {NdfFamily::kGgx, true, false, {true, false, false, false, false}},
    {NdfFamily::kGgx, true, true, {true, false, false, true, false}},
    {NdfFamily::kGgx, false, false, {true, true, false, false, true}},
    {NdfFamily::kGgx, false, true, {true, true, true, true, true}},
    {NdfFamily::kBeckmann, true, false, {true, false, false, false, false}},
    {NdfFamily::kBeckmann, false, false, {true, true, false, false, true}},
    {NdfFamily::kBeckmann, false, true, {true, true, true, true, true}},
    {NdfFamily::kKagiwadaKalaba, true, false, {true, false, false, false, false}},
    {NdfFamily::kSphericalGaussian, true, false, {true, false, false, false, false}},
};
const NdfRow& RowOf(Ndf ndf) { return kNdfs[static_cast<std::size_t>(ndf)]; }

// Lobes on the whole sphere of normals have no axis that must be the longest: alpha = 10 is nearly isotropic.
constexpr double kSphereAlphaHigh = 10;

struct FresnelRow {
  const char* name;
  double low, high, start;
  const char* description;
};
// Indices beyond the ranges are not known of any metal between 0.3 and 12 um, or of any transparent solid.
std::vector<FresnelRow> FresnelRows(Fresnel fresnel) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return {{"f0", 0, 1, 0, "reflectance at normal incidence"}};
    case Fresnel::kConductor:
      return {{"eta", 0.01, 30, 1, "real part of the refractive index"},
              {"k", 0.001, 100, 3, "imaginary part of the refractive index"}};
    case Fresnel::kDielectric:
      return {{"ior", 1, 5, 1.5, "refractive index"}};
    case Fresnel::kNone:
      break;
  }
  return {{"scale", 0, 1e6, 0, "factor of the lobe in place of a Fresnel term"}};
}

bool IsSmith(Masking masking) { return masking <= Masking::kSmithHeightDirection; }

}  // namespace

NdfFamily FamilyOf(Ndf ndf) { return RowOf(ndf).family; }
bool IsRound(Ndf ndf) { return RowOf(ndf).round; }
bool IsTilted(Ndf ndf) { return RowOf(ndf).tilted; }

std::string WhyNotEvaluable(const Model& model) {
  for (const Lobe& lobe : model.lobes) {
    if (lobe.masking == Masking::kVCavity && IsTilted(lobe.ndf)) {
      return std::string("masking v-cavity needs a lobe about the normal, ") + NameOf(NdfChoices(), lobe.ndf) +
             " may tilt; use ndf ggx-anisotropic or beckmann-anisotropic, or a Smith masking";
    }
    if (!lobe.metal.empty() && lobe.fresnel != Fresnel::kConductor) {
      return "metal = '" + lobe.metal + "' goes with fresnel = 'conductor' only";
    }
  }
  if (model.diffuse == Diffuse::kMicrofacet) {
    const Lobe& first = model.lobes.front();
    const NdfFamily family = FamilyOf(first.ndf);
    if (family != NdfFamily::kGgx && family != NdfFamily::kBeckmann) {
      return std::string("diffuse microfacet needs a first lobe of GGX or Beckmann facets, not ") +
             NameOf(NdfChoices(), first.ndf);
    }
    if (!IsSmith(first.masking)) {
      return std::string("diffuse microfacet needs a Smith masking in the first lobe, not ") +
             NameOf(MaskingChoices(), first.masking);
    }
  }
  return "";
}

std::size_t FresnelParameters(Fresnel fresnel) { return fresnel == Fresnel::kConductor ? 2 : 1; }

std::size_t FirstParameter(const Model& model, std::size_t lobe) {
  std::size_t first = 0;
  for (std::size_t l = 0; l < lobe; ++l) first += kShapeParameters + FresnelParameters(model.lobes[l].fresnel);
  return first;
}

std::vector<Parameter> Parameters(const Model& model) {
  std::vector<Parameter> parameters;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Lobe& lobe = model.lobes[l];
    const std::string prefix = l == 0 ? "" : "lobe" + std::to_string(l + 1) + ".";
    const NdfFamily family = FamilyOf(lobe.ndf);
    const bool sphere = family == NdfFamily::kKagiwadaKalaba || family == NdfFamily::kSphericalGaussian;
    for (std::size_t i = 0; i < kShapeParameters; ++i) {
      const ShapeRow& row = kShapeRows[i];
      const bool is_angle = std::string_view(row.unit) == "deg";
      const std::string name = prefix + row.name;
      parameters.push_back({name, name + (is_angle ? "_deg" : ""), row.unit, row.low,
                            sphere && i < 2 ? kSphereAlphaHigh : row.high, ParameterGroup::kShape, false,
                            RowOf(lobe.ndf).free[i], row.description});
    }
    for (const FresnelRow& row : FresnelRows(lobe.fresnel)) {
      const std::string name = prefix + row.name;
      parameters.push_back({name, name, "1", row.low, row.high, ParameterGroup::kFresnel, true, lobe.metal.empty(),
                            row.description, row.start});
    }
  }
  if (model.diffuse != Diffuse::kNone) {
    parameters.push_back({"diffuse", "diffuse", "1", 0, 1, ParameterGroup::kDiffuse, true, true,
                          model.diffuse == Diffuse::kLambert ? "albedo of the Lambertian part, pi f_r"
                                                             : "albedo of the facets of the first lobe"});
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
      {Ndf::kBeckmann, "beckmann", "isotropic Beckmann"},
      {Ndf::kBeckmannAnisotropic, "beckmann-anisotropic", "anisotropic Beckmann, rotated about the normal"},
      {Ndf::kBeckmannOffCenter, "beckmann-off-center", "anisotropic Beckmann, rotated and moved in slope space"},
      {Ndf::kKagiwadaKalaba, "kagiwada-kalaba", "Kagiwada-Kalaba on the sphere of normals, heavier tails than GGX"},
      {Ndf::kSphericalGaussian, "spherical-gaussian", "von Mises-Fisher on the sphere of normals"},
  };
  return choices;
}

const std::vector<Choice<Masking>>& MaskingChoices() {
  static const std::vector<Choice<Masking>> choices = {
      {Masking::kSmithSeparable, "smith-separable", "G1(wi) G1(wo), each at most 1"},
      {Masking::kSmithUnclamped, "smith-unclamped", "G1(wi) G1(wo), which may exceed 1 for tilted lobes"},
      {Masking::kSmithHeight, "smith-height", "height-correlated Smith"},
      {Masking::kSmithHeightDirection, "smith-height-direction", "height- and direction-correlated Smith"},
      {Masking::kVCavity, "v-cavity", "V-shaped grooves; lobes about the normal"},
      {Masking::kImplicit, "implicit", "for comparison: cancels the cosines of the denominator"},
      {Masking::kSchlickSmith, "schlick-smith", "for comparison: Schlick's rational masking"},
      {Masking::kKelemen, "kelemen", "for comparison: cosines over (wi . wh)^2"},
  };
  return choices;
}

const std::vector<Choice<Fresnel>>& FresnelChoices() {
  static const std::vector<Choice<Fresnel>> choices = {
      {Fresnel::kSchlick, "schlick", "Schlick's approximation with f0 a channel"},
      {Fresnel::kConductor, "conductor", "exact, with eta and k a channel, or those of a metal"},
      {Fresnel::kDielectric, "dielectric", "exact, with a refractive index a channel"},
      {Fresnel::kNone, "none", "no Fresnel term, a free scale a channel"},
  };
  return choices;
}

const std::vector<Choice<Diffuse>>& DiffuseChoices() {
  static const std::vector<Choice<Diffuse>> choices = {
      {Diffuse::kLambert, "lambert", "constant f_r"},
      {Diffuse::kMicrofacet, "microfacet", "the facets of the first lobe are Lambertian"},
      {Diffuse::kNone, "none", "no diffuse part"},
  };
  return choices;
}

}  // namespace lobefit

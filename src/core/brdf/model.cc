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
  Family family;
  bool round, tilted;
  bool free[kEllipseParameters];
};
// In the order of the enum.
constexpr NdfRow kNdfs[] = {
    {Family::kGgx, true, false, {true, false, false, false, false}},
    {Family::kGgx, true, true, {true, false, false, true, false}},
    {Family::kGgx, false, false, {true, true, false, false, true}},
    {Family::kGgx, false, true, {true, true, true, true, true}},
    {Family::kBeckmann, true, false, {true, false, false, false, false}},
    {Family::kBeckmann, false, false, {true, true, false, false, true}},
    {Family::kBeckmann, false, true, {true, true, true, true, true}},
    {Family::kKagiwadaKalaba, true, false, {true, false, false, false, false}},
    {Family::kSphericalGaussian, true, false, {true, false, false, false, false}},
    {Family::kProfile, true, false, {true, false, false, false, false}},
    {Family::kProfile, true, true, {true, false, false, true, false}},
    {Family::kProfile, false, false, {true, true, false, false, true}},
    {Family::kProfile, false, true, {true, true, true, true, true}},
    {Family::kStudent, true, false, {true, false, false, false, false}},
    {Family::kStudent, true, true, {true, false, false, true, false}},
    {Family::kStudent, false, false, {true, true, false, false, true}},
    {Family::kStudent, false, true, {true, true, true, true, true}},
    {Family::kAbg, true, false, {true, false, false, false, false}},
    {Family::kAbg, false, false, {true, true, false, false, true}},
};
const NdfRow& RowOf(Ndf ndf) { return kNdfs[static_cast<std::size_t>(ndf)]; }

// Lobes on the whole sphere of normals have no axis that must be the longest: alpha = 10 is nearly isotropic.
constexpr double kSphereAlphaHigh = 10;
// Scatter bends within the mirror itself: B = 1e-8 with g = 2 is a width of 5e-5.
constexpr double kAbgAlphaLow = 1e-6;

// What a lobe has beside its ellipse. Bounds: math.md 8.1, 8.2. q1 = -2 is a flat top; below, the density dips at the
// centre. The last exponent must stay above 3/2, where the mean slope ends.
struct ProfileRow {
  std::string name;
  double low, high, start;
  std::string description;
};
std::vector<ProfileRow> ProfileRows(const Lobe& lobe) {
  const Family family = FamilyOf(lobe.ndf);
  if (family == Family::kStudent) {
    return {{"gamma", 1.55, 100, 2, "exponent of the tail of the slopes: 2 is GGX, large is Beckmann"}};
  }
  if (family == Family::kAbg)
    return {{"g", 0.3, 10, 2, "exponent of the fall with the distance from the mirror direction"}};
  std::vector<ProfileRow> rows;
  if (family != Family::kProfile) return rows;
  const std::vector<double>& knots = GridOf(lobe)->spline()->knots();
  const std::size_t size = knots.size() - 1;
  for (std::size_t k = 1; k <= size; ++k) {
    const std::string name = "q" + std::to_string(k);
    if (k == size && k > 1) {
      rows.push_back({name, -0.45, 40, 0, "exponent of the tail less 2 (0 is GGX)"});
    } else {
      rows.push_back({name, k == 1 ? -2.0 : -3.0, k == 1 ? 10.0 : 40.0, 0,
                      k == 1 ? "exponent at the peak less 2 (0 is GGX)"
                             : "local exponent of the slopes' density less 2 (0 is GGX)"});
    }
  }
  return rows;
}

struct FresnelRow {
  const char* name;
  double low, high, start;
  const char* description;
  bool free = true, shared = false, is_reflectance = false;
};
FresnelRow ReflectanceRow(const char* name, double start, const char* description) {
  return {name, 0, 1, start, description, true, false, true};
}
// Indices beyond the ranges are not known of any metal between 0.3 and 12 um, or of any transparent solid.
std::vector<FresnelRow> FresnelRows(Fresnel fresnel) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return {ReflectanceRow("f0", 0, "reflectance at normal incidence")};
    case Fresnel::kConductor:
      return {{"eta", 0.01, 30, 1, "real part of the refractive index"},
              {"k", 0.001, 100, 3, "imaginary part of the refractive index"}};
    case Fresnel::kDielectric:
      return {{"ior", 1, 5, 1.5, "refractive index"}};
    case Fresnel::kSchlickF82:
      return {ReflectanceRow("f0", 0, "reflectance at normal incidence"),
              {"tint", 0, 1.2, 1, "factor of Schlick's reflectance at 82 degrees"}};
    case Fresnel::kCurve:
      return {ReflectanceRow("F_0", 1, "reflectance at grazing incidence"),
              ReflectanceRow("F_1", 0.5, "coefficient of the reflectance, weightiest near 83 degrees"),
              ReflectanceRow("F_2", 0.1, "near 73 degrees"),
              ReflectanceRow("F_3", 0, "near 58 degrees"),
              ReflectanceRow("F_4", 0, "near 30 degrees"),
              ReflectanceRow("F_5", 0, "reflectance at normal incidence")};
    case Fresnel::kCoatLayered:
    case Fresnel::kCoatRefracted:
      // The absorption is not free: without samples at grazing it is the reflectance of what lies below over again.
      return {{"ior", 1, 3, 1.5, "refractive index of the coat", true, true},
              {"tau", 0, 10, 0, "optical depth of the coat along the normal, one way", false, false}};
    case Fresnel::kNone:
      break;
  }
  return {{"scale", 0, 1e6, 0, "factor of the lobe in place of a Fresnel term", true, false, true}};
}

const char* DiffuseAlbedoText(Diffuse diffuse) {
  switch (diffuse) {
    case Diffuse::kMicrofacet:
      return "albedo of the facets of the first lobe";
    case Diffuse::kInterfaced:
      return "apparent albedo of the part below the interface, of what enters";
    case Diffuse::kOrenNayar:
      return "albedo of the facets of the diffuse part";
    default:
      return "albedo of the Lambertian part, pi f_r";
  }
}

const char* WhyNoCoat(const Model& model) {
  const std::size_t coat = CoatOf(model);
  if (coat == model.lobes.size()) return "";
  const Lobe& lobe = model.lobes[coat];
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    if (l != coat && IsCoat(model.lobes[l].fresnel)) return "a model has one coat at most";
    if (FamilyOf(model.lobes[l].ndf) == Family::kAbg)
      return "ndf abg is the scatter of the whole surface: no coat lies over it";
  }
  if (model.lobes.size() == 1 && model.diffuse == Diffuse::kNone)
    return "a coat lies over something: add a [[lobe]] or a diffuse part below it";
  if (IsTilted(lobe.ndf) || lobe.direction == LobeDirection::kRetro)
    return "a coat's lobe lies about the mirror direction and the normal; use ndf ggx, ggx-anisotropic or another one "
           "without a tilt";
  if (model.diffuse != Diffuse::kLambert && model.diffuse != Diffuse::kNone)
    return "below a coat the diffuse part is lambert or none: the coat is its interface";
  return "";
}

}  // namespace

Family FamilyOf(Ndf ndf) { return RowOf(ndf).family; }
bool IsRound(Ndf ndf) { return RowOf(ndf).round; }
bool IsTilted(Ndf ndf) { return RowOf(ndf).tilted; }
bool IsInPlane(Ndf ndf) { return RowOf(ndf).round && RowOf(ndf).tilted; }
bool HasExponent(Ndf ndf) { return FamilyOf(ndf) == Family::kStudent || FamilyOf(ndf) == Family::kAbg; }

std::string WhyNotEvaluable(const Model& model) {
  for (const Lobe& lobe : model.lobes) {
    if (lobe.masking == Masking::kVCavity && IsTilted(lobe.ndf)) {
      return std::string("masking v-cavity needs a lobe about the normal, ") + NameOf(NdfChoices(), lobe.ndf) +
             " may tilt; use ndf ggx-anisotropic or beckmann-anisotropic, or a Smith masking";
    }
    if (lobe.direction == LobeDirection::kRetro && IsTilted(lobe.ndf)) {
      return std::string("direction retro needs a lobe about the normal, ") + NameOf(NdfChoices(), lobe.ndf) +
             " may tilt, and would not be reciprocal; use ndf ggx, ggx-anisotropic or one of the others without a tilt";
    }
    const bool abg = FamilyOf(lobe.ndf) == Family::kAbg;
    if (abg != (lobe.masking == Masking::kNone)) {
      return abg ? "ndf abg is f_r itself: it goes with masking = 'none'"
                 : std::string("masking none goes with ndf abg only, not with ") + NameOf(NdfChoices(), lobe.ndf);
    }
    if (abg && lobe.fresnel != Fresnel::kNone) return "ndf abg is f_r itself: it goes with fresnel = 'none'";
    if (lobe.grid != nullptr && FamilyOf(lobe.ndf) != Family::kProfile) {
      return std::string("knots go with a profile only, not with ndf ") + NameOf(NdfChoices(), lobe.ndf);
    }
    if (!lobe.metal.empty() && lobe.fresnel != Fresnel::kConductor) {
      return "metal = '" + lobe.metal + "' goes with fresnel = 'conductor' only";
    }
  }
  if (std::string why = WhyNoCoat(model); !why.empty()) return why;
  if (model.diffuse == Diffuse::kMicrofacet) {
    const Lobe& first = model.lobes.front();
    const Family family = FamilyOf(first.ndf);
    if (family != Family::kGgx && family != Family::kBeckmann) {
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

bool IsCoat(Fresnel fresnel) { return fresnel == Fresnel::kCoatLayered || fresnel == Fresnel::kCoatRefracted; }

std::size_t CoatOf(const Model& model) {
  std::size_t l = 0;
  while (l < model.lobes.size() && !IsCoat(model.lobes[l].fresnel)) ++l;
  return l;
}

std::size_t FresnelParameters(Fresnel fresnel) {
  switch (fresnel) {
    case Fresnel::kConductor:
    case Fresnel::kSchlickF82:
    case Fresnel::kCoatLayered:
    case Fresnel::kCoatRefracted:
      return 2;
    case Fresnel::kCurve:
      return 6;
    default:
      return 1;
  }
}

std::size_t ShapeParameters(const Lobe& lobe) {
  switch (FamilyOf(lobe.ndf)) {
    case Family::kStudent:
    case Family::kAbg:
      return kEllipseParameters + 1;
    case Family::kProfile:
      return kEllipseParameters + GridOf(lobe)->spline()->size();
    default:
      return kEllipseParameters;
  }
}

std::size_t DiffuseParameters(Diffuse diffuse) {
  if (diffuse == Diffuse::kNone) return 0;
  return diffuse == Diffuse::kInterfaced || diffuse == Diffuse::kOrenNayar ? 2 : 1;
}

std::size_t FirstParameter(const Model& model, std::size_t lobe) {
  std::size_t first = 0;
  for (std::size_t l = 0; l < lobe; ++l)
    first += ShapeParameters(model.lobes[l]) + FresnelParameters(model.lobes[l].fresnel);
  return first;
}

std::size_t FirstFresnel(const Model& model, std::size_t lobe) {
  return FirstParameter(model, lobe) + ShapeParameters(model.lobes[lobe]);
}

std::shared_ptr<const ProfileGrid> GridWithKnots(const std::vector<double>& knots) {
  return std::make_shared<const ProfileGrid>(std::make_shared<const ProfileSpline>(knots));
}

const std::shared_ptr<const ProfileGrid>& GridOf(const Lobe& lobe) {
  static const std::shared_ptr<const ProfileGrid> none;
  if (FamilyOf(lobe.ndf) != Family::kProfile) return none;
  if (lobe.grid != nullptr) return lobe.grid;
  static const std::shared_ptr<const ProfileGrid> grid = GridWithKnots({0, 1, 2, 4, 8, 16, 32});
  return grid;
}

std::vector<Parameter> Parameters(const Model& model) {
  std::vector<Parameter> parameters;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Lobe& lobe = model.lobes[l];
    const std::string prefix = l == 0 ? "" : "lobe" + std::to_string(l + 1) + ".";
    const Family family = FamilyOf(lobe.ndf);
    const bool sphere = family == Family::kKagiwadaKalaba || family == Family::kSphericalGaussian;
    for (std::size_t i = 0; i < kEllipseParameters; ++i) {
      const ShapeRow& row = kShapeRows[i];
      const bool is_angle = std::string_view(row.unit) == "deg";
      const std::string name = prefix + row.name;
      parameters.push_back({name, name + (is_angle ? "_deg" : ""), row.unit,
                            family == Family::kAbg && i < 2 ? kAbgAlphaLow : row.low,
                            sphere && i < 2 ? kSphereAlphaHigh : row.high, ParameterGroup::kShape, false,
                            RowOf(lobe.ndf).free[i], row.description});
    }
    for (const ProfileRow& row : ProfileRows(lobe)) {
      const std::string name = prefix + row.name;
      parameters.push_back(
          {name, name, "1", row.low, row.high, ParameterGroup::kShape, false, true, row.description, row.start});
    }
    for (const FresnelRow& row : FresnelRows(lobe.fresnel)) {
      const std::string name = prefix + row.name;
      parameters.push_back({name, name, "1", row.low, row.high, ParameterGroup::kFresnel, true,
                            row.free && lobe.metal.empty(), row.description, row.start, row.shared,
                            row.is_reflectance});
    }
  }
  if (model.diffuse == Diffuse::kInterfaced) {
    // Not free: without samples at grazing it is the albedo over again.
    parameters.push_back({"interface_ior", "interface_ior", "1", 1, 3, ParameterGroup::kDiffuse, true, false,
                          "refractive index of the interface above the diffuse part", 1.5, true});
  }
  if (model.diffuse == Diffuse::kOrenNayar) {
    parameters.push_back({"diffuse_roughness", "diffuse_roughness", "1", 0, 1, ParameterGroup::kDiffuse, true, true,
                          "roughness of the diffuse part", 0.3, true});
  }
  if (model.diffuse != Diffuse::kNone) {
    // Light that is scattered more than once makes a diffuse part no multiple of its albedo, which stays at most 1.
    const bool is_linear = model.diffuse != Diffuse::kInterfaced && model.diffuse != Diffuse::kOrenNayar;
    parameters.push_back({"diffuse", "diffuse", "1", 0, 1, ParameterGroup::kDiffuse, true, true,
                          DiffuseAlbedoText(model.diffuse), 0, false, is_linear});
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
      {Ndf::kProfile, "profile", "free radial profile of the slopes, isotropic"},
      {Ndf::kProfileTilted, "profile-tilted", "free profile, tilted within the plane of the measurement"},
      {Ndf::kProfileAnisotropic, "profile-anisotropic", "free profile, anisotropic, rotated about the normal"},
      {Ndf::kProfileEllipsoid, "profile-ellipsoid", "free profile on the five-parameter ellipse: rotated and tilted"},
      {Ndf::kStudent, "student", "Student's distribution of slopes, isotropic: one free exponent of the tail"},
      {Ndf::kStudentTilted, "student-tilted", "Student's, tilted within the plane of the measurement"},
      {Ndf::kStudentAnisotropic, "student-anisotropic", "Student's, anisotropic, rotated about the normal"},
      {Ndf::kStudentEllipsoid, "student-ellipsoid", "Student's on the five-parameter ellipse: rotated and tilted"},
      {Ndf::kAbg, "abg", "A / (B + |beta - beta0|^g), the scatter of polished surfaces"},
      {Ndf::kAbgAnisotropic, "abg-anisotropic", "the same, anisotropic, rotated about the normal"},
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
      {Masking::kNone, "none", "of ndf abg, which is f_r itself"},
  };
  return choices;
}

const std::vector<Choice<Fresnel>>& FresnelChoices() {
  static const std::vector<Choice<Fresnel>> choices = {
      {Fresnel::kSchlick, "schlick", "Schlick's approximation with f0 a channel"},
      {Fresnel::kConductor, "conductor", "exact, with eta and k a channel, or those of a metal"},
      {Fresnel::kDielectric, "dielectric", "exact, with a refractive index a channel"},
      {Fresnel::kSchlickF82, "schlick-f82", "Schlick's with an edge tint, f0 and tint a channel"},
      {Fresnel::kCurve, "curve", "a free curve over the angle, six coefficients a channel"},
      {Fresnel::kNone, "none", "no Fresnel term, a free scale a channel"},
      {Fresnel::kCoatLayered, "coat-layered", "dielectric surface of a coat over all other lobes and the diffuse part"},
      {Fresnel::kCoatRefracted, "coat-refracted", "the same, refracting the directions below it"},
  };
  return choices;
}

const std::vector<Choice<Diffuse>>& DiffuseChoices() {
  static const std::vector<Choice<Diffuse>> choices = {
      {Diffuse::kLambert, "lambert", "constant f_r"},
      {Diffuse::kMicrofacet, "microfacet", "the facets of the first lobe are Lambertian"},
      {Diffuse::kInterfaced, "interfaced", "Lambertian below a smooth dielectric"},
      {Diffuse::kOrenNayar, "oren-nayar", "rough, energy-preserving"},
      {Diffuse::kNone, "none", "no diffuse part"},
  };
  return choices;
}

const std::vector<Choice<LobeDirection>>& LobeDirectionChoices() {
  static const std::vector<Choice<LobeDirection>> choices = {
      {LobeDirection::kSpecular, "specular", "about the mirror direction"},
      {LobeDirection::kRetro, "retro", "about the back direction; lobes about the normal"},
  };
  return choices;
}

}  // namespace lobefit

// What can be fitted: a reflectance model as a sum of specular lobes and a diffuse part, and the one table of its
// parameters, from which recipes, bounds, JSON documents, help and report columns take names, units and ranges.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/base/choice.h"
#include "lobefit/core/masking/masking.h"
#include "lobefit/core/radial/family.h"
#include "lobefit/core/radial/profile_masking.h"

namespace lobefit {

enum class Ndf {
  kGgx,        // isotropic GGX: alpha_y tied to alpha_x, no rotation
  kGgxTilted,  // isotropic ellipsoid whose axis may tilt within one plane: alpha_y tied, theta_y free, theta_z fixed
  kGgxAnisotropic,  // alpha_x, alpha_y, theta_z; axis along the normal
  kEllipsoid,       // all five parameters [Walter eq 1]
  // Beckmann in slope space [Heitz eq 61-67, 78-95]. The five parameters name the ellipse in slope space: mean and
  // widths are those of the GGX ellipsoid with the same parameters; without tilt they are Beckmann's own alphas.
  kBeckmann,
  kBeckmannAnisotropic,
  kBeckmannOffCenter,
  // On the whole sphere of normals [dEon eq 26, 28]; one alpha.
  kKagiwadaKalaba,     // b = 1 / (1 + alpha^2 / 2), so that a narrow lobe falls to half at the angle alpha
  kSphericalGaussian,  // k = 2 / alpha^2, so that a narrow lobe is Beckmann's
  // A free radial profile (profile.h) and Student's (student.h) on the ellipse in slope space, in GGX's four shapes.
  // The five parameters name the ellipse, as for Beckmann; then gamma, or q1 .. qK.
  kProfile,
  kProfileTilted,
  kProfileAnisotropic,
  kProfileEllipsoid,
  kStudent,
  kStudentTilted,
  kStudentAnisotropic,
  kStudentEllipsoid,
  // Scatter of polished surfaces, round and anisotropic (abg_lobe.h): the ellipse, then g.
  kAbg,
  kAbgAnisotropic,
};

Family FamilyOf(Ndf ndf);
bool IsRound(Ndf ndf);      // alpha_y follows alpha_x
bool IsTilted(Ndf ndf);     // the axis may leave the normal
bool IsInPlane(Ndf ndf);    // round, and tilted within the plane of the measurement
bool HasExponent(Ndf ndf);  // one number after the ellipse, gamma or g

enum class Fresnel {
  kSchlick,     // F = f0 + (1 - f0) (1 - cos_theta_d)^5, f0 a channel
  kConductor,   // exact, complex index eta + i k a channel
  kDielectric,  // exact, index ior a channel
  kSchlickF82,  // Schlick with an edge tint, f0 and tint a channel
  kCurve,       // cubic B-spline over cos_theta_d, six coefficients a channel
  kNone,        // a free scale a channel instead of F
  // The lobe is the dielectric surface of a coat over all other lobes and the diffuse part (coat.h): ior common to the
  // channels, tau a channel; seen through it straight or refracted.
  kCoatLayered,
  kCoatRefracted,
};

enum class Diffuse {
  kLambert,
  kMicrofacet,  // the facets of the first lobe are Lambertian [Heitz eq 31]
  kInterfaced,  // below a smooth dielectric (diffuse.h), by its apparent albedo
  kOrenNayar,   // rough facets, energy-preserving
  kNone,
};

// About which direction a lobe lies.
enum class LobeDirection {
  kSpecular,
  kRetro,  // the back direction: the lobe at (mirrored wi, wo), coat.h; lobes about the normal only
};

struct Lobe {
  Ndf ndf = Ndf::kEllipsoid;
  Masking masking = Masking::kSmithSeparable;
  Fresnel fresnel = Fresnel::kSchlick;
  std::string metal = {};  // kConductor: eta and k are those of this metal (optical_constants.h), not fitted
  LobeDirection direction = LobeDirection::kSpecular;
  // Knots of a profile; null: those that the data reach (fit), else 0 1 2 4 8 16 32.
  std::shared_ptr<const ProfileGrid> grid = nullptr;
};

struct Model {
  std::vector<Lobe> lobes;
  Diffuse diffuse = Diffuse::kLambert;
};

// The lobe that is a coat over the others; none: model.lobes.size().
bool IsCoat(Fresnel fresnel);
std::size_t CoatOf(const Model& model);

// Why this program does not evaluate the combination, in words that name what would work; empty: it does.
std::string WhyNotEvaluable(const Model& model);

enum class ParameterGroup { kShape, kFresnel, kDiffuse };

struct Parameter {
  std::string name;       // inside, angles in radians: "theta_x"; the second lobe's are prefixed: "lobe2.theta_x"
  std::string json_name;  // outside, angles in degrees: "theta_x_deg"
  std::string unit;       // of the outside value: "deg", "1" for none
  // Bounds of a fit unless a recipe says otherwise, inside units. A recipe may narrow them; the upper one of amplitudes
  // and albedos, which says that no surface reflects more than it receives, it may widen too (values that are not
  // calibrated).
  double low = 0;
  double high = 0;
  ParameterGroup group = ParameterGroup::kShape;
  bool per_channel = false;
  bool free = true;         // false: fixed or tied by the choice of NDF (shown, not fitted)
  std::string description;  // one line for people
  double start = 0;         // where a fit begins that knows nothing better
  bool shared = false;      // per_channel, but one value for all channels unless a recipe says otherwise
  // A factor of what is reflected, of which the values are a multiple: in arbitrary units it may be up to
  // kLargestReflectance.
  bool is_reflectance = false;
};
inline constexpr double kLargestReflectance = 1e12;

// The parameters in their fixed order: for each lobe alpha_x, alpha_y, theta_x, theta_y, theta_z and those of its
// profile (gamma; g; or q1 .. qK), then those of its Fresnel term (f0; f0, tint; F_0 .. F_5; eta, k; ior; ior, tau; or
// scale); then
// the diffuse part's (interface_ior; or diffuse_roughness), last its albedo.
std::vector<Parameter> Parameters(const Model& model);

inline constexpr std::size_t kEllipseParameters = 5;
inline constexpr std::size_t kMaxFresnelParameters = 6;
std::size_t FresnelParameters(Fresnel fresnel);
// Those of the ellipse and of the profile.
std::size_t ShapeParameters(const Lobe& lobe);
// The diffuse part's, its albedo the last of them.
std::size_t DiffuseParameters(Diffuse diffuse);
// Index of a lobe's alpha_x in Parameters(model); lobe = model.lobes.size(): index of the diffuse part's first.
std::size_t FirstParameter(const Model& model, std::size_t lobe);
// Index of the first parameter of a lobe's Fresnel term.
std::size_t FirstFresnel(const Model& model, std::size_t lobe);

// Throws InputError as ProfileSpline does.
std::shared_ptr<const ProfileGrid> GridWithKnots(const std::vector<double>& knots);
// The knots' grid of a profile lobe; the default one where the lobe names none. Null for other families.
const std::shared_ptr<const ProfileGrid>& GridOf(const Lobe& lobe);

// inside value = outside value * factor.
double InsideFactor(const Parameter& parameter);

// Values of the parameters in the order of Parameters(model): one number each, or one a channel where per_channel;
// inside units.
using ParameterValues = std::vector<std::vector<double>>;

const std::vector<Choice<Ndf>>& NdfChoices();
const std::vector<Choice<Masking>>& MaskingChoices();
const std::vector<Choice<Fresnel>>& FresnelChoices();
const std::vector<Choice<Diffuse>>& DiffuseChoices();
const std::vector<Choice<LobeDirection>>& LobeDirectionChoices();

}  // namespace lobefit

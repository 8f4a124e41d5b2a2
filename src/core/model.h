// What can be fitted: a reflectance model as a sum of specular lobes and a diffuse part, and the one table of its
// parameters, from which recipes, bounds, JSON documents, help and report columns take names, units and ranges.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

enum class Ndf {
  kGgx,        // isotropic GGX: alpha_y tied to alpha_x, no rotation
  kGgxTilted,  // isotropic ellipsoid whose axis may tilt within one plane: alpha_y tied, theta_y free, theta_z fixed
  kGgxAnisotropic,  // alpha_x, alpha_y, theta_z; axis along the normal
  kEllipsoid,       // all five parameters [Walter eq 1]
};

// Masking and shadowing for both directions.
enum class Masking {
  kSmithSeparable,  // G1(wi) G1(wo), each min(1, cos / sigma) [Walter eq 5-6]; the min is a kink for tilted lobes
  kSmithUnclamped,  // the same without the min: smooth, but energy can be created on one side of a tilted lobe
  kSmithHeight,     // height-correlated [Heitz eq 99] with 1 + Lambda = max(1, sigma / cos)
};

enum class Fresnel {
  kSchlick,  // F = f0 + (1 - f0) (1 - cos_theta_d)^5, f0 a channel
  kNone,     // a free scale a channel instead of F
};

enum class Diffuse { kLambert, kNone };

struct Lobe {
  Ndf ndf = Ndf::kEllipsoid;
  Masking masking = Masking::kSmithSeparable;
  Fresnel fresnel = Fresnel::kSchlick;
};

struct Model {
  std::vector<Lobe> lobes;
  Diffuse diffuse = Diffuse::kLambert;
};

enum class ParameterGroup { kShape, kFresnel, kDiffuse };

struct Parameter {
  std::string name;       // inside, angles in radians: "theta_x"; the second lobe's are prefixed: "lobe2.theta_x"
  std::string json_name;  // outside, angles in degrees: "theta_x_deg"
  std::string unit;       // of the outside value: "deg", "1" for none
  // Bounds of a fit unless a recipe says otherwise, inside units. A recipe may narrow them; those of amplitudes and
  // albedos, which say that no surface reflects more than it receives, it may widen too (values that are not
  // calibrated).
  double low = 0;
  double high = 0;
  ParameterGroup group = ParameterGroup::kShape;
  bool per_channel = false;
  bool free = true;         // false: fixed or tied by the choice of NDF (shown, not fitted)
  std::string description;  // one line for people
};

// The parameters in their fixed order: for each lobe alpha_x, alpha_y, theta_x, theta_y, theta_z, then f0 or scale;
// last the diffuse albedo.
std::vector<Parameter> Parameters(const Model& model);

// inside value = outside value * factor.
double InsideFactor(const Parameter& parameter);

// Values of the parameters in the order of Parameters(model): one number each, or one a channel where per_channel;
// inside units.
using ParameterValues = std::vector<std::vector<double>>;

// Words for the choices, as recipes, documents and help spell them.
template <class Enum>
struct Choice {
  Enum value;
  const char* name;
  const char* description;
};
const std::vector<Choice<Ndf>>& NdfChoices();
const std::vector<Choice<Masking>>& MaskingChoices();
const std::vector<Choice<Fresnel>>& FresnelChoices();
const std::vector<Choice<Diffuse>>& DiffuseChoices();

template <class Enum>
const char* NameOf(const std::vector<Choice<Enum>>& choices, Enum value) {
  for (const Choice<Enum>& choice : choices) {
    if (choice.value == value) return choice.name;
  }
  return "?";
}

template <class Enum>
const Choice<Enum>* Find(const std::vector<Choice<Enum>>& choices, std::string_view name) {
  for (const Choice<Enum>& choice : choices) {
    if (name == choice.name) return &choice;
  }
  return nullptr;
}

template <class Enum>
std::vector<std::string> Names(const std::vector<Choice<Enum>>& choices) {
  std::vector<std::string> names;
  for (const Choice<Enum>& choice : choices) names.emplace_back(choice.name);
  return names;
}

}  // namespace lobefit

#include "lobefit/validate/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

Ellipsoid EllipsoidAt(const ParameterValues& values, std::size_t first) {
  return {values[first][0], values[first + 1][0], values[first + 2][0], values[first + 3][0], values[first + 4][0]};
}

void PutEllipsoid(const Ellipsoid& e, std::size_t first, ParameterValues* values) {
  const double numbers[5] = {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z};
  for (std::size_t i = 0; i < 5; ++i) (*values)[first + i] = {numbers[i]};
}

struct Drawn {
  double low, high;
};
// What a parameter other than those of the ellipses is drawn from; none: it stays as it is, as optical constants do and
// what a fit leaves where it is.
std::optional<Drawn> RangeOf(const Parameter& parameter, const MaterialRange& range) {
  if (!parameter.free) return std::nullopt;
  const std::string name = parameter.name.substr(parameter.name.find('.') + 1);
  if (name == "diffuse") return Drawn{range.diffuse_low, range.diffuse_high};
  if (name == "f0" || name == "scale" || name.starts_with("F_")) return Drawn{range.f0_low, range.f0_high};
  if (name == "tint") return Drawn{0.5, 1.1};
  if (name == "diffuse_roughness") return Drawn{0.1, 0.9};
  if (name == "gamma") return Drawn{1.6, 6};
  if (name == "g") return Drawn{1.2, 4};
  if (name.starts_with("q")) return Drawn{-0.4, 2};
  if (name == "ior" && parameter.shared) return Drawn{1.3, 2.2};  // of a coat
  return std::nullopt;
}

// The other writing of the same distribution.
Ellipsoid TurnedByPi(const Ellipsoid& e) {
  return {e.alpha_x, e.alpha_y, -e.theta_x, -e.theta_y, e.theta_z > 0 ? e.theta_z - kPi : e.theta_z + kPi};
}

}  // namespace

Truth TruthOf(const Material& material) { return {material.model, material.Values(), material.channels}; }

Truth TruthOf(const Recipe& recipe, const std::vector<std::string>& channels, const std::string& source) {
  Truth truth = {recipe.model, {}, channels};
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterRecipe& entry = recipe.parameters[i];
    std::vector<double> values = entry.fixed.empty() ? entry.start : entry.fixed;
    if (values.empty() && !parameters[i].free) {
      // alpha_y is tied to alpha_x, an angle is 0; an index of an interface has a start of its own.
      const bool tied = parameters[i].group == ParameterGroup::kShape && parameters[i].unit != "deg";
      values = {tied ? truth.values[i - 1][0] : parameters[i].start};
    }
    const std::size_t wanted = parameters[i].per_channel ? channels.size() : 1;
    if (values.size() == 1) values.resize(wanted, values[0]);
    if (values.size() != wanted) {
      throw InputError(fmt::format(
          "{}: parameter '{}' has {} values, {} are needed for channels {}; give it a start or a fixed value", source,
          parameters[i].json_name, values.size(), wanted, fmt::join(channels, ",")));
    }
    truth.values.push_back(values);
  }
  return truth;
}

Material MaterialOf(const Truth& truth) {
  Material material;
  material.model = truth.model;
  material.channels = truth.channels;
  for (const std::vector<double>& values : truth.values) {
    FittedParameter parameter;
    parameter.values = values;
    parameter.standard_error.assign(values.size(), kNan);
    parameter.standard_error_clustered = parameter.freedom = parameter.standard_error;
    parameter.free = false;
    material.parameters.push_back(parameter);
  }
  for (std::size_t l = 0; l < truth.model.lobes.size(); ++l) {
    const OffCenter o = OffCenterFromEllipsoid(EllipsoidAt(truth.values, FirstParameter(truth.model, l)));
    const double ax = std::sqrt(o.q11), ay = std::sqrt(o.q22);
    material.slope_space.push_back({o.slope_x, o.slope_y, ax, ay, o.q12 / (ax * ay)});
  }
  material.termination = {true, true, "truth of a synthetic measurement", 0};
  material.timings_s = {{"read", 0.0}, {"fit", 0.0}, {"report", 0.0}};
  return material;
}

BrdfFunction BrdfOf(const Truth& truth) {
  const auto reflectance = std::make_shared<const Reflectance>(truth.model, truth.values, truth.channels.size());
  return [reflectance](const Vec3& wi, const Vec3& wo, double* values) { reflectance->Evaluate(wi, wo, values); };
}

double SmallestAlpha(const Truth& truth) {
  double smallest = 1;
  for (std::size_t l = 0; l < truth.model.lobes.size(); ++l) {
    const Ellipsoid e = EllipsoidAt(truth.values, FirstParameter(truth.model, l));
    smallest = std::min({smallest, e.alpha_x, e.alpha_y});
  }
  return smallest;
}

std::vector<Entry> Entries(const Model& model, const std::vector<std::string>& channels) {
  std::vector<Entry> entries;
  const std::vector<Parameter> parameters = Parameters(model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::size_t count = parameters[i].per_channel ? channels.size() : 1;
    for (std::size_t c = 0; c < count; ++c) {
      const bool label = parameters[i].per_channel && channels.size() > 1;
      entries.push_back({label ? parameters[i].json_name + "[" + channels[c] + "]" : parameters[i].json_name,
                         parameters[i].unit, i, c, InsideFactor(parameters[i])});
    }
  }
  return entries;
}

ParameterValues AlignedWith(const ParameterValues& reported, const Truth& truth) {
  ParameterValues aligned = truth.values;
  for (std::size_t l = 0; l < truth.model.lobes.size(); ++l) {
    if (IsRound(truth.model.lobes[l].ndf)) continue;
    const std::size_t first = FirstParameter(truth.model, l);
    Ellipsoid e = EllipsoidFromSlopeCoordinates(SlopeCoordinatesFromEllipsoid(EllipsoidAt(truth.values, first)));
    const Ellipsoid other = TurnedByPi(e);
    const double wanted = reported[first + 4][0];
    if (std::fabs(other.theta_z - wanted) < std::fabs(e.theta_z - wanted)) e = other;
    PutEllipsoid(e, first, &aligned);
  }
  return aligned;
}

double SlopeDifference(const Truth& a, const ParameterValues& b) {
  double largest = 0;
  for (std::size_t l = 0; l < a.model.lobes.size(); ++l) {
    const OffCenter x = OffCenterFromEllipsoid(EllipsoidAt(a.values, FirstParameter(a.model, l)));
    const OffCenter y = OffCenterFromEllipsoid(EllipsoidAt(b, FirstParameter(a.model, l)));
    const SlopeCoordinates u = SlopeCoordinatesFromOffCenter(x), v = SlopeCoordinatesFromOffCenter(y);
    const double width = std::sqrt(std::max(x.q11, x.q22));
    // Logarithms differ by relative amounts already.
    const double scale[5] = {width, width, 1, width, 1};
    for (int i = 0; i < 5; ++i) largest = std::max(largest, std::fabs(u.v[i] - v.v[i]) / scale[i]);
  }
  return largest;
}

Truth DrawMaterial(const MaterialRange& range, const Truth& like, RandomNumbers* random) {
  Truth truth = like;
  const std::vector<Parameter> parameters = Parameters(like.model);
  for (std::size_t l = 0; l < like.model.lobes.size(); ++l) {
    const Ndf ndf = like.model.lobes[l].ndf;
    const std::size_t first = FirstParameter(like.model, l);
    const auto log_uniform = [&](double low, double high) {
      return std::exp(random->Uniform(std::log(low), std::log(high)));
    };
    Ellipsoid e;
    e.alpha_x = log_uniform(range.alpha_low, range.alpha_high);
    const double ratio = log_uniform(1, std::min(range.largest_anisotropy, e.alpha_x / range.alpha_low));
    const double tilt = random->Uniform(0, range.largest_tilt), towards = random->Uniform(-kPi, kPi);
    const double turn = random->Uniform(-kPi / 2, kPi / 2);
    const bool anisotropic = !IsRound(ndf);
    e.alpha_y = anisotropic ? e.alpha_x / ratio : e.alpha_x;
    if (anisotropic) e.theta_z = turn;
    if (anisotropic && IsTilted(ndf)) {
      // Row 3 of R is the lobe's axis: sin(tilt) (cos, sin)(towards), turned by theta_z with the axes.
      e.theta_x = std::asin(std::sin(tilt) * std::sin(towards));
      e.theta_y = -std::atan(std::tan(tilt) * std::cos(towards));
    }
    if (!anisotropic && IsTilted(ndf)) e.theta_y = tilt * (std::cos(towards) < 0 ? -1 : 1);
    PutEllipsoid(e, first, &truth.values);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::optional<Drawn> drawn = RangeOf(parameters[i], range);
    if (!drawn) continue;
    for (double& value : truth.values[i]) value = random->Uniform(drawn->low, drawn->high);
    if (parameters[i].shared) truth.values[i].assign(truth.values[i].size(), truth.values[i][0]);
  }
  return truth;
}

}  // namespace lobefit

#include "lobefit/maps/report/doubts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/maps/engine/factor.h"

namespace lobefit {
namespace {

// Lights below are in shadow, in units of the texel's 90th percentile; the fit's loss in the same unit.
constexpr double kDark = 0.15, kLoss = 0.05;
constexpr std::size_t kFewest = 12;
constexpr double kStep = 1e-4;  // of the nearness, for its derivative
// What is said: beyond five standard errors, and an exponent off by this much, or normals bent by this many radians.
constexpr double kErrors = 5, kOffExponent = 0.005, kLeastBend = 0.005;

}  // namespace

DoubtMeter::DoubtMeter(std::vector<Vec3> lights, bool schlick, int channels)
    : directions_(std::move(lights)), schlick_(schlick), channels_(static_cast<std::size_t>(channels)) {
  lights_.Resize(directions_.size());
  shape_.Resize(lights_.padded);
}

Estimate DoubtMeter::Pool::Slope() const {
  double sum_xy = 0, sum_xx = 0, squares = 0;
  for (std::size_t t = 0; t < xx.size(); ++t) sum_xy += xy[t], sum_xx += xx[t];
  if (!(sum_xx > 0)) return {};
  const double slope = sum_xy / sum_xx;
  for (std::size_t t = 0; t < xx.size(); ++t) squares += (xy[t] - slope * xx[t]) * (xy[t] - slope * xx[t]);
  return {slope, std::sqrt(squares) / sum_xx};
}

void DoubtMeter::Predict(const RelitTexel& texel, double x, double y, double nearness, bool gradient,
                         std::vector<double>* values) {
  std::vector<double> irradiance;
  for (std::size_t l = 0; l < directions_.size(); ++l) {
    const Vec3 beam = directions_[l] - nearness * Vec3{x, y, 0};
    lights_.Set(l, Normalized(beam), {0, 0, 1}, schlick_);
    irradiance.push_back(1 / Dot(beam, beam));
  }
  EvaluateShape(texel.lobe, texel.point, lights_, gradient, &shape_);
  values->assign(directions_.size(), 0);
  for (std::size_t l = 0; l < directions_.size(); ++l) {
    for (std::size_t c = 0; c < channels_; ++c) {
      double value = texel.point.diffuse[c] * kInvPi * shape_.cosine[l];
      if (texel.lobe != MapLobe::kNone) {
        value += (texel.point.f0[c] * (1 - lights_.k[l]) + lights_.k[l]) * shape_.specular[l];
      }
      (*values)[l] += irradiance[l] * value;
    }
  }
}

// Derivatives of the texel's values by its own numbers, of the shape that Predict left.
void DoubtMeter::MakeColumns(const RelitTexel& texel) {
  double diffuse = 0, f0 = 0;
  for (std::size_t c = 0; c < channels_; ++c) diffuse += texel.point.diffuse[c] * kInvPi, f0 += texel.point.f0[c];
  const bool lobe = texel.lobe != MapLobe::kNone;
  const int widths = !lobe ? 0 : texel.lobe == MapLobe::kGgx ? 1 : 3;
  columns_.assign(static_cast<std::size_t>(2 + widths + (lobe ? 2 : 1)), std::vector<double>(directions_.size()));
  for (std::size_t l = 0; l < directions_.size(); ++l) {
    const double fresnel = f0 * (1 - lights_.k[l]) + static_cast<double>(channels_) * lights_.k[l];
    std::size_t at = 0;
    for (int j = 0; j < 2; ++j) {
      columns_[at++][l] = diffuse * shape_.dcosine[j][l] + (lobe ? fresnel * shape_.dspecular[j][l] : 0);
    }
    for (int j = 0; j < widths; ++j) columns_[at++][l] = fresnel * shape_.dspecular[2 + j][l];
    columns_[at++][l] = shape_.cosine[l];
    if (lobe) columns_[at++][l] = (1 - lights_.k[l]) * shape_.specular[l];
  }
}

bool DoubtMeter::Project(std::vector<double>* change, double turns[2]) const {
  MapVector answer = {};
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    for (std::size_t l = 0; l < change->size(); ++l) answer[j] += weights_[l] * columns_[j][l] * (*change)[l];
  }
  SolveFactorised(static_cast<int>(columns_.size()), factor_, &answer);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    for (std::size_t l = 0; l < change->size(); ++l) (*change)[l] -= answer[j] * columns_[j][l];
  }
  turns[0] = answer[0], turns[1] = answer[1];
  return std::isfinite(answer[0]) && std::isfinite(answer[1]);
}

void DoubtMeter::Add(const std::vector<double>& values, const RelitTexel& texel, double x, double y) {
  if (texel.hidden) return;
  std::vector<double> fit, moved;
  Predict(texel, x, y, kStep, false, &moved);
  Predict(texel, x, y, 0, true, &fit);
  MakeColumns(texel);
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
  if (sorted.size() < kFewest) return;
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 9 / 10);
  std::nth_element(sorted.begin(), at, sorted.end());
  const double scale = *at;
  std::size_t used = 0;
  std::vector<double> rest(values.size()), near(values.size()), power(values.size());
  weights_.assign(values.size(), 0);
  for (std::size_t l = 0; l < values.size(); ++l) {
    if (!std::isfinite(values[l]) || std::min(values[l], fit[l]) < kDark * scale) continue;
    rest[l] = (values[l] - fit[l]) / scale;
    near[l] = (moved[l] - fit[l]) / (kStep * scale);
    power[l] = fit[l] / scale * std::log(fit[l] / scale);
    weights_[l] = 1 / (1 + rest[l] * rest[l] / (kLoss * kLoss));
    ++used;
  }
  if (used < kFewest) return;
  factor_ = {};
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    for (std::size_t k = 0; k <= j; ++k) {
      for (std::size_t l = 0; l < values.size(); ++l) factor_[k][j] += weights_[l] * columns_[j][l] * columns_[k][l];
    }
  }
  if (!Factorise(static_cast<int>(columns_.size()), {}, &factor_)) return;
  double turns[2], ignored[2];
  if (!Project(&rest, ignored) || !Project(&power, ignored) || !Project(&near, turns)) return;
  double near_xy = 0, near_xx = 0, power_xy = 0, power_xx = 0;
  for (std::size_t l = 0; l < values.size(); ++l) {
    near_xy += weights_[l] * near[l] * rest[l], near_xx += weights_[l] * near[l] * near[l];
    power_xy += weights_[l] * power[l] * rest[l], power_xx += weights_[l] * power[l] * power[l];
  }
  nearness_.xy.push_back(near_xy), nearness_.xx.push_back(near_xx);
  exponent_.xy.push_back(power_xy), exponent_.xx.push_back(power_xx);
  bend_ += std::hypot(turns[0], turns[1]) * scale;
}

StackDoubts DoubtMeter::Result() const {
  const auto count = static_cast<double>(std::max<std::size_t>(nearness_.xx.size(), 1));
  return {exponent_.Slope(), nearness_.Slope(), bend_ / count};
}

std::vector<std::string> StackDoubts::Remarks() const {
  std::vector<std::string> remarks;
  if (std::fabs(exponent.value) > kErrors * exponent.error && std::fabs(exponent.value) > kOffExponent) {
    remarks.push_back(fmt::format(
        "the photographs bend away from the fit as a wrong encoding makes them: is it right? (Power {:.4f} +- {:.1g} "
        "to "
        "first order, of which normals and lobes hide most; below 1 where encoded values are taken as linear or light "
        "comes from elsewhere, above where linear ones are decoded.)",
        1 + exponent.value, exponent.error));
  }
  if (nearness.value > kErrors * nearness.error && nearness.value * bend > kLeastBend) {
    remarks.push_back(
        fmt::format("the lights seem to be {:.2g} widths of the picture away (to first order; {:.3f} +- {:.1g} in 1 / "
                    "width): taken as distant, they bend the normals by about {:.1f} degrees (mean); give their "
                    "positions, kind = \"position\" in a stack.toml",
                    1 / nearness.value, nearness.value, nearness.error, nearness.value * bend * 180 / kPi));
  }
  return remarks;
}

}  // namespace lobefit

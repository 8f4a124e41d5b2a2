#include "lobefit/measurement/checks/isotropy.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "lobefit/measurement/interpolation.h"

namespace lobefit {
namespace {

double QuantileOf(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double MeanValue(const Samples& samples, std::size_t i) {
  double sum = 0;
  for (const std::vector<double>& values : samples.values) sum += values[i];
  return sum / static_cast<double>(samples.values.size());
}

}  // namespace

Samples SpreadOverAzimuths(const Samples& samples) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  Samples spread = samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle = golden * static_cast<double>(i), c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](const Vec3& w, double* x, double* y) {
      *x = c * w.x - s * w.y;
      *y = s * w.x + c * w.y;
    };
    turn(samples.wi(i), &spread.wi_x[i], &spread.wi_y[i]);
    turn(samples.wo(i), &spread.wo_x[i], &spread.wo_y[i]);
  }
  return spread;
}

bool HasOneAzimuth(const Samples& samples) {
  std::optional<double> azimuth;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::hypot(samples.wi_x[i], samples.wi_y[i]) < 0.02) continue;
    const double own = std::atan2(samples.wi_y[i], samples.wi_x[i]);
    if (!azimuth) azimuth = own;
    if (std::fabs(std::remainder(own - *azimuth, 2 * kPi)) > 0.01) return false;
  }
  return true;
}

bool IsotropicPairs::ShowIsotropy() const {
  return pairs >= 20 && bright >= 10 && median < 0.03 && percentile_90 < 0.1 && bright_median < 0.03;
}

IsotropicPairs CompareIsotropicPairs(const Measurement& measurement) {
  constexpr double kSame = 0.005, kApart = 10 * kPi / 180, kOffNormal = 3 * kPi / 180;
  const Samples& samples = measurement.samples;
  IsotropicPairs result;
  if (samples.size() == 0) return result;
  Measurement isotropic = measurement;
  isotropic.isotropic = true;
  const Interpolator interpolator(isotropic);
  std::vector<double> means(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) means[i] = MeanValue(samples, i);
  const double bright = QuantileOf(means, 0.5);
  // The half vector's azimuth from the plane of incidence; about the normal it has none.
  const auto azimuth = [&](std::size_t i) -> std::optional<double> {
    const Vec3 wi = samples.wi(i), h = Normalized(wi + samples.wo(i));
    if (std::hypot(h.x, h.y) < std::sin(kOffNormal) || std::hypot(wi.x, wi.y) < 0.02) return std::nullopt;
    return std::atan2(h.y, h.x) - std::atan2(wi.y, wi.x);
  };
  std::vector<double> differences, of_bright;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::optional<std::size_t> other = interpolator.Nearest(samples.wo(i), samples.wi(i), kSame);
    if (!other || *other == i) continue;
    const std::optional<double> own = azimuth(i), its = azimuth(*other);
    // An ellipse of normals is the same after half a turn, and mirrored where its axes lie in the plane of incidence.
    if (!own || !its || std::fabs(std::remainder(*own - *its, kPi)) < kApart ||
        std::fabs(std::remainder(*own + *its, kPi)) < kApart)
      continue;
    const double mean = 0.5 * (std::fabs(means[i]) + std::fabs(means[*other]));
    if (!(mean > 0)) continue;
    differences.push_back(std::fabs(means[i] - means[*other]) / mean);
    if (std::max(means[i], means[*other]) >= bright) of_bright.push_back(differences.back());
  }
  result.pairs = differences.size();
  result.bright = of_bright.size();
  result.median = QuantileOf(differences, 0.5);
  result.percentile_90 = QuantileOf(differences, 0.9);
  result.bright_median = QuantileOf(of_bright, 0.5);
  return result;
}

}  // namespace lobefit

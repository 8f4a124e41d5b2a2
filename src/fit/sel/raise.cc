#include "lobefit/fit/sel/raise.h"

#include <algorithm>

#include "lobefit/fit/objective/prediction.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kMargin = 1 + 1e-9;

// The slice nearest to an incident direction.
std::size_t NearestSlice(const SelTable& table, const Vec3& wi) {
  const double theta = PolarAngle(wi), phi = Azimuth(wi);
  std::size_t nearest = 0;
  double best = -2;
  for (std::size_t s = 0; s < table.slices.size(); ++s) {
    const Vec3 at = FromSpherical(table.slices[s].theta_i, table.isotropic ? phi : table.slices[s].phi_i);
    const double cosine = Dot(at, FromSpherical(theta, phi));
    if (cosine > best) {
      best = cosine;
      nearest = s;
    }
  }
  return nearest;
}

void Raise(double factor, SelSlice* slice) {
  for (std::vector<double>& amplitude : slice->amplitude) {
    for (double& a : amplitude) a *= factor;
  }
  for (double& constant : slice->constant) constant *= factor;
}

}  // namespace

void RaiseAboveSamples(const Measurement& measurement, ThreadPool* pool, Material* material) {
  const Samples& samples = measurement.samples;
  SelTable& table = *material->sel;
  for (int round = 0; round < 8; ++round) {
    const std::vector<std::vector<double>> f_r = Predict(*material, samples, pool);
    std::vector<double> factor(table.slices.size(), 1.0);
    double worst = 1;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double ratio = 1;
      for (std::size_t c = 0; c < f_r.size(); ++c) {
        if (samples.values[c][i] > 0) ratio = std::max(ratio, kMargin * samples.values[c][i] / f_r[c][i]);
      }
      if (ratio <= 1) continue;
      worst = std::max(worst, ratio);
      double& nearest = factor[NearestSlice(table, samples.wi(i))];
      nearest = std::max(nearest, ratio);
    }
    if (worst <= 1) return;
    // The last round raises all slices alike, which cannot leave a sample above.
    for (std::size_t s = 0; s < table.slices.size(); ++s) Raise(round < 6 ? factor[s] : worst, &table.slices[s]);
  }
}

}  // namespace lobefit

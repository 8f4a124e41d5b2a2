// bench_sel_accuracy: how well a squared ellipsoidal lobe stands for the GGX reflection lobe, as the Markdown tables of
// fits/README.md.
//
// The lobe: D G1(wi) G1(wo) / (4 cos_theta_i cos_theta_o) of isotropic GGX [Walter eq 4-6] without Fresnel term, or
// that times cos_theta_o, over the hemisphere of wo. One squared ellipsoidal lobe and a constant are fitted to it by
// least squares over solid angle. Errors: of the difference's L2 norm over the lobe's, and of the largest difference
// over the largest value.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/sel/slice.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr int kRings = 64, kSpokes = 48;

// The lobe on rings about the mirror direction whose radii grow geometrically from a fiftieth of its width; weights of
// the fit are solid angles times what turns the metric's cosine_i into g.
SelSamples LobeSamples(double alpha, double theta_i, SelQuantity quantity, std::vector<double>* solid_angle) {
  const Vec3 wi = FromSpherical(theta_i, 0);
  const Mat3 to_world = Transposed(MirrorFrame(wi));
  const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({alpha, alpha, 0, 0, 0});
  const double low = std::log(0.02 * alpha), high = std::log(50.0);
  const auto radius = [&](int ring) {
    return ring == 0 ? 0.0 : 2 * std::atan(std::exp(low + (high - low) * (ring - 1) / (kRings - 1)));
  };
  SelSamples samples;
  samples.f_r.resize(1);
  double cos_d = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double from = radius(ring), to = radius(ring + 1);
    const double middle = 0.5 * (from + to);
    const double area = 2 * std::sin(middle) * std::sin(0.5 * (to - from)) * 2 * kPi / kSpokes;
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const Vec3 v = FromSpherical(middle, 2 * kPi * (spoke + 0.5) / kSpokes);
      const Vec3 wo = to_world * v;
      if (wo.z <= 1e-3) continue;
      samples.v.push_back(v);
      samples.cos_i.push_back(1);
      samples.cos_o.push_back(wo.z);
      samples.f_r[0].push_back(GgxLobe(wi, wo, shape, Masking::kSmithSeparable, &cos_d, nullptr));
      samples.weight.push_back(quantity == SelQuantity::kBrdf ? area : area * wo.z * wo.z);
      solid_angle->push_back(area);
    }
  }
  // To a largest value of 1, so that the descent's tolerances mean the same for every lobe.
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) largest = std::max(largest, samples.Value(quantity, 0, i));
  for (double& f_r : samples.f_r[0]) f_r /= largest;
  return samples;
}

struct LobeErrors {
  double l2, largest;
};

LobeErrors Measure(double alpha, double theta_i, SelQuantity quantity) {
  std::vector<double> solid_angle;
  const SelSamples samples = LobeSamples(alpha, theta_i, quantity, &solid_angle);
  SelSliceOptions options;
  options.transform = {Curve::kLinear};
  options.quantity = quantity;
  options.max_iterations = 300;
  const SelSlice slice = SearchSelSlice(samples, theta_i, 1, options, samples.size()).slice;
  const SelLobeInFrame lobe(slice.lobes[0]);
  double difference = 0, norm = 0, largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double g = samples.Value(quantity, 0, i);
    const double d = slice.amplitude[0][0] * lobe.Evaluate(samples.v[i], nullptr) + slice.constant[0] - g;
    difference += solid_angle[i] * d * d;
    norm += solid_angle[i] * g * g;
    largest = std::max(largest, std::fabs(d));
  }
  return {std::sqrt(difference / norm), largest};
}

void PrintTable(SelQuantity quantity) {
  constexpr int kTheta[] = {0, 15, 30, 45, 60, 75, 85};
  std::printf("%s, L2 / largest error in per cent:\n\n| alpha |",
              quantity == SelQuantity::kBrdf ? "f_r" : "f_r cos theta_o");
  for (const int theta : kTheta) std::printf(" %d deg |", theta);
  std::printf("\n|---|");
  for (std::size_t k = 0; k < std::size(kTheta); ++k) std::printf("---|");
  std::printf("\n");
  for (const double alpha : {0.02, 0.05, 0.1, 0.2, 0.4, 0.8}) {
    std::printf("| %g |", alpha);
    for (const int theta : kTheta) {
      const LobeErrors errors = Measure(alpha, DegreesToRadians(theta), quantity);
      std::printf(" %.2g / %.2g |", 100 * errors.l2, 100 * errors.largest);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  std::printf("\n");
}

}  // namespace
}  // namespace lobefit

int main() {
  lobefit::PrintTable(lobefit::SelQuantity::kBrdfCosineO);
  lobefit::PrintTable(lobefit::SelQuantity::kBrdf);
  return 0;
}

#include "lobefit/report/energy.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/ggx_lobe.h"
#include "lobefit/core/slope_ndf.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr int kRings = 160, kSteps = 64;
constexpr std::size_t kValuesOfALobe = 6;

SlopeCoordinates ShapeOf(const ParameterValues& values, std::size_t lobe) {
  const std::size_t at = lobe * kValuesOfALobe;
  return SlopeCoordinatesFromEllipsoid(
      {values[at][0], values[at + 1][0], values[at + 2][0], values[at + 3][0], values[at + 4][0]});
}

// Sums of the specular factor and of the factor times (1 - cos_d)^5 over wo, each times cos(theta_o).
struct Moments {
  double all = 0, schlick = 0;
};

// Facets are taken at the slopes of equal probability of P22 (midpoints in probability and angle): wo is the mirror
// image of wi at each.
Moments Integrate(const SlopeCoordinates& shape, Masking masking, const Vec3& wi) {
  const SlopeFrame frame(shape);
  Moments moments;
  for (int i = 0; i < kRings; ++i) {
    const double u = (i + 0.5) / kRings, rho = std::sqrt(u / (1 - u));
    for (int k = 0; k < kSteps; ++k) {
      // Every ring is turned against the one before, so that rings do not line up.
      const double t = 2 * kPi * (k + 0.5 + 0.618034 * i) / kSteps;
      const double x = frame.slope_x + frame.a * rho * std::cos(t);
      const double y = frame.slope_y + frame.b * rho * std::cos(t) + frame.c * rho * std::sin(t);
      const Vec3 m = Normalized(Vec3{-x, -y, 1.0});
      const double along = Dot(wi, m);
      const Vec3 wo = Reflect(wi, m);
      if (along <= 0 || wo.z <= 0) continue;
      double cos_d = 0;
      const double specular = GgxLobe(wi, wo, shape, masking, &cos_d, nullptr);
      // d wo = 4 (wi.m) dm and P22 dslope = D (m.n) dm.
      const double share = specular * wo.z * 4 * along / (SlopeD(frame, m) * m.z);
      const double s = 1 - cos_d, s2 = s * s;
      moments.all += share;
      moments.schlick += share * s2 * s2 * s;
    }
  }
  moments.all /= kRings * kSteps;
  moments.schlick /= kRings * kSteps;
  return moments;
}

}  // namespace

std::vector<double> DirectionalAlbedo(const Model& model, const ParameterValues& values, std::size_t channels,
                                      const Vec3& wi) {
  std::vector<double> albedo(channels, 0.0);
  if (model.diffuse == Diffuse::kLambert) albedo = values.back();
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const Moments moments = Integrate(ShapeOf(values, lobe), model.lobes[lobe].masking, wi);
    const std::vector<double>& amplitude = values[lobe * kValuesOfALobe + 5];
    for (std::size_t c = 0; c < channels; ++c) {
      const double a = amplitude[c];
      albedo[c] += model.lobes[lobe].fresnel == Fresnel::kSchlick ? a * moments.all + (1 - a) * moments.schlick
                                                                  : a * moments.all;
    }
  }
  return albedo;
}

double SingleBounceAlbedo(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& wi) {
  return Integrate(ShapeOf(values, lobe), model.lobes[lobe].masking, wi).all;
}

double WeakFurnace(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& u) {
  if (model.lobes[lobe].masking == Masking::kSmithUnclamped) return 1;
  return std::min(1.0, SlopeSigma(SlopeFrame(ShapeOf(values, lobe)), u) / u.z);
}

}  // namespace lobefit

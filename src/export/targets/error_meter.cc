#include "lobefit/export/targets/error_meter.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/interpolation.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

// The normal at slope (mean + L r (cos psi, sin psi)), where `level` of the GGX slopes lie within r.
Vec3 NormalAt(const SlopeCoordinates& shape, double level, double psi) {
  const double r = std::sqrt(level / (1 - level));
  const double y1 = r * std::cos(psi), y2 = r * std::sin(psi);
  const double slope_x = shape.v[0] + std::exp(shape.v[2]) * y1;
  const double slope_y = shape.v[1] + shape.v[3] * y1 + std::exp(shape.v[4]) * y2;
  return Normalized(Vec3{-slope_x, -slope_y, 1});
}

}  // namespace

ErrorMeter::ErrorMeter(const FittedBrdf& fit)
    : ErrorMeter(fit.function(), fit.channels(), fit.reflectance().lobe_shapes(), fit.material().source.file) {}

ErrorMeter::ErrorMeter(const BrdfFunction& brdf, const Channels& channels, const std::vector<SlopeCoordinates>& shapes,
                       const std::string& source) {
  GoniometerLayout layout;
  for (const double degrees : {5, 20, 35, 50, 65, 75}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (int k = 0; k < 8; ++k) layout.azimuths.push_back(DegreesToRadians(45 * k));
  layout.detector_step = DegreesToRadians(10);
  layout.theta_max = DegreesToRadians(80);
  DirectionList directions = Goniometer(layout);
  for (const double theta : layout.polar_angles) {
    for (const double phi : layout.azimuths) {
      const Vec3 wi = FromSpherical(theta, phi);
      for (const SlopeCoordinates& shape : shapes) {
        for (int k = 0; k < 40; ++k) {
          const Vec3 wo = Reflect(wi, NormalAt(shape, 0.1 + 0.2 * (k % 5), 2 * kPi * (k / 5) / 8 + 0.3));
          if (wo.z < std::cos(layout.theta_max)) continue;
          directions.wi.push_back(wi);
          directions.wo.push_back(wo);
        }
      }
    }
  }
  measurement_ = Synthesise(directions, channels, brdf, {}, 0);
  measurement_.source = source;
  MakeAlbedoRules(shapes);
  for (const AlbedoRule& rule : rules_) fitted_albedo_.push_back(Albedo(rule, brdf));
}

// Directions by the slopes of each lobe and by the cosine, weighted by the balance heuristic: the same nodes serve
// narrow and wide lobes, and what they miss, they miss of both functions.
void ErrorMeter::MakeAlbedoRules(const std::vector<SlopeCoordinates>& shapes) {
  constexpr int kSide = 24;
  for (const double theta : {0.0, 30.0, 60.0, 75.0}) {
    for (const double phi : {20.0, 110.0, 200.0, 290.0}) {
      AlbedoRule rule;
      rule.wo = FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi));
      const auto add = [&](const Vec3& wi) {
        if (!(wi.z > 1e-9)) return;
        const Vec3 wh = HalfVector(wi, rule.wo);
        double density = wi.z / kPi;
        for (const SlopeCoordinates& shape : shapes) {
          density += GgxD(wh, shape, nullptr) * wh.z / (4 * Dot(rule.wo, wh));
        }
        rule.wi.push_back(wi);
        rule.weight.push_back(wi.z / (density * kSide * kSide));
      };
      for (int i = 0; i < kSide * kSide; ++i) {
        const double u = (i % kSide + 0.5) / kSide, v = 2 * kPi * (i / kSide + 0.5) / kSide;
        for (const SlopeCoordinates& shape : shapes) add(Reflect(rule.wo, NormalAt(shape, u, v)));
        add(FromSpherical(std::asin(std::sqrt(u)), v));
      }
      rules_.push_back(std::move(rule));
    }
  }
}

std::vector<double> ErrorMeter::Albedo(const AlbedoRule& rule, const BrdfFunction& brdf) const {
  const std::size_t channels = measurement_.channels.size();
  std::vector<double> albedo(channels), values(channels);
  for (std::size_t i = 0; i < rule.wi.size(); ++i) {
    brdf(rule.wi[i], rule.wo, values.data());
    for (std::size_t c = 0; c < channels; ++c) albedo[c] += rule.weight[i] * values[c];
  }
  return albedo;
}

ExportError ErrorMeter::Compare(const BrdfFunction& brdf) const {
  const Difference difference = CompareWith(measurement_, brdf);
  ExportError error = {difference.median, difference.percentile_90, difference.maximum, 0, difference.compared};
  for (std::size_t k = 0; k < rules_.size(); ++k) {
    const std::vector<double> albedo = Albedo(rules_[k], brdf);
    for (std::size_t c = 0; c < albedo.size(); ++c) {
      if (fitted_albedo_[k][c] > 0) {
        error.albedo = std::max(error.albedo, std::fabs(albedo[c] / fitted_albedo_[k][c] - 1));
      }
    }
  }
  return error;
}

}  // namespace lobefit

#include "lobefit/export/targets/error_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/math/directions.h"
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

// Whether the normal is among those nearest to the lobe's centre that hold `level` of its slopes.
bool IsWithin(const SlopeCoordinates& shape, double level, const Vec3& wh) {
  const double y1 = (-wh.x / wh.z - shape.v[0]) / std::exp(shape.v[2]);
  const double y2 = (-wh.y / wh.z - shape.v[1] - shape.v[3] * y1) / std::exp(shape.v[4]);
  return y1 * y1 + y2 * y2 <= level / (1 - level);
}

constexpr double kLobeLevel = 0.9;
const double kLeastCos = std::cos(DegreesToRadians(88));

// Point k of an additive recurrence in four dimensions, which fills the cube evenly: the fractions of k times the
// powers of the root of x^5 = x + 1.
std::array<double, 4> CubePoint(std::size_t k) {
  constexpr double kRoot = 1.1673039782614187;
  std::array<double, 4> point = {};
  double factor = 1;
  for (double& x : point) {
    factor /= kRoot;
    x = 0.5 + static_cast<double>(k) * factor;
    x -= std::floor(x);
  }
  return point;
}

// Uniform over the solid angle to 88 degrees.
Vec3 UniformDirection(double u, double v) { return FromSpherical(std::acos(1 - u * (1 - kLeastCos)), 2 * kPi * v); }

double Score(const ExportError& error) {
  const auto capped = [](double part) { return std::min(part, 1.0); };
  const auto mean = [&](const ErrorLevels& levels) {
    return (capped(levels.median) + capped(levels.percentile_90)) / 2;
  };
  return mean(error.lobe) + mean(error.off) + 2 * capped(error.albedo);
}

}  // namespace

ErrorLevels LevelsOf(std::vector<double> differences) {
  ErrorLevels levels;
  levels.compared = differences.size();
  if (differences.empty()) return levels;
  std::sort(differences.begin(), differences.end());
  levels.median = differences[differences.size() / 2];
  levels.percentile_90 = differences[differences.size() * 9 / 10];
  levels.maximum = differences.back();
  return levels;
}

bool IsBetter(const ExportError& a, const ExportError& b) { return Score(a) < Score(b); }

ErrorMeter::ErrorMeter(const FittedBrdf& fit)
    : ErrorMeter(fit.function(), fit.channels(), fit.reflectance().lobe_shapes(), fit.material().source.file) {}

ErrorMeter::ErrorMeter(const BrdfFunction& brdf, const Channels& channels, const std::vector<SlopeCoordinates>& shapes,
                       const std::string& source)
    : channels_(channels.size()) {
  MakeMeasurement(brdf, channels, shapes);
  measurement_.source = source;
  MakeProbes(brdf, shapes);
  MakeAlbedoRules(shapes);
  for (const AlbedoRule& rule : rules_) {
    fitted_albedo_.push_back(Albedo(rule, brdf));
    for (std::size_t c = 0; c < channels_; ++c) {
      if (fitted_albedo_.back()[c] <= largest_albedo_.albedo) continue;
      largest_albedo_ = {fitted_albedo_.back()[c], RadiansToDegrees(PolarAngle(rule.wo)), channels.names[c]};
    }
  }
}

void ErrorMeter::MakeMeasurement(const BrdfFunction& brdf, const Channels& channels,
                                 const std::vector<SlopeCoordinates>& shapes) {
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
}

void ErrorMeter::MakeProbes(const BrdfFunction& brdf, const std::vector<SlopeCoordinates>& shapes) {
  constexpr std::size_t kUniform = 6000, kALobe = 2000;
  for (std::size_t k = 0; k < kUniform; ++k) {
    const std::array<double, 4> u = CubePoint(k);
    Probe probe = {UniformDirection(u[0], u[1]), UniformDirection(u[2], u[3]), true, false};
    const Vec3 wh = HalfVector(probe.wi, probe.wo);
    for (const SlopeCoordinates& shape : shapes) probe.in_lobe = probe.in_lobe || IsWithin(shape, kLobeLevel, wh);
    probes_.push_back(probe);
  }
  for (const SlopeCoordinates& shape : shapes) {
    for (std::size_t k = 0; k < kALobe; ++k) {
      const std::array<double, 4> u = CubePoint(k);
      const Vec3 wi = UniformDirection(u[0], u[1]), wm = NormalAt(shape, kLobeLevel * u[2], 2 * kPi * u[3]);
      const Vec3 wo = Reflect(wi, wm);
      if (Dot(wi, wm) > 0 && wo.z >= kLeastCos) probes_.push_back({wi, wo, false, true});
    }
  }
  fitted_.resize(probes_.size() * channels_);
  for (std::size_t k = 0; k < probes_.size(); ++k) brdf(probes_[k].wi, probes_[k].wo, &fitted_[k * channels_]);
}

// Directions by the slopes of each lobe and by the cosine, weighted by the balance heuristic: the same nodes serve
// narrow and wide lobes, and what they miss, they miss of both functions.
void ErrorMeter::MakeAlbedoRules(const std::vector<SlopeCoordinates>& shapes) {
  constexpr int kSide = 24;
  for (const double theta : {0.0, 30.0, 60.0, 75.0, 88.0}) {
    // Five axes of an anisotropic lobe, and all round a tilted one.
    for (const double phi : {20.0, 92.0, 164.0, 236.0, 308.0}) {
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
  std::vector<double> albedo(channels_), values(channels_);
  for (std::size_t i = 0; i < rule.wi.size(); ++i) {
    brdf(rule.wi[i], rule.wo, values.data());
    for (std::size_t c = 0; c < channels_; ++c) albedo[c] += rule.weight[i] * values[c];
  }
  return albedo;
}

ExportError ErrorMeter::Compare(const BrdfFunction& brdf) const {
  std::vector<double> uniform, lobe, off, values(channels_);
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    brdf(probes_[k].wi, probes_[k].wo, values.data());
    for (std::size_t c = 0; c < channels_; ++c) {
      const double fitted = fitted_[k * channels_ + c];
      const double error = std::fabs(values[c] - fitted) / std::max(std::fabs(fitted), kErrorFloor);
      if (probes_[k].uniform) uniform.push_back(error);
      (probes_[k].in_lobe ? lobe : off).push_back(error);
    }
  }
  ExportError error = {LevelsOf(std::move(uniform)), LevelsOf(std::move(lobe)), LevelsOf(std::move(off)), 0};
  for (std::size_t k = 0; k < rules_.size(); ++k) {
    const std::vector<double> albedo = Albedo(rules_[k], brdf);
    for (std::size_t c = 0; c < albedo.size(); ++c) {
      const double fitted = fitted_albedo_[k][c];
      error.albedo = std::max(error.albedo, std::fabs(albedo[c] - fitted) / std::max(fitted, kPi * kErrorFloor));
    }
  }
  return error;
}

}  // namespace lobefit

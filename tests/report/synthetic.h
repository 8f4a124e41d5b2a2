// Materials of known parameters and measurements made from them, for the tests of reports.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/material/material.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit::test {

inline std::vector<std::string> ChannelNames(std::size_t count) {
  if (count == 1) return {"Y"};
  if (count == 3) return {"R", "G", "B"};
  std::vector<std::string> names;
  for (std::size_t c = 0; c < count; ++c) names.push_back(std::to_string(400 + 300 * c / (count - 1)) + "nm");
  return names;
}

inline Channels MakeChannels(std::size_t count) {
  Channels channels = {ChannelNames(count), {}};
  for (std::size_t c = 0; count > 3 && c < count; ++c)
    channels.wavelengths_nm.push_back(static_cast<double>(400 + 300 * c / (count - 1)));
  return channels;
}

// An ellipsoid (anisotropic, turned, tilted) or, `isotropic`, a plain GGX lobe, with standard errors of half a percent.
inline Material MakeMaterial(std::size_t channels, bool isotropic) {
  Material material;
  material.model.lobes.push_back(
      {isotropic ? Ndf::kGgx : Ndf::kEllipsoid, Masking::kSmithSeparable, Fresnel::kSchlick});
  material.channels = ChannelNames(channels);
  material.wavelengths_nm = MakeChannels(channels).wavelengths_nm;
  ParameterValues values = {{0.3}, {0.1}, {0.02}, {0.05}, {0.43}, {}, {}};
  if (isotropic) values = {{0.2}, {0.2}, {0}, {0}, {0}, {}, {}};
  for (std::size_t c = 0; c < channels; ++c) {
    const double t = static_cast<double>(c) / static_cast<double>(channels);
    values[5].push_back(0.9 - 0.5 * t);
    values[6].push_back(0.04 + 0.05 * t);
  }
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t p = 0; p < values.size(); ++p) {
    FittedParameter fitted;
    fitted.values = values[p];
    fitted.free = parameters[p].free;
    for (const double v : values[p]) {
      fitted.standard_error.push_back(fitted.free ? 0.005 * std::fabs(v) + 1e-4 : std::nan(""));
      fitted.standard_error_clustered.push_back(fitted.free ? 0.012 * std::fabs(v) + 1e-4 : std::nan(""));
      if (fitted.free) material.covariance_names.push_back(parameters[p].json_name);
    }
    material.parameters.push_back(fitted);
  }
  const std::size_t n = material.covariance_names.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      material.covariance.push_back(i == j ? 1.0 : 0.8 * std::cos(1.7 * static_cast<double>(i * j + i + j)));
  }
  material.errors = {{"log", 0.0123}, {"relative", 0.0456}};
  material.metric = "log";
  material.termination = {true, true, "cost change below tolerance", 12};
  material.source.file = "synthetic.csv";
  return material;
}

// Noise of `relative` size that is the same on every machine.
class Noise {
 public:
  explicit Noise(double relative) : relative_(relative) {}
  double Factor() {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(state_ >> 11U) / 9007199254740992.0 - 0.5;
    }
    return 1 + relative_ * sum * std::sqrt(3.0);
  }

 private:
  double relative_;
  std::uint64_t state_ = 42;
};

using Pairs = std::vector<std::pair<Vec3, Vec3>>;

inline Vec3 AtDegrees(double theta, double phi) {
  return FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi));
}

// Polar angles 10, 30, 50, 70 at three azimuths; a sweep in the plane, and a grid out of it.
inline Pairs GoniometerPairs(bool out_of_plane) {
  Pairs pairs;
  for (const double phi : {0.0, 45.0, 90.0}) {
    if (!out_of_plane && phi > 0) continue;
    for (const double theta : {10.0, 30.0, 50.0, 70.0}) {
      const Vec3 wi = AtDegrees(theta, phi);
      for (int k = -85; k <= 85; k += 2) pairs.emplace_back(wi, AtDegrees(std::abs(k), k > 0 ? phi + 180 : phi));
      for (int t = 6; out_of_plane && t < 84; t += 6) {
        for (int p = 5; p < 360; p += 10) pairs.emplace_back(wi, AtDegrees(t, p));
      }
    }
  }
  return pairs;
}

// Cells of a table over half and difference angles.
inline Pairs TablePairs() {
  Pairs pairs;
  for (int h = 0; h < 45; ++h) {
    for (int d = 0; d < 45; ++d) {
      for (int p = 0; p < 18; ++p) {
        const double t = (h + 0.5) / 45;
        Vec3 wi, wo;
        FromHalfDifference({t * t * kPi / 2, 0, (d + 0.5) / 45 * kPi / 2, (p + 0.5) / 18 * kPi}, &wi, &wo);
        if (wi.z > 0.01 && wo.z > 0.01) pairs.emplace_back(wi, wo);
      }
    }
  }
  return pairs;
}

inline Measurement Measure(const Material& material, const Pairs& pairs, double relative_noise, bool isotropic) {
  const std::size_t channels = material.channels.size();
  const Reflectance reflectance(material.model, material.Values(), channels);
  MeasurementBuilder builder(MakeChannels(channels));
  Noise noise(relative_noise);
  std::vector<double> f_r(channels);
  std::uint32_t origin = 0;
  for (const auto& [wi, wo] : pairs) {
    reflectance.Evaluate(wi, wo, f_r.data());
    for (double& f : f_r) f *= noise.Factor();
    builder.Add(wi, wo, f_r.data(), origin++);
  }
  Measurement measurement = builder.Finish();
  measurement.isotropic = isotropic;
  measurement.source = "synthetic.csv";
  measurement.format = "csv";
  return measurement;
}

}  // namespace lobefit::test

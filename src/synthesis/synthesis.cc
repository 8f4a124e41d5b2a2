#include "lobefit/synthesis/synthesis.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/directions.h"
#include "lobefit/synthesis/instrument.h"

namespace lobefit {
namespace {

constexpr double kFinePatch = 15 * kPi / 180;

void AddRing(const Vec3& wi, double theta, double step, double turn, const Vec3& axis_frame, DirectionList* list) {
  const int count = theta < step / 4 ? 1 : std::max(3, static_cast<int>(std::lround(2 * kPi * std::sin(theta) / step)));
  const double tilt = PolarAngle(axis_frame), azimuth = Azimuth(axis_frame);
  for (int k = 0; k < count; ++k) {
    const Vec3 local = FromSpherical(theta, turn + 2 * kPi * k / count);
    const Vec3 wo = RotateZ(RotateY(local, tilt), azimuth);
    if (wo.z <= 0) continue;
    list->wi.push_back(wi);
    list->wo.push_back(wo);
  }
}

}  // namespace

DirectionList Goniometer(const GoniometerLayout& layout) {
  DirectionList list;
  for (const double theta_i : layout.polar_angles) {
    for (const double phi_i : layout.azimuths) {
      const Vec3 wi = FromSpherical(theta_i, phi_i);
      if (layout.in_plane) {
        for (double theta = -layout.theta_max; theta <= layout.theta_max + 1e-9; theta += layout.detector_step / 2) {
          list.wi.push_back(wi);
          list.wo.push_back(FromSpherical(std::fabs(theta), theta < 0 ? phi_i : phi_i + kPi));
        }
        continue;
      }
      for (double theta = 0; theta <= layout.theta_max + 1e-9; theta += layout.detector_step) {
        AddRing(wi, theta, layout.detector_step, phi_i + kPi, {0, 0, 1}, &list);
      }
      const Vec3 mirror = {-wi.x, -wi.y, wi.z};
      const std::size_t before = list.size();
      for (double theta = layout.detector_step / 4; theta <= kFinePatch; theta += layout.detector_step / 2) {
        AddRing(wi, theta, layout.detector_step / 2, phi_i, mirror, &list);
      }
      // The patch ends at the detector's limit too.
      std::size_t kept = before;
      for (std::size_t i = before; i < list.size(); ++i) {
        if (PolarAngle(list.wo[i]) > layout.theta_max + 1e-9) continue;
        list.wi[kept] = list.wi[i];
        list.wo[kept++] = list.wo[i];
      }
      list.wi.resize(kept);
      list.wo.resize(kept);
    }
  }
  return list;
}

Measurement TrueMeasurement(const DirectionList& directions, const Channels& channels, const BrdfFunction& brdf,
                            const Noise& noise, double lobe_width) {
  BrdfFunction seen = brdf;
  if (noise.misalignment_x != 0 || noise.misalignment_y != 0)
    seen = WithMisalignment(seen, noise.misalignment_x, noise.misalignment_y, channels.size());
  seen = WithAperture(
      seen, {noise.source, noise.aperture, noise.plain_mean ? ApertureMean::kPlain : ApertureMean::kFlux, noise.across},
      channels.size(), lobe_width);
  MeasurementBuilder builder(channels);
  std::vector<double> values(channels.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions.wi[i].z > 0 && directions.wo[i].z > 0) {
      seen(directions.wi[i], directions.wo[i], values.data());
    } else {
      std::fill(values.begin(), values.end(), 0.0);
    }
    builder.Add(directions.wi[i], directions.wo[i], values.data(), static_cast<std::uint32_t>(i));
  }
  Measurement measurement = builder.Finish();
  measurement.format = "synthetic";
  return measurement;
}

Measurement Synthesise(const DirectionList& directions, const Channels& channels, const BrdfFunction& brdf,
                       const Noise& noise, std::uint64_t seed, double lobe_width) {
  const Noise drawn = DrawnNoise(noise, seed);
  Measurement measurement = TrueMeasurement(directions, channels, brdf, drawn, lobe_width);
  AddNoise(drawn, seed, &measurement);
  return measurement;
}

}  // namespace lobefit

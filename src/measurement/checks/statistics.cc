#include "lobefit/measurement/checks/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lobefit/base/process/parallel.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/interpolation.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostIncidences = 8;
constexpr double kCoverageRadius = 10 * kPi / 180;
// Grid of half vectors: the polar angle goes with the square of the index, dense at the peak.
constexpr int kPolar = 96, kAzimuthal = 36;

double Percentile(std::vector<double>* values, double fraction) {
  if (values->empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values->begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values->size() - 1));
  std::nth_element(values->begin(), at, values->end());
  return *at;
}

std::vector<ChannelStatistics> DescribeChannels(const Samples& samples) {
  std::vector<ChannelStatistics> channels;
  for (std::vector<double> values : samples.values) {
    ChannelStatistics channel;
    if (!values.empty()) {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      channel.minimum = *low;
      channel.maximum = *high;
      channel.negative =
          static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v < 0; }));
      channel.median = Percentile(&values, 0.5);
    }
    channels.push_back(channel);
  }
  return channels;
}

// d(wo) = 4 (wi.h) d(h); the rule is exact for a constant to about 1e-3.
std::vector<double> Albedo(const BrdfFunction& brdf, std::size_t channels, const Vec3& wi) {
  std::vector<double> sum(channels, 0.0), values(channels);
  for (int p = 0; p < kPolar; ++p) {
    const double x = (p + 0.5) / kPolar, theta_h = x * x * kPi / 2;
    const double solid_angle = std::sin(theta_h) * kPi * x / kPolar * 2 * kPi / kAzimuthal;
    for (int a = 0; a < kAzimuthal; ++a) {
      const Vec3 h = FromSpherical(theta_h, (a + 0.5) * 2 * kPi / kAzimuthal);
      const double cos_d = Dot(wi, h);
      if (cos_d <= 0) continue;
      const Vec3 wo = Reflect(wi, h);
      if (wo.z <= 1e-6) continue;
      brdf(wi, wo, values.data());
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += values[c] * wo.z * 4 * cos_d * solid_angle;
    }
  }
  return sum;
}

// Share of a grid of equal projected solid angle that lies near a viewer.
double Coverage(const std::vector<Vec3>& viewers) {
  constexpr int kRings = 12, kSectors = 36;
  const double cos_radius = std::cos(kCoverageRadius);
  int covered = 0;
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      const Vec3 w = FromSpherical(std::asin(std::sqrt((r + 0.5) / kRings)), (s + 0.5) * 2 * kPi / kSectors);
      covered +=
          std::any_of(viewers.begin(), viewers.end(), [&](const Vec3& v) { return Dot(v, w) > cos_radius; }) ? 1 : 0;
    }
  }
  return static_cast<double>(covered) / (kRings * kSectors);
}

// The incidences whose albedo is computed.
std::vector<IncidenceStatistics> ChooseIncidences(const Measurement& measurement, const Incidences& incidences) {
  std::vector<IncidenceStatistics> chosen;
  if (measurement.isotropic) {
    for (const double theta : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0}) {
      IncidenceStatistics statistics;
      statistics.wi = FromSpherical(DegreesToRadians(theta), 0);
      chosen.push_back(statistics);
    }
    return chosen;
  }
  const std::size_t count = incidences.wi.size(), used = std::min(count, kMostIncidences);
  for (std::size_t k = 0; k < used; ++k) {
    const std::size_t group = used < 2 ? 0 : k * (count - 1) / (used - 1);
    IncidenceStatistics statistics;
    statistics.wi = incidences.wi[group];
    std::vector<Vec3> viewers;
    for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
      if (incidences.group[i] == group) viewers.push_back(measurement.samples.wo(i));
    }
    statistics.samples = viewers.size();
    statistics.coverage = Coverage(viewers);
    chosen.push_back(statistics);
  }
  return chosen;
}

// An isotropic table covers what lies within the coverage radius of a sample in half and difference angles.
double IsotropicCoverage(const Interpolator& interpolator, const Vec3& wi) {
  constexpr int kRings = 8, kSectors = 16;
  int covered = 0;
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      const Vec3 wo = FromSpherical(std::asin(std::sqrt((r + 0.5) / kRings)), (s + 0.5) * 2 * kPi / kSectors);
      covered += interpolator.Nearest(wi, wo, kCoverageRadius) || interpolator.Nearest(wo, wi, kCoverageRadius) ? 1 : 0;
    }
  }
  return static_cast<double>(covered) / (kRings * kSectors);
}

void DescribeReciprocity(const Measurement& measurement, const Interpolator& interpolator, Statistics* statistics) {
  constexpr std::size_t kMost = 20000;
  constexpr double kSame = 0.005;  // a third of a degree
  const Samples& samples = measurement.samples;
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kMost);
  std::vector<double> differences;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const std::optional<std::size_t> exchanged = interpolator.Nearest(samples.wo(i), samples.wi(i), kSame);
    if (!exchanged || *exchanged == i) continue;
    ++statistics->reciprocal_pairs;
    for (const std::vector<double>& values : samples.values) {
      const double mean = 0.5 * (std::fabs(values[i]) + std::fabs(values[*exchanged]));
      if (mean > 0) differences.push_back(std::fabs(values[i] - values[*exchanged]) / mean);
    }
  }
  if (differences.empty()) return;
  statistics->reciprocity_median = Percentile(&differences, 0.5);
  statistics->reciprocity_percentile_90 = Percentile(&differences, 0.9);
}

std::vector<double> AzimuthsOf(const Incidences& incidences) {
  std::set<double> azimuths;
  for (const Vec3& wi : incidences.wi) {
    if (PolarAngle(wi) < 1e-3) continue;
    double degrees = RadiansToDegrees(Azimuth(wi));
    if (degrees < -0.05) degrees += 360;
    azimuths.insert(std::fabs(degrees) < 0.05 ? 0.0 : std::round(degrees * 10) / 10);
  }
  return {azimuths.begin(), azimuths.end()};
}

}  // namespace

Statistics Describe(const Measurement& measurement, const BrdfFunction& brdf) {
  Statistics statistics;
  statistics.channels = DescribeChannels(measurement.samples);
  statistics.largest_albedo = std::numeric_limits<double>::quiet_NaN();
  if (measurement.samples.size() == 0) return statistics;
  const Incidences incidences = GroupByDirection(measurement, Beam::kLight);
  if (!measurement.isotropic) statistics.azimuths_deg = AzimuthsOf(incidences);
  const Interpolator interpolator(measurement);
  DescribeReciprocity(measurement, interpolator, &statistics);
  if (IsInPlane(measurement.samples)) return statistics;

  const BrdfFunction interpolated = [&](const Vec3& wi, const Vec3& wo, double* values) {
    interpolator.Evaluate(wi, wo, values);
  };
  const BrdfFunction& function = brdf ? brdf : interpolated;
  statistics.incidences = ChooseIncidences(measurement, incidences);
  ParallelFor(statistics.incidences.size(), HardwareThreads(), [&](std::size_t i) {
    IncidenceStatistics& incidence = statistics.incidences[i];
    incidence.albedo = Albedo(function, measurement.channels.size(), incidence.wi);
    if (measurement.isotropic) incidence.coverage = IsotropicCoverage(interpolator, incidence.wi);
  });
  for (const IncidenceStatistics& incidence : statistics.incidences) {
    if (incidence.coverage < 0.9) continue;
    for (const double albedo : incidence.albedo)
      statistics.largest_albedo = std::fmax(statistics.largest_albedo, albedo);
  }
  return statistics;
}

}  // namespace lobefit

// What a measurement shows before any fit: ranges, albedo, reciprocity, coverage.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct ChannelStatistics {
  double minimum = 0, median = 0, maximum = 0;
  std::size_t negative = 0;  // samples below 0
};

struct IncidenceStatistics {
  Vec3 wi;
  std::size_t samples = 0;  // 0 for an isotropic table, which has no list of incidences
  // Directional-hemispherical reflectance of each channel, int f_r cos(theta_o) d(wo), of the interpolated samples.
  std::vector<double> albedo;
  // Share of the hemisphere, by projected solid angle, within 10 degrees of a sample; below 0.9 the albedo is a guess.
  double coverage = 0;
};

struct Statistics {
  std::vector<ChannelStatistics> channels;
  // Azimuths of the incidences in degrees, increasing in [0, 360); empty where isotropic.
  std::vector<double> azimuths_deg;
  // Pairs (wi, wo), (wo, wi) among the samples, and their relative difference |a - b| / mean; no pairs: not known.
  std::size_t reciprocal_pairs = 0;
  double reciprocity_median = 0, reciprocity_percentile_90 = 0;
  // At most 8 incidences, evenly chosen; empty where all samples lie in one plane, which has no albedo.
  std::vector<IncidenceStatistics> incidences;
  // Largest albedo over incidences and channels whose coverage is at least 0.9; NaN where there is none.
  double largest_albedo = 0;

  // False where an albedo is above 1 by more than the quadrature's 2 %.
  bool ConservesEnergy() const { return !(largest_albedo > 1.02); }
};

// `brdf` is the file's own function of directions where it has one (an RGL file); without it the samples are
// interpolated. Takes about a tenth of a second for each incidence, spread over threads.
Statistics Describe(const Measurement& measurement, const BrdfFunction& brdf = nullptr);

}  // namespace lobefit

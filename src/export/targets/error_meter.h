// How far an exported model is from the fit: both are asked at the same fixed directions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// |difference| relative to the fit's f_r (to 1e-3 of the channel's largest where that is more), over all directions
// and channels; and the largest relative difference of a directional albedo.
struct ExportError {
  double median = 0, percentile_90 = 0, maximum = 0;
  double albedo = 0;
  std::size_t compared = 0;
};

// By the sum of the median and the 90 % level: the maximum is one direction in a dim tail.
inline bool IsBetter(const ExportError& a, const ExportError& b) {
  return a.median + a.percentile_90 < b.median + b.percentile_90;
}

class ErrorMeter {
 public:
  // Directions: lights at 5, 20, 35, 50, 65, 75 degrees and eight azimuths; viewers over the hemisphere to 80 degrees,
  // more of them about the mirror direction and, for each lobe, at five levels of its cumulative distribution.
  // Albedos, over all lights as renderers sample them: viewers at 0, 30, 60 and 75 degrees, four azimuths.
  explicit ErrorMeter(const FittedBrdf& fit);
  // The same of any function, with lobes of slopes `shapes`; `source` is its measurement's file.
  ErrorMeter(const BrdfFunction& brdf, const Channels& channels, const std::vector<SlopeCoordinates>& shapes,
             const std::string& source);

  // `brdf` has the channels of the fit. Safe to call with a function that throws nothing.
  ExportError Compare(const BrdfFunction& brdf) const;

  // The fit at the directions.
  const Measurement& measurement() const { return measurement_; }

 private:
  // Lights of one viewer's albedo with weights: albedo = sum weight f_r.
  struct AlbedoRule {
    Vec3 wo;
    std::vector<Vec3> wi;
    std::vector<double> weight;
  };
  std::vector<double> Albedo(const AlbedoRule& rule, const BrdfFunction& brdf) const;
  void MakeAlbedoRules(const std::vector<SlopeCoordinates>& shapes);

  Measurement measurement_;
  std::vector<AlbedoRule> rules_;
  std::vector<std::vector<double>> fitted_albedo_;
};

}  // namespace lobefit

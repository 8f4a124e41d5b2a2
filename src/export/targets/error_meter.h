// How far an exported model is from the fit: both are asked at the same fixed directions.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// |difference| relative to the fit's f_r, over directions and channels.
struct ErrorLevels {
  double median = 0, percentile_90 = 0, maximum = 0;
  std::size_t compared = 0;  // values
};
ErrorLevels LevelsOf(std::vector<double> differences);

struct ExportError {
  ErrorLevels uniform;  // pairs of directions uniform over both hemispheres
  // Half vectors among those nearest to a lobe's centre that hold 90 % of its normals; and the pairs of `uniform` that
  // are not. Without a lobe nothing is compared in it.
  ErrorLevels lobe, off;
  double albedo = 0;  // the largest relative difference of a directional albedo; NaN: not asked
};

// f_r below this counts as this where an error is related to f_r: the diffuse part of an albedo of 1e-4, below the
// noise of goniometers.
inline constexpr double kErrorFloor = 1e-4 * 0.31830988618379067;

// By the mean of median and 90 % level in the lobe, the same off it, and twice the albedo's error, which is the energy
// that is missing or too much; each figure counts as 1 at most.
bool IsBetter(const ExportError& a, const ExportError& b);

class ErrorMeter {
 public:
  // Pairs of directions to 88 degrees from the normal: 6000 uniform over both hemispheres, and for each lobe 2000 with
  // the light uniform and the half vector by the lobe's normals. Albedos, over all lights as renderers sample them, of
  // viewers at 0, 30, 60, 75 and 88 degrees and five azimuths.
  explicit ErrorMeter(const FittedBrdf& fit);
  // The same of any function, with lobes of slopes `shapes`; `source` is its measurement's file.
  ErrorMeter(const BrdfFunction& brdf, const Channels& channels, const std::vector<SlopeCoordinates>& shapes,
             const std::string& source);

  // `brdf` has the channels of the fit. Safe to call with a function that throws nothing.
  ExportError Compare(const BrdfFunction& brdf) const;

  // The fit at a goniometer's directions with more of them about the mirror direction and in each lobe: what a target's
  // own model is fitted to.
  const Measurement& measurement() const { return measurement_; }

  // The largest directional albedo of the fit itself.
  struct LargestAlbedo {
    double albedo = 0, theta_deg = 0;
    std::string channel;
  };
  const LargestAlbedo& largest_albedo() const { return largest_albedo_; }

 private:
  struct Probe {
    Vec3 wi, wo;
    bool uniform = false, in_lobe = false;
  };
  // Lights of one viewer's albedo with weights: albedo = sum weight f_r.
  struct AlbedoRule {
    Vec3 wo;
    std::vector<Vec3> wi;
    std::vector<double> weight;
  };
  void MakeMeasurement(const BrdfFunction& brdf, const Channels& channels, const std::vector<SlopeCoordinates>& shapes);
  void MakeProbes(const BrdfFunction& brdf, const std::vector<SlopeCoordinates>& shapes);
  std::vector<double> Albedo(const AlbedoRule& rule, const BrdfFunction& brdf) const;
  void MakeAlbedoRules(const std::vector<SlopeCoordinates>& shapes);

  std::size_t channels_ = 0;
  Measurement measurement_;
  std::vector<Probe> probes_;
  std::vector<double> fitted_;  // [probe][channel]
  std::vector<AlbedoRule> rules_;
  std::vector<std::vector<double>> fitted_albedo_;
  LargestAlbedo largest_albedo_;
};

}  // namespace lobefit

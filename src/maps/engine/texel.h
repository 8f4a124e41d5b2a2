// One texel: from its values under the lights to parameters with errors.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lobefit/maps/engine/errors.h"
#include "lobefit/maps/engine/starts.h"

namespace lobefit {

enum class LobeChoice { kByEvidence, kAlways };

struct MapRules {
  MapLobe lobe = MapLobe::kGgx;
  LobeChoice choice = LobeChoice::kByEvidence;
  bool schlick = false;  // k of model.h; needs calibrated values
  double loss = 0.05;    // of Cauchy, in units of the texel's 90th percentile
  double shadow = 0.1;   // values below, in the same unit, are set aside
  double least_alpha = 0.01, most_alpha = 1;
  bool normal_free = true;  // else +z
};

// Why numbers of a texel are NaN or to be doubted.
enum MapStatus : std::uint32_t {
  kMapOutside = 1,        // the mask excludes the texel
  kMapTooFew = 2,         // fewer values than unknowns
  kMapNotDetermined = 4,  // at least one number is not determined by the data
  kMapAtBound = 8,        // a width or the normal stands at its bound
  kMapNotConverged = 16,
  kMapNoLobe = 32,  // the evidence is against a lobe
};

// alpha_x >= alpha_y; angle: of alpha_x's axis in the frame of the normal, counter-clockwise, in (-pi/2, pi/2]. A
// number that the data do not determine is NaN, its error then too. Diffuse albedo and f0 in the stack's unit.
struct TexelFit {
  Vec3 normal = {kNan, kNan, kNan}, normal_error = {kNan, kNan, kNan};
  double normal_angle_error = kNan;  // radians: root of the sum of both tangents' variances
  double diffuse[kMostChannels] = {kNan, kNan, kNan}, diffuse_error[kMostChannels] = {kNan, kNan, kNan};
  double f0[kMostChannels] = {kNan, kNan, kNan}, f0_error[kMostChannels] = {kNan, kNan, kNan};
  double alpha_x = kNan, alpha_y = kNan, angle = kNan;
  double log_alpha_x_error = kNan, log_alpha_y_error = kNan, angle_error = kNan;
  double rms = kNan;    // of the residuals, weighed by the loss, in units of scale
  double scale = kNan;  // 90th percentile of the values' means over channels
  double cost = kNan;
  std::uint32_t used = 0;  // lights
  int iterations = 0;
  std::uint32_t status = 0;
};

// Lights and room for one thread. The same values give the same bits on any thread, in any order.
class TexelFitter {
 public:
  TexelFitter(const MapRules& rules, const std::vector<Vec3>& lights, int channels);
  // Moves the lights, as many as before: of the texel that is fitted next.
  void MoveLights(const std::vector<Vec3>& lights);
  // values[channel stride + light]: f_r cos_theta_i; NaN: none, infinite: saturated. log_alpha: shared by all texels
  // and held, or NaN. `point`, `model`: where the search ended, unless null.
  TexelFit Fit(const float* values, std::size_t stride, double log_alpha, MapPoint* point = nullptr,
               MapModel* model = nullptr);
  // Slope and curvature of the cost by ln alpha along the texel's valley (all else follows), at the point of the last
  // Fit with log_alpha given; false where that texel says nothing.
  bool ProfileOfLastFit(double* slope, double* curvature) const;

 private:
  bool Select(const float* values, std::size_t stride, TexelFit* fit);
  MapDescent DescendWithLobe(const MapModel& model, const MapDescent& lambert, double log_alpha);
  void Report(const MapModel& model, const MapDescent& best, TexelFit* fit);

  MapRules rules_;
  int channels_;
  LightArrays lights_;
  TexelData data_;
  TexelObjective objective_;
  MapBounds bounds_;
  LightVector mean_, dull_;
  std::vector<double> sorted_, all_means_;
  double slope_ = 0, curvature_ = 0;
};

}  // namespace lobefit

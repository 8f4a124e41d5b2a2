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
  bool normal_free = true;   // else +z
  bool every_start = false;  // a descent from each, not only from the best ones
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

// What is known of a texel from elsewhere and is not fitted: of `point`, where diffuse is albedo / pi and f0 that of
// the stack's unit.
struct HeldNumbers {
  bool normal = false, slope = false, width = false, diffuse = false, f0 = false;
  MapPoint point;
};

// Of -ln likelihood by unknowns of the whole model.
struct ProfileTerms {
  MapVector slope = {};
  MapMatrix curvature = {};
};

// alpha_x >= alpha_y; angle: of alpha_x's axis in the frame of the normal, counter-clockwise, in (-pi/2, pi/2]; tilt:
// of the ellipsoid, theta_x and theta_y of core/ellipsoid in the same frame. A number that the data do not determine is
// NaN, its error then too. Diffuse albedo and f0 in the stack's unit.
struct TexelFit {
  Vec3 normal = {kNan, kNan, kNan}, normal_error = {kNan, kNan, kNan};
  double normal_angle_error = kNan;  // radians: root of the sum of both tangents' variances
  double normal_doubt = kNan;        // radians: errors.h
  double diffuse[kMostChannels] = {kNan, kNan, kNan}, diffuse_error[kMostChannels] = {kNan, kNan, kNan};
  double f0[kMostChannels] = {kNan, kNan, kNan}, f0_error[kMostChannels] = {kNan, kNan, kNan};
  double alpha_x = kNan, alpha_y = kNan, angle = kNan;
  double log_alpha_x_error = kNan, log_alpha_y_error = kNan, angle_error = kNan;
  double tilt[2] = {kNan, kNan}, tilt_error[2] = {kNan, kNan};
  double rms = kNan;    // of the residuals, weighed by the loss, in units of scale
  double scale = kNan;  // 90th percentile of the values' means over channels
  double cost = kNan;
  std::uint32_t used = 0;  // lights
  int iterations = 0;
  std::uint32_t status = 0;
  std::uint32_t cluster = 0;  // from 1; 0: none
};

// Lights and room for one thread. The same values give the same bits on any thread, in any order.
class TexelFitter {
 public:
  TexelFitter(const MapRules& rules, const LightPaths& paths, int channels);
  // Moves lights and cameras, as many as before: of the texel that is fitted next.
  void Move(const LightPaths& paths) { lights_.Set(paths, rules_.schlick); }
  // values[channel stride + light]: f_r cos_theta_i; NaN: none, infinite: saturated. `end`, `end_model`: where the
  // search ended, unless null.
  TexelFit Fit(const float* values, std::size_t stride, const HeldNumbers& held = {}, MapPoint* end = nullptr,
               MapModel* end_model = nullptr);
  // At the point of the last Fit: by the unknowns that were held and are `shared` with other texels, along the texel's
  // valley (all else follows), the texel's level of noise profiled; amplitudes in the stack's unit, as HeldNumbers has
  // them. False where that texel says nothing.
  bool ProfileOfLastFit(const HeldNumbers& shared, ProfileTerms* terms);

 private:
  bool Select(const float* values, std::size_t stride, TexelFit* fit);
  bool WidthAtBound(const MapModel& model, const MapPoint& point) const;
  // Whether a minimum may well not be the lowest: rough, not reached, or with a width at its bound.
  bool IsDoubtful(const MapModel& model, const MapDescent& descent) const;
  MapDescent DescendWithLobe(const MapModel& model, const MapDescent& lambert);
  void Report(const MapModel& model, const MapDescent& best, TexelFit* fit);
  void ReportNormal(const MapPoint& point, const MapErrors& errors, TexelFit* fit) const;
  void ReportWidths(const MapModel& model, const MapPoint& point, const MapErrors& errors, TexelFit* fit) const;

  MapRules rules_;
  int channels_;
  LightArrays lights_;
  TexelData data_;
  TexelObjective objective_;
  MapBounds bounds_;
  LightVector mean_, start_weight_;
  std::vector<double> all_means_, known_, largest_;
  std::vector<std::size_t> used_;  // lights
  // Of the last Fit; no channels: nothing was fitted.
  MapModel last_model_;
  MapPoint last_point_;
  double last_cost_ = 0;
};

}  // namespace lobefit

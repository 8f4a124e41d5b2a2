#include "lobefit/maps/engine/texel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/maps/engine/factor.h"

namespace lobefit {
namespace {

// A width or reflectance whose logarithm is not known to this is not determined; likewise a normal, in radians.
constexpr double kMostLogError = 0.5, kMostNormalError = 0.5;
constexpr double kStartAlphas[] = {0.05, 0.1, 0.2, 0.4};

double ErrorOf(const MapErrors& errors, int j) { return std::sqrt(errors.covariance[j][j]); }

// Variance of v . (a t + b b).
double Along(const MapErrors& errors, double t, double b) {
  return std::sqrt(t * t * errors.covariance[0][0] + 2 * t * b * errors.covariance[0][1] +
                   b * b * errors.covariance[1][1]);
}

// Widths and direction of L = (a 0; b c) by the eigenvalues of L L^T, with their errors.
void Axes(const MapPoint& point, const MapErrors& errors, TexelFit* fit) {
  const double a = std::exp(point.width[0]), b = point.width[1], c = std::exp(point.width[2]);
  const double xx = a * a, xy = a * b, yy = b * b + c * c;
  const double half = (xx - yy) / 2, root = std::hypot(half, xy), middle = (xx + yy) / 2;
  const double large = middle + root, small = a * a * c * c / large;
  const double angle = 0.5 * std::atan2(xy, half);
  fit->alpha_x = std::sqrt(large), fit->alpha_y = std::sqrt(small);
  fit->angle = angle <= -kPi / 2 ? kPi / 2 : angle;
  // d (xx, xy, yy) by (ln a, b, ln c).
  const double d[3][3] = {{2 * a * a, a * b, 0}, {0, a, 2 * b}, {0, 0, 2 * c * c}};
  const double cx = std::cos(angle), sx = std::sin(angle);
  double by[3][3];  // of ln alpha_x, ln alpha_y, angle
  for (int j = 0; j < 3; ++j) {
    by[0][j] = (cx * cx * d[j][0] + 2 * cx * sx * d[j][1] + sx * sx * d[j][2]) / (2 * large);
    by[1][j] = (sx * sx * d[j][0] - 2 * cx * sx * d[j][1] + cx * cx * d[j][2]) / (2 * small);
    by[2][j] = (-cx * sx * d[j][0] + (cx * cx - sx * sx) * d[j][1] + cx * sx * d[j][2]) / (large - small);
  }
  double* to[3] = {&fit->log_alpha_x_error, &fit->log_alpha_y_error, &fit->angle_error};
  for (int q = 0; q < 3; ++q) {
    double variance = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) variance += by[q][j] * by[q][k] * errors.covariance[2 + j][2 + k];
    }
    *to[q] = std::sqrt(variance);
  }
}

}  // namespace

TexelFitter::TexelFitter(const MapRules& rules, const std::vector<Vec3>& lights, int channels)
    : rules_(rules), channels_(channels) {
  lights_.Resize(lights.size());
  MoveLights(lights);
  data_.Resize(lights_.padded);
  objective_.Resize(lights_.padded);
  mean_.resize(lights_.padded), dull_.resize(lights_.padded);
}

void TexelFitter::MoveLights(const std::vector<Vec3>& lights) {
  for (std::size_t l = 0; l < lights.size(); ++l) lights_.Set(l, lights[l], rules_.schlick);
}

bool TexelFitter::Select(const float* values, std::size_t stride, TexelFit* fit) {
  all_means_.assign(lights_.count, kNan);
  sorted_.clear();
  for (std::size_t l = 0; l < lights_.count; ++l) {
    double sum = 0;
    for (int c = 0; c < channels_; ++c) sum += static_cast<double>(values[static_cast<std::size_t>(c) * stride + l]);
    all_means_[l] = sum / channels_;
    if (!std::isnan(sum)) sorted_.push_back(all_means_[l]);
  }
  if (sorted_.empty()) return false;
  const std::size_t at = (sorted_.size() - 1) * 9 / 10;
  std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(at), sorted_.end());
  double scale = sorted_[at];
  // More than a tenth of the values is saturated: the brightest that is not.
  if (std::isinf(scale)) {
    scale = 0;
    for (const double mean : sorted_) scale = std::isfinite(mean) ? std::max(scale, mean) : scale;
  }
  if (!(scale > 0)) return false;
  fit->scale = scale;
  data_.scale = scale;
  std::size_t used = 0;
  for (std::size_t l = 0; l < lights_.count; ++l) {
    if (!std::isfinite(all_means_[l]) || all_means_[l] < rules_.shadow * scale) continue;
    data_.lights.Copy(lights_, l, used);
    for (int c = 0; c < channels_; ++c) {
      data_.value[c][used] = static_cast<double>(values[static_cast<std::size_t>(c) * stride + l]) / scale;
    }
    mean_[used++] = all_means_[l] / scale;
  }
  data_.lights.Close(used);
  std::fill(mean_.begin() + static_cast<std::ptrdiff_t>(used), mean_.end(), 0.0);
  for (int c = 0; c < channels_; ++c) {
    std::fill(data_.value[c].begin() + static_cast<std::ptrdiff_t>(used), data_.value[c].end(), 0.0);
  }
  fit->used = static_cast<std::uint32_t>(used);
  const MapModel model = {rules_.lobe, channels_, rules_.schlick};
  return used >= 4 && used * static_cast<std::size_t>(channels_) > static_cast<std::size_t>(model.Unknowns());
}

MapDescent TexelFitter::DescendWithLobe(const MapModel& model, const MapDescent& lambert, double log_alpha) {
  const Vec3 normals[2] = {lambert.point.normal, HighlightNormal(data_, mean_, lambert.point, bounds_)};
  MapPoint starts[2];
  double costs[2];
  const int count = bounds_.normal_held ? 1 : 2;
  for (int k = 0; k < count; ++k) {
    costs[k] = std::numeric_limits<double>::infinity();
    for (const double alpha : kStartAlphas) {
      MapPoint point = lambert.point;
      point.normal = normals[k];
      const double width = bounds_.width_held ? log_alpha : std::log(alpha);
      point.width = {width, 0, width};
      const double cost = objective_.CostOfStart(model, data_, rules_.loss, bounds_.most_f0, &point);
      if (cost < costs[k]) costs[k] = cost, starts[k] = point;
      if (bounds_.width_held) break;
    }
  }
  const int first = count == 2 && costs[1] < costs[0] ? 1 : 0;
  MapDescent best = Descend(model, data_, starts[first], bounds_, rules_.loss, &objective_);
  if (count == 1) return best;
  // The other normal may lie in another valley: near one it leads to the same.
  if (Dot(normals[0], normals[1]) > 0.9998) return best;
  const int other = 1 - first;
  const MapDescent second =
      Descend(model, data_, starts[other], bounds_, rules_.loss, &objective_, kFineTolerance, &best);
  const int iterations = best.iterations + second.iterations;
  if (second.converged && second.cost < best.cost) best = second;
  best.iterations = iterations;
  return best;
}

TexelFit TexelFitter::Fit(const float* values, std::size_t stride, double log_alpha, MapPoint* end,
                          MapModel* end_model) {
  TexelFit fit;
  slope_ = curvature_ = 0;
  if (!Select(values, stride, &fit)) {
    fit.status = kMapTooFew | kMapNotDetermined;
    return fit;
  }
  bounds_ = {!rules_.normal_free,
             !std::isnan(log_alpha),
             std::log(rules_.least_alpha),
             std::log(rules_.most_alpha),
             rules_.schlick ? 1 / data_.scale : 1e6,
             0.02};
  const MapModel none = {MapLobe::kNone, channels_, rules_.schlick};
  // Coarse where it only serves as a start and to be compared with.
  const bool lobe_wanted = rules_.lobe != MapLobe::kNone;
  MapDescent best = Descend(none, data_, LambertStart(none, data_, mean_, bounds_, rules_.loss, &objective_, &dull_),
                            bounds_, rules_.loss, &objective_, lobe_wanted ? kCoarseTolerance : kFineTolerance);
  MapModel model = none;
  if (lobe_wanted) {
    const MapModel with = {rules_.lobe, channels_, rules_.schlick};
    const MapDescent lobe = DescendWithLobe(with, best, log_alpha);
    // Bayesian information criterion, with the profiled level of noise.
    const double count = static_cast<double>(fit.used) * channels_;
    const double more = with.Unknowns() - none.Unknowns() - (bounds_.width_held ? with.Shape() - 2 : 0);
    const bool evidence = count * std::log(best.cost / lobe.cost) > more * std::log(count);
    int iterations = best.iterations + lobe.iterations;
    if (rules_.choice == LobeChoice::kAlways || evidence) {
      best = lobe, model = with;
    } else {
      best = Descend(none, data_, best.point, bounds_, rules_.loss, &objective_);
      iterations += best.iterations;
    }
    best.iterations = iterations;
  }
  if (model.lobe == MapLobe::kNone && rules_.lobe != MapLobe::kNone) fit.status |= kMapNoLobe;
  Report(model, best, &fit);
  if (end != nullptr) *end = best.point;
  if (end_model != nullptr) *end_model = model;
  return fit;
}

void TexelFitter::Report(const MapModel& model, const MapDescent& best, TexelFit* fit) {
  const MapPoint& point = best.point;
  const double scale = data_.scale;
  fit->cost = best.cost, fit->iterations = best.iterations;
  if (!best.converged) fit->status |= kMapNotConverged;
  const MapErrors errors = ErrorsOf(model, data_, point, bounds_, rules_.loss, &objective_);
  double squares = 0, weights = 0;
  for (std::size_t l = 0; l < data_.lights.count; ++l) {
    for (int c = 0; c < channels_; ++c) {
      const double r = objective_.residual(c)[l];
      squares += objective_.weight()[l] * r * r, weights += objective_.weight()[l];
    }
  }
  fit->rms = std::sqrt(squares / weights);
  if (!errors.regular) {
    fit->status |= kMapNotDetermined;
    return;
  }
  if (point.normal.z <= bounds_.least_normal_z * 1.0001) fit->status |= kMapAtBound;
  const MapFrame frame = FrameOf(point.normal);
  fit->normal = point.normal;
  if (rules_.normal_free) {
    fit->normal_angle_error = std::sqrt(errors.covariance[0][0] + errors.covariance[1][1]);
    fit->normal_error = {Along(errors, frame.t.x, frame.b.x), Along(errors, frame.t.y, frame.b.y),
                         Along(errors, frame.t.z, frame.b.z)};
    if (!(fit->normal_angle_error < kMostNormalError)) {
      fit->status |= kMapNotDetermined;
      fit->normal = fit->normal_error = {kNan, kNan, kNan};
      fit->normal_angle_error = kNan;
    }
  }
  for (int c = 0; c < channels_; ++c) {
    fit->diffuse[c] = kPi * scale * point.diffuse[c];
    fit->diffuse_error[c] = kPi * scale * ErrorOf(errors, model.DiffuseAt(c));
    if (model.lobe == MapLobe::kNone) continue;
    fit->f0[c] = scale * point.f0[c];
    fit->f0_error[c] = scale * ErrorOf(errors, model.F0At(c));
    if (!(fit->f0_error[c] < kMostLogError * fit->f0[c]) && !std::isnan(fit->f0_error[c])) {
      fit->f0[c] = fit->f0_error[c] = kNan;
      fit->status |= kMapNotDetermined;
    }
  }
  if (model.lobe == MapLobe::kNone) return;
  const bool at_bound =
      !bounds_.width_held && (point.width[0] <= bounds_.least_width || point.width[0] >= bounds_.most_width ||
                              (model.lobe == MapLobe::kGgxAnisotropic &&
                               (point.width[2] <= bounds_.least_width || point.width[2] >= bounds_.most_width)));
  if (at_bound) fit->status |= kMapAtBound;
  if (model.lobe == MapLobe::kGgxAnisotropic) {
    Axes(point, errors, fit);
  } else {
    fit->alpha_x = fit->alpha_y = std::exp(point.width[0]);
    fit->log_alpha_x_error = fit->log_alpha_y_error = ErrorOf(errors, 2);
  }
  if (!bounds_.width_held) {
    const bool unknown_x = !(fit->log_alpha_x_error < kMostLogError),
               unknown_y = !(fit->log_alpha_y_error < kMostLogError);
    if (unknown_x || unknown_y) {
      // What f0 is follows from the width: the height of a lobe of unknown width says neither.
      fit->status |= kMapNotDetermined;
      fit->alpha_x = fit->alpha_y = fit->log_alpha_x_error = fit->log_alpha_y_error = kNan;
      fit->angle = fit->angle_error = kNan;
      for (int c = 0; c < channels_; ++c) fit->f0[c] = fit->f0_error[c] = kNan;
    }
    return;
  }
  // The valley along a held width: -ln likelihood with the level of noise profiled is N / 2 ln cost.
  MapVector gradient = {};
  MapMatrix hessian = {};
  const int unknowns = model.Unknowns();
  objective_.Derivatives(model, data_, point, rules_.loss, Curvature::kClipped, &gradient, &hessian);
  const std::array<bool, kMostUnknowns> held = HeldUnknowns(model, point, bounds_, gradient);
  MapVector coupling = {};
  for (int j = 0; j < unknowns; ++j) coupling[j] = held[j] ? 0 : hessian[j][2];
  MapVector answer = coupling;
  const double own = hessian[2][2];
  if (!Factorise(unknowns, held, &hessian)) return;
  SolveFactorised(unknowns, hessian, &answer);
  double schur = own;
  for (int j = 0; j < unknowns; ++j) schur -= coupling[j] * answer[j];
  const double units = 0.5 * static_cast<double>(fit->used) * channels_ / best.cost;
  slope_ = units * gradient[2], curvature_ = units * schur;
}

bool TexelFitter::ProfileOfLastFit(double* slope, double* curvature) const {
  *slope = slope_, *curvature = curvature_;
  return curvature_ > 0;
}

}  // namespace lobefit

// From where the search of a texel ended to numbers with errors.
#include <algorithm>
#include <cmath>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/maps/engine/texel.h"

namespace lobefit {
namespace {

// A width or reflectance whose logarithm is not known to this is not determined; likewise a normal, in radians.
constexpr double kMostLogError = 0.5, kMostNormalError = 0.5;

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

// Angles and widths of the ellipsoid with their errors.
void Ellipsoids(const MapPoint& point, const MapErrors& errors, TexelFit* fit) {
  const SlopeCoordinates at = {{point.slope[0], point.slope[1], point.width[0], point.width[1], point.width[2]}};
  double jacobian[25];
  const Ellipsoid ellipsoid = EllipsoidFromSlopeCoordinates(at, jacobian);
  const auto error = [&](int of) {
    double variance = 0;
    for (int j = 0; j < 5; ++j) {
      for (int k = 0; k < 5; ++k) {
        const double by = jacobian[5 * of + j] * jacobian[5 * of + k];
        // Held unknowns have no errors of their own.
        if (!std::isnan(errors.covariance[j][k])) variance += by * errors.covariance[j][k];
      }
    }
    return variance > 0 ? std::sqrt(variance) : kNan;
  };
  fit->alpha_x = ellipsoid.alpha_x, fit->alpha_y = ellipsoid.alpha_y, fit->angle = -ellipsoid.theta_z;
  fit->tilt[0] = ellipsoid.theta_x, fit->tilt[1] = ellipsoid.theta_y;
  fit->log_alpha_x_error = error(0) / ellipsoid.alpha_x, fit->log_alpha_y_error = error(1) / ellipsoid.alpha_y;
  for (int k = 0; k < 2; ++k) fit->tilt_error[k] = error(2 + k);
  fit->angle_error = error(4);
}

}  // namespace

void TexelFitter::ReportNormal(const MapPoint& point, const MapErrors& errors, TexelFit* fit) const {
  fit->normal = point.normal;
  if (bounds_.normal_held) return;
  if (point.normal.z <= bounds_.least_normal_z * 1.0001) fit->status |= kMapAtBound;
  const MapFrame frame = FrameOf(point.normal);
  fit->normal_angle_error = std::sqrt(errors.covariance[0][0] + errors.covariance[1][1]);
  fit->normal_doubt = errors.doubt;
  fit->normal_error = {Along(errors, frame.t.x, frame.b.x), Along(errors, frame.t.y, frame.b.y),
                       Along(errors, frame.t.z, frame.b.z)};
  if (!(fit->normal_angle_error < kMostNormalError)) {
    fit->status |= kMapNotDetermined;
    fit->normal = fit->normal_error = {kNan, kNan, kNan};
    fit->normal_angle_error = fit->normal_doubt = kNan;
  }
}

void TexelFitter::ReportWidths(const MapModel& model, const MapPoint& point, const MapErrors& errors,
                               TexelFit* fit) const {
  if (WidthAtBound(model, point)) fit->status |= kMapAtBound;
  if (model.lobe == MapLobe::kEllipsoid) {
    if (!bounds_.slope_held && std::max(std::fabs(point.slope[0]), std::fabs(point.slope[1])) >= bounds_.most_slope) {
      fit->status |= kMapAtBound;
    }
    Ellipsoids(point, errors, fit);
  } else if (model.lobe == MapLobe::kGgxAnisotropic) {
    Axes(point, errors, fit);
  } else {
    fit->alpha_x = fit->alpha_y = std::exp(point.width[0]);
    fit->log_alpha_x_error = fit->log_alpha_y_error = ErrorOf(errors, 2);
  }
  if (bounds_.width_held) return;
  if (fit->log_alpha_x_error < kMostLogError && fit->log_alpha_y_error < kMostLogError) return;
  // What f0 is follows from the width: the height of a lobe of unknown width says neither.
  fit->status |= kMapNotDetermined;
  fit->alpha_x = fit->alpha_y = fit->log_alpha_x_error = fit->log_alpha_y_error = kNan;
  fit->angle = fit->angle_error = kNan;
  for (int k = 0; k < 2; ++k) fit->tilt[k] = fit->tilt_error[k] = kNan;
  for (int c = 0; c < channels_; ++c) fit->f0[c] = fit->f0_error[c] = kNan;
}

void TexelFitter::Report(const MapModel& model, const MapDescent& best, TexelFit* fit) {
  const MapPoint& point = best.point;
  const double scale = data_.scale;
  fit->cost = best.cost, fit->iterations = best.iterations;
  if (!best.converged) fit->status |= kMapNotConverged;
  const MapErrors errors = ErrorsOf(model, data_, point, bounds_, rules_.loss, &objective_);
  double squares = 0, weights = 0;
  for (std::size_t l = 0; l < data_.lights.count; ++l) {
    double square = 0;
    for (int c = 0; c < channels_; ++c) square += objective_.residual(c)[l] * objective_.residual(c)[l];
    squares += objective_.weight()[l] * square, weights += objective_.weight()[l];
  }
  fit->rms = std::sqrt(squares / (weights * channels_));
  if (!errors.regular) {
    fit->status |= kMapNotDetermined;
    return;
  }
  ReportNormal(point, errors, fit);
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
  if (model.lobe != MapLobe::kNone) ReportWidths(model, point, errors, fit);
}

}  // namespace lobefit

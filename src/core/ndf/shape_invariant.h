// Any shape-invariant slope distribution from its radial profile, by a tabulated one-dimensional Lambda.
//
// [Heitz] Heitz 2014 sec 5.3, eq 73-78, 87-97 (math.md section 4: f takes the SQUARED slope): P22(x, y) = c f(x^2 +
// y^2) for alpha = 1, stretched, sheared and moved as in slope_distribution.h; everything about masking follows from
// M(a) = int_a^inf (x - a) P2(x) dx, P2 the one-dimensional slope density:  sigma = sqrt(q) M(-a),  M(-a) = M(a) + a,
// Lambda = M(a) / a.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/core/ndf/normal_distribution.h"

namespace lobefit {

// f(t) >= 0 and f'(t) of the squared slope t >= 0, of any scale: it is normalised here. The mean slope must exist: f
// falls faster than t^(-3/2). `support`: f = 0 from there on; give it, if finite, so that the edge is resolved.
struct SlopeProfile {
  std::function<double(double)> f, df;
  double support = std::numeric_limits<double>::infinity();
};

SlopeProfile BeckmannProfile();  // exp(-t)
SlopeProfile GgxProfile();       // (1 + t)^-2
// (1 + t / (gamma - 1))^-gamma, gamma > 1.5: GGX at 2, Beckmann towards infinity (Student's t in slopes). InputError
// otherwise.
SlopeProfile StudentProfile(double gamma);

// The profile, its normalisation and its Lambda in a table. Immutable after construction (some 20 ms): share it.
class ShapeInvariantMasking {
 public:
  // Throws InputError if f is negative, not finite or not integrable.
  explicit ShapeInvariantMasking(SlopeProfile profile);

  // Density of slopes at squared distance t from the mean (alpha = 1) and its derivative in t.
  double Density(double t, double* derivative = nullptr) const;

  // sigma / sqrt(q) = M(-a) and its derivative (the share of slopes below a), any a: quintic Hermite interpolation of
  // M, M', M''; the derivative is that of the interpolant. Absolute error below 1e-12 for profiles as smooth as the
  // named ones (measured).
  double Sigma(double a, double* derivative = nullptr) const;

  // Lambda(a) = M(a) / a, a != 0; sigma = c (1 + Lambda).
  double Lambda(double a, double* derivative = nullptr) const;

 private:
  struct Moments {
    double m, tail, p2;  // M, -M', M''
  };
  Moments Integrate(double a) const;
  double M(double a, double* derivative) const;  // a >= 0

  SlopeProfile profile_;
  double normalisation_ = 1.0;
  double step_ = 0.0;
  std::vector<Moments> table_;  // at a = sinh(k step)
};

// The distribution on the sphere: parameters alpha_x, alpha_y, r, slope_x, slope_y as in slope_distribution.h
// (`slopes.kind` is not read).
class ShapeInvariantDistribution final : public NormalDistribution {
 public:
  ShapeInvariantDistribution(std::shared_ptr<const ShapeInvariantMasking> masking, const SlopeDistribution& slopes);
  using NormalDistribution::D;
  using NormalDistribution::Sigma;
  int parameters() const override { return kSlopeParameters; }
  double D(const Vec3& wm, double* gradient) const override;
  double Sigma(const Vec3& u, double* gradient) const override;
  Ellipsoid Outline() const override { return outline_; }

 private:
  std::shared_ptr<const ShapeInvariantMasking> masking_;
  SlopeDistribution slopes_;
  Ellipsoid outline_;
};

}  // namespace lobefit

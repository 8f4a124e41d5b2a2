// Samples of the GGX slope distribution [Loubet section 4]: radii between two bounds, slopes inside a triangle.
#pragma once

#include <array>
#include <cstddef>

#include "lobefit/core/slopes/slope_integral.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Radius drawn from the isotropic P between r_min and r_max (which may be infinite): [Loubet eq 19] in the form of
// MATH.md section 3, s^2 = ((1-v) r_min^2 B + v r_max^2 A) / ((1-v) B + v A), A = alpha^2 + r_min^2, B = alpha^2 +
// r_max^2. 0 <= r_min <= r_max, v in [0, 1]; derivatives for s > 0.
struct TruncatedRadiusGradient {
  double dalpha, dr_min, dr_max, dv;
};
double TruncatedRadius(double alpha, double r_min, double r_max, double v, TruncatedRadiusGradient* gradient = nullptr);
// Its normalisation N_R, the integral of r P dr between the two [Loubet eq 17].
double TruncatedRadiusMass(double alpha, double r_min, double r_max);

// Slopes distributed as P restricted to one triangle: azimuth by a safeguarded Newton iteration on the integral of the
// part of the triangle that the azimuth has passed, radius in closed form [Loubet eq 13-19].
class GgxTriangleSampler {
 public:
  GgxTriangleSampler(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y);

  // Integral of P over the triangle; 0 for one without area, which must not be sampled.
  double integral() const { return integral_; }
  // A slope inside the triangle; u, v in [0, 1]. Monotone pieces of u sweep the azimuth, v the radius: stratified
  // numbers stay stratified.
  Vec2 Sample(double u, double v) const;
  // Probability density of a slope inside the triangle, P / integral.
  double Pdf(const Vec2& s) const { return GgxSlopeDensity(s, alpha_x_, alpha_y_) / integral_; }

 private:
  // The part of the triangle between the rays from the origin through `corner` and through the ends of the two sides
  // that leave `corner`, `far_side` and `near_side` (both ends on one ray), in slopes divided by alpha. Where the
  // origin lies inside the triangle the near side is the way back to the origin.
  struct Sector {
    Vec2 corner, far_side, near_side;
    double integral;
  };
  void AddSector(const Vec2& corner, const Vec2& far_end, const Vec2& near_end);

  double alpha_x_, alpha_y_, integral_;
  double sector_sum_ = 0;  // integral_ but for rounding
  std::array<Sector, 3> sectors_{};
  std::size_t sector_count_ = 0;
};

}  // namespace lobefit

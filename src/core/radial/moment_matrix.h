// Moments of a profile for many a at once: a matrix, which does not depend on the profile, times its density at few
// points that all a share.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lobefit/core/radial/profile.h"
#include "lobefit/core/radial/profile_moments.h"

namespace lobefit {

// Sums over quadrature points of w e^E and w e^E B_k, where within an interval of the spline e^E and e^E B_k are taken
// as the polynomials through kPoints Chebyshev points [Berrut and Trefethen 2004, the barycentric formula]: one product
// of matrices in place of an exponential a point. Memory: 24 kPoints bytes an interval and row.
class MomentMatrix {
 public:
  static constexpr std::size_t kPoints = 32;  // an interval

  // `end`: the largest u of a point; there the last interval, the tail, ends.
  MomentMatrix(const ProfileSpline& spline, double end);
  // One a more: three rows, of the sums of its points.
  void Add(const ProfilePoints& points);
  // Call once, after the last a.
  void Finish();

  // Whether e^E varies by no more than e^20 within an interval: the polynomials then keep it to 1e-14 of its largest.
  bool Resolves(const Profile& profile) const;
  // As ProfilePoints::AddMoments less GGX's, for each a in the order of Add: moments[a][m][k], k < stride, all set; 0
  // from k = K + 1 on. Domain: Resolves.
  void Moments(const Profile& profile, std::size_t stride, double* moments) const;

 private:
  std::size_t columns() const { return widths_.size() * kPoints; }

  std::vector<double> widths_;             // of the intervals, in u
  std::array<double, kPoints> chebyshev_;  // from 0 to 1
  std::vector<double> x_;                  // of the points, u less the interval's left end
  std::vector<double> basis_;              // [k][point]
  std::size_t rows_ = 0;                   // three an a
  // Before Finish [row][point]; after it block after block of rows, each from its first point with a weight on:
  // [point][row of the block].
  std::vector<double> weights_;
  std::vector<std::size_t> first_;  // [block] that point
};

}  // namespace lobefit

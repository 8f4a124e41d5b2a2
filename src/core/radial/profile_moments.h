// Quadrature sums of a profile over points that do not depend on its coefficients, in SIMD.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lobefit/core/radial/profile.h"

namespace lobefit {

// Points of a rule with three weights each, in pieces that lie within one interval of the spline, each padded to whole
// vectors with points of weight 0.
class ProfilePoints {
 public:
  // `u`: within `interval` or on its ends. `weights` are times e^-2u.
  void Add(const ProfileSpline& spline, std::size_t interval, double u, const std::array<double, 3>& weights);
  // Call once, after the last point.
  void Finish();

  // moments[m * stride] += sum w_m (e^E - Z / pi): as it stands without the factor pi / Z or, without `minus_ggx`, sum
  // w_m e^E; moments[m * stride + 1 + k] += sum w_m e^E B_k, m = 0, 1, 2: a profile's sums by the cubics of E, and of
  // e^E x^j for the derivatives.
  void AddMoments(const Profile& profile, bool minus_ggx, double* moments, std::size_t stride) const;

  // each(interval, x, weights): of every point, x = u less the interval's left end.
  template <class Each>
  void ForEach(const Each& each) const {
    for (const Piece& piece : pieces_) {
      for (std::size_t i = piece.begin; i < piece.end; ++i)
        each(piece.interval, x_[i], std::array<double, 3>{weights_[0][i], weights_[1][i], weights_[2][i]});
    }
  }

 private:
  struct Piece {
    std::size_t interval, begin, end;
  };
  void Pad();

  std::vector<Piece> pieces_;
  std::vector<double> x_;  // u less the interval's left end
  std::array<std::vector<double>, 3> weights_;
};

}  // namespace lobefit

// Directions as a sample sees them that stands crooked on a stage.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobefit/core/instrument/misalignment.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Axes of the nominal frame in that of a sample which is crooked by `e` on a stage at azimuth `z`.
class TurnedAxes {
 public:
  TurnedAxes(const Misalignment& e, double z) {
    const double c = std::cos(z), s = std::sin(z);
    const auto turned = [](const Vec3& w, double cosine, double sine) {
      return Vec3{cosine * w.x - sine * w.y, sine * w.x + cosine * w.y, w.z};
    };
    const Vec3 nominal[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t k = 0; k < 3; ++k) axes_[k] = turned(lobefit::InSampleFrame(e, turned(nominal[k], c, s)), c, -s);
  }
  Vec3 InSampleFrame(const Vec3& w) const { return w.x * axes_[0] + w.y * axes_[1] + w.z * axes_[2]; }

 private:
  Vec3 axes_[3];
};

// Of each turn: `angles` are e_x and e_y of all, then e_z of the second turn and so on.
inline std::vector<TurnedAxes> TurnsOf(const std::vector<double>& azimuths, const std::vector<double>& angles) {
  std::vector<TurnedAxes> turns;
  for (std::size_t t = 0; t < azimuths.size(); ++t)
    turns.emplace_back(Misalignment{angles[0], angles[1], t == 0 ? 0.0 : angles[t + 1]}, azimuths[t]);
  return turns;
}

// Six arrays of directions (wi_x to wo_z), samples [begin, begin + count), in the sample's frame, `stride` apart in
// `moved`. turn[i]: null, the first.
inline void TurnDirections(const std::vector<TurnedAxes>& turns, const double* const direction[6],
                           const std::uint16_t* turn, std::size_t begin, std::size_t count, std::size_t stride,
                           double* moved) {
  // Tilted below its own horizon the sample would see nothing.
  constexpr double kLeastCosine = 1e-4;
  for (std::size_t side = 0; side < 6; side += 3) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = begin + i;
      Vec3 w = turns[turn == nullptr ? 0 : turn[at]].InSampleFrame(
          {direction[side][at], direction[side + 1][at], direction[side + 2][at]});
      w.z = std::max(w.z, kLeastCosine);
      const double all[3] = {w.x, w.y, w.z};
      for (std::size_t k = 0; k < 3; ++k) moved[(side + k) * stride + i] = all[k];
    }
  }
}

}  // namespace lobefit

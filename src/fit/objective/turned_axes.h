// Directions as a sample sees them that stands crooked on a stage.
#pragma once

#include <cmath>

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

}  // namespace lobefit

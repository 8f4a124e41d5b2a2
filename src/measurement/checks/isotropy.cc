#include "lobefit/measurement/checks/isotropy.h"

#include <cmath>

namespace lobefit {

Samples SpreadOverAzimuths(const Samples& samples) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  Samples spread = samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle = golden * static_cast<double>(i), c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](const Vec3& w, double* x, double* y) {
      *x = c * w.x - s * w.y;
      *y = s * w.x + c * w.y;
    };
    turn(samples.wi(i), &spread.wi_x[i], &spread.wi_y[i]);
    turn(samples.wo(i), &spread.wo_x[i], &spread.wo_y[i]);
  }
  return spread;
}

}  // namespace lobefit

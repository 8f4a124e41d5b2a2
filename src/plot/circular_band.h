// What a disc or a ring covers of the pixels of a row.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lobefit {

// The points between two distances from a centre; an inner one of -1 leaves no hole.
class CircularBand {
 public:
  CircularBand(double inner, double outer)
      : inner_(inner),
        outer_(outer),
        full_low2_(inner + kSure <= 0 ? -1 : Square(inner + kSure)),
        full_high2_(outer > kSure ? Square(outer - kSure) : -1) {}

  // Calls visit(x, coverage) for the pixels of [begin, end) that are covered, in their order; coverage 1-255. `center`
  // is the circle's along the row, `dy` the row's distance from it.
  template <class Visit>
  void ForEach(double center, double dy, int begin, int end, const Visit& visit) const {
    const double reach2 = Square(outer_ + kSure) - dy * dy;
    if (reach2 <= 0) return;
    const double reach = std::sqrt(reach2), hole2 = inner_ > kSure ? Square(inner_ - kSure) - dy * dy : -1;
    const int left = Inside(std::floor(center - reach - 0.5), begin, end),
              right = Inside(std::ceil(center + reach + 0.5), begin, end);
    if (hole2 <= 0) {
      Walk(left, right, center, dy, visit);
      return;
    }
    const double hole = std::sqrt(hole2);
    const int hole_left = Inside(std::ceil(center - hole + 0.5), left, right),
              hole_right = Inside(std::floor(center + hole - 0.5), hole_left, right);
    Walk(left, hole_left, center, dy, visit);
    Walk(hole_right, right, center, dy, visit);
  }

 private:
  // A pixel is covered in part within half a pixel of an edge; a little more, so that rounding decides nothing.
  static constexpr double kSure = 0.5 + 1e-6;

  static double Square(double v) { return v * v; }
  static int Inside(double x, int begin, int end) {
    return static_cast<int>(std::clamp(x, static_cast<double>(begin), static_cast<double>(end)));
  }

  template <class Visit>
  void Walk(int begin, int end, double center, double dy, const Visit& visit) const {
    for (int x = begin; x < end; ++x) {
      const double dx = x + 0.5 - center, distance2 = dx * dx + dy * dy;
      if (distance2 >= full_low2_ && distance2 <= full_high2_) {
        visit(x, std::uint8_t{255});
        continue;
      }
      const double distance = std::hypot(dx, dy);
      const double inside = std::min(outer_ - distance, distance - inner_) + 0.5;
      const auto coverage = static_cast<std::uint8_t>(std::lround(255 * std::clamp(inside, 0.0, 1.0)));
      if (coverage != 0) visit(x, coverage);
    }
  }

  double inner_, outer_;
  double full_low2_, full_high2_;  // squared distances between which a pixel is covered wholly
};

}  // namespace lobefit

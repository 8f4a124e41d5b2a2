#include "lobefit/core/sel/sel_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Directions center + cos(phi) cosine + sin(phi) sine in lobe space, unit vectors, phi in [begin, end].
struct Arc {
  Vec3 center, cosine, sine;
  double begin, end;

  Vec3 At(double phi) const { return center + std::cos(phi) * cosine + std::sin(phi) * sine; }
};

// 1 / distance to the ellipsoid along v, and its gradient.
double Gauge(double alpha_x, double alpha_y, const Vec3& v, Vec3* gradient) {
  SelLobeGradient lobe;
  const double k = SelLobe(alpha_x, alpha_y, v, &lobe);
  const double f = 1 / std::sqrt(k);
  *gradient = (-0.5 * f / k) * lobe.dv;
  return f;
}

// A number that is not above the minimum of plane . v over the arc, by the closed form less the rounding of its terms.
double MinimumOverArc(const Vec3& plane, const Arc& arc) {
  const double constant = Dot(plane, arc.center), c = Dot(plane, arc.cosine), s = Dot(plane, arc.sine);
  const double swing = std::hypot(c, s);
  // cos(phi) c + sin(phi) s = swing cos(phi - peak): the farther end from the peak has the minimum, unless the trough
  // lies between.
  const double peak = std::atan2(s, c);
  const double from = std::remainder(arc.begin - peak, 2 * kPi), to = from + (arc.end - arc.begin);
  const bool trough = (from <= kPi && to >= kPi) || (from <= -kPi && to >= -kPi) || to >= 3 * kPi;
  const double lowest = trough ? -swing : swing * std::min(std::cos(from), std::cos(to));
  return constant + lowest - 16 * kEps * (std::fabs(constant) + swing + Norm(plane));
}

class RimSearch {
 public:
  RimSearch(double alpha_x, double alpha_y, double tolerance)
      : alpha_x_(alpha_x), alpha_y_(alpha_y), keep_(1 / std::sqrt(1 + tolerance)) {}

  // Lowers `bound_` to a bound of the gauge over the arc too, halving it as long as that is not tight.
  void Add(const Arc& whole) {
    std::vector<Arc> stack = {whole};
    while (!stack.empty()) {
      const Arc arc = stack.back();
      stack.pop_back();
      const double middle = 0.5 * (arc.begin + arc.end);
      const Vec3 v = arc.At(middle);
      Vec3 plane;
      const double f = Gauge(alpha_x_, alpha_y_, v, &plane);
      if (f < least_) {
        least_ = f;
        direction_ = v;
      }
      const double lower = MinimumOverArc(plane, arc);
      if (lower >= keep_ * least_ || arc.end - arc.begin < kFinest) {
        bound_ = std::min(bound_, lower);
        continue;
      }
      Arc half = arc;
      half.begin = middle;
      stack.push_back(half);
      half = arc;
      half.end = middle;
      stack.push_back(half);
    }
  }

  // K <= 1 is known without any search.
  SelBound Result(const Mat3& to_world) const {
    const double bound = bound_ > 1 ? 1 / (bound_ * bound_) * (1 + 4 * kEps) : 1;
    return {std::min(1.0, bound), to_world * Normalized(direction_)};
  }

 private:
  // Arcs below this length (radians) are not halved: rounding, not curvature, then limits the bound.
  static constexpr double kFinest = 1e-12;
  double alpha_x_, alpha_y_, keep_;
  double least_ = std::numeric_limits<double>::infinity();
  double bound_ = std::numeric_limits<double>::infinity();
  Vec3 direction_ = {0, 0, 1};
};

// Whether the ray from the origin along d meets the box, inclusive of its surface and of rounding.
bool RayMeetsBox(const Vec3& d, const Vec3& lower, const Vec3& upper) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  const auto slab = [&](double direction, double from, double to) {
    if (direction == 0) {
      if (from > 0 || to < 0) leave = -1;
      return;
    }
    const double a = from / direction, b = to / direction;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  slab(d.x, lower.x, upper.x);
  slab(d.y, lower.y, upper.y);
  slab(d.z, lower.z, upper.z);
  return enter <= leave * (1 + 8 * kEps);
}

}  // namespace

SelBound SelBoundOverCone(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& axis, double half_angle,
                          double tolerance) {
  const Mat3 to_lobe = RotationMatrix(rotation);
  const Mat3 to_world = Transposed(to_lobe);
  const Vec3 w = to_lobe * axis;
  const double across = std::hypot(w.x, w.y);
  if (std::atan2(across, w.z) <= half_angle * (1 + 4 * kEps) + 4 * kEps) return {1, to_lobe.row[2]};
  // An orthonormal pair across w, its first vector in the plane of w and the lobe axis.
  const Vec3 e2 = across > 0 ? Vec3{-w.y / across, w.x / across, 0} : Vec3{0, 1, 0};
  const Vec3 e1 = Cross(e2, w);
  RimSearch search(alpha_x, alpha_y, tolerance);
  const double c = std::cos(half_angle), s = std::sin(half_angle);
  constexpr int kArcs = 4;
  // The first arc is centred on the point nearest to the lobe's axis, where a good value is likely: it prunes the
  // others.
  for (const int i : {0, 1, 3, 2}) {
    const double middle = i * (2 * kPi / kArcs) + (Dot(e1, Vec3{0, 0, 1}) < 0 ? kPi : 0.0);
    search.Add({c * w, s * e1, s * e2, middle - kPi / kArcs, middle + kPi / kArcs});
  }
  return search.Result(to_world);
}

SelBound SelBoundOverBox(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& lower, const Vec3& upper,
                         double tolerance) {
  const Mat3 to_lobe = RotationMatrix(rotation);
  const Mat3 to_world = Transposed(to_lobe);
  const Vec3 lobe_axis = to_lobe.row[2];
  const bool inside = lower.x <= 0 && upper.x >= 0 && lower.y <= 0 && upper.y >= 0 && lower.z <= 0 && upper.z >= 0;
  if (inside || RayMeetsBox(lobe_axis, lower, upper)) return {1, lobe_axis};
  const auto corner = [&](int i) {
    return Vec3{(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
  };
  // Every edge of the box, as an arc of a great circle; the rim of the set of directions is made of some of them.
  std::vector<std::pair<double, Arc>> arcs;
  for (int i = 0; i < 8; ++i) {
    for (const int axis_bit : {1, 2, 4}) {
      if ((i & axis_bit) != 0) continue;
      const Vec3 from = corner(i), to = corner(i | axis_bit);
      const Vec3 u = Normalized(from);
      const Vec3 normal = Cross(u, to);
      const double sine = Norm(normal);
      const double angle = std::atan2(sine, Dot(u, to));
      const Vec3 e = sine > 0 ? Cross((1 / sine) * normal, u) : Vec3{0, 0, 0};
      const Arc arc = {{0, 0, 0}, to_lobe * u, to_lobe * e, 0, angle};
      arcs.emplace_back(-arc.At(0.5 * angle).z, arc);
    }
  }
  // Edges near the axis first: their values prune the others.
  std::sort(arcs.begin(), arcs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  RimSearch search(alpha_x, alpha_y, tolerance);
  for (const auto& [order, arc] : arcs) search.Add(arc);
  return search.Result(to_world);
}

}  // namespace lobefit

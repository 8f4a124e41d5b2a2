#include <algorithm>
#include <limits>
#include <numeric>

#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"
#include "lobefit/fit/coordinates/coordinates.h"

namespace lobefit {
namespace {

double SquaredDistance(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return square;
}

}  // namespace

std::vector<int> Layout::CoordinatesOfLobe(std::size_t lobe) const {
  std::vector<int> coordinates;
  for (std::size_t k = 0; k < shapes_[lobe].columns(); ++k)
    coordinates.push_back(static_cast<int>(shapes_[lobe].first + k));
  std::size_t first = 0;
  for (std::size_t l = 0; l < lobe; ++l) first += FresnelParameters(recipe_.model.lobes[l].fresnel);
  for (const std::vector<Linear>& channel : linear_) {
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[lobe].fresnel); ++k)
      coordinates.push_back(channel[first + k].index);
  }
  return coordinates;
}

bool Layout::AreInterchangeable(std::size_t lobe, std::size_t other) const {
  const Lobe &a = recipe_.model.lobes[lobe], &b = recipe_.model.lobes[other];
  if (a.ndf != b.ndf || a.masking != b.masking || a.fresnel != b.fresnel || a.metal != b.metal ||
      a.direction != b.direction || GridOf(a) != GridOf(b)) {
    return false;
  }
  const auto first_a = recipe_.parameters.begin() + static_cast<std::ptrdiff_t>(FirstParameter(recipe_.model, lobe));
  const auto first_b = recipe_.parameters.begin() + static_cast<std::ptrdiff_t>(FirstParameter(recipe_.model, other));
  const std::size_t count = ShapeParameters(a) + FresnelParameters(a.fresnel);
  return std::equal(first_a, first_a + static_cast<std::ptrdiff_t>(count), first_b,
                    [](const ParameterRecipe& p, const ParameterRecipe& q) {
                      return p.fixed == q.fixed && p.low == q.low && p.high == q.high && p.shared == q.shared;
                    });
}

std::vector<double> Layout::NearestEquivalent(const std::vector<double>& u, const std::vector<double>& to) const {
  std::vector<std::size_t> order(shapes_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> nearest = u;
  double least = std::numeric_limits<double>::infinity();
  do {
    bool allowed = true;
    std::vector<double> v = u;
    for (std::size_t l = 0; l < order.size() && allowed; ++l) {
      allowed = order[l] == l || AreInterchangeable(l, order[l]);
      if (!allowed) break;
      const std::vector<int> here = CoordinatesOfLobe(l), there = CoordinatesOfLobe(order[l]);
      for (std::size_t k = 0; k < here.size(); ++k) {
        if (here[k] >= 0) v[static_cast<std::size_t>(here[k])] = u[static_cast<std::size_t>(there[k])];
      }
      // Slope coordinates describe each ellipsoid once.
      const Shape& shape = shapes_[l];
      if (shape.slope) continue;
      std::vector<double> turned = v;
      const Ellipsoid ellipsoid = NearestEllipsoid(EllipsoidAt(shape, v.data()), EllipsoidAt(shape, to.data()));
      SetEllipsoid(shape, ellipsoid, &turned);
      // Not where it would move what the recipe fixes.
      const Ellipsoid set = EllipsoidAt(shape, turned.data());
      const auto near = [](double a, double b) { return std::abs(a - b) < 1e-9; };
      if (near(set.alpha_x, ellipsoid.alpha_x) && near(set.alpha_y, ellipsoid.alpha_y) &&
          near(set.theta_x, ellipsoid.theta_x) && near(set.theta_y, ellipsoid.theta_y) &&
          near(set.theta_z, ellipsoid.theta_z)) {
        v = turned;
      }
    }
    if (!allowed) continue;
    const double square = SquaredDistance(v, to);
    if (square < least) least = square, nearest = v;
  } while (std::next_permutation(order.begin(), order.end()));
  return nearest;
}

}  // namespace lobefit

#include "lobefit/io/bsdf_xml/angle_basis.h"

#include <cmath>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double Square(double x) { return x * x; }

AngleBasis FromBounds(const char* name, const std::vector<double>& bounds, const std::vector<std::size_t>& patches) {
  AngleBasis basis = {name, {}};
  for (std::size_t i = 0; i < patches.size(); ++i) basis.rings.push_back({bounds[i], bounds[i + 1], patches[i]});
  return basis;
}

}  // namespace

std::vector<AngleBasis::Patch> AngleBasis::Patches() const {
  std::vector<Patch> all;
  all.reserve(size());
  for (const Ring& ring : rings) {
    const double lower = DegreesToRadians(ring.lower_deg), upper = DegreesToRadians(ring.upper_deg);
    const double turn = 2 * kPi / static_cast<double>(ring.patches);
    const double solid_angle = turn * (std::cos(lower) - std::cos(upper));
    const double projected = turn / 2 * (Square(std::cos(lower)) - Square(std::cos(upper)));
    const bool cap = ring.lower_deg == 0 && ring.patches == 1;
    for (std::size_t k = 0; k < ring.patches; ++k) {
      const double theta = cap ? 0.0 : (lower + upper) / 2;
      all.push_back({FromSpherical(theta, turn * static_cast<double>(k)), solid_angle, projected});
    }
  }
  return all;
}

std::size_t AngleBasis::size() const {
  std::size_t count = 0;
  for (const Ring& ring : rings) count += ring.patches;
  return count;
}

const std::vector<AngleBasis>& KlemsBases() {
  static const std::vector<AngleBasis> bases = {
      FromBounds("LBNL/Klems Full", {0, 5, 15, 25, 35, 45, 55, 65, 75, 90}, {1, 8, 16, 20, 24, 24, 24, 16, 12}),
      FromBounds("LBNL/Klems Half", {0, 6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90}, {1, 8, 12, 16, 20, 12, 4}),
      FromBounds("LBNL/Klems Quarter", {0, 9, 27, 46, 66, 90}, {1, 8, 12, 12, 8}),
  };
  return bases;
}

}  // namespace lobefit

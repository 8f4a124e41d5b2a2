#include "lobefit/maps/stack/geometry.h"

#include <cmath>

namespace lobefit {

Vec3 PointOf(const Stack& stack, std::size_t texel) {
  const double pitch = stack.near->width_mm / static_cast<double>(stack.width);
  const double x = static_cast<double>(texel % stack.width) + 0.5 - 0.5 * static_cast<double>(stack.width);
  const double y = 0.5 * static_cast<double>(stack.height) - static_cast<double>(texel / stack.width) - 0.5;
  return {pitch * x, pitch * y, 0};
}

Vec3 DirectionAt(const Stack& stack, std::size_t light, std::size_t texel) {
  if (!stack.near) return stack.lights[light].direction;
  return Normalized(stack.lights[light].place - PointOf(stack, texel));
}

double IrradianceAt(const Stack& stack, std::size_t light, std::size_t texel) {
  if (!stack.near) return 1;
  const Vec3& place = stack.lights[light].place;
  const Vec3 beam = PointOf(stack, texel) - place;
  const double square = Dot(beam, beam);
  double irradiance = stack.near->inverse_square ? stack.near->reference_mm * stack.near->reference_mm / square : 1;
  if (stack.near->exponent != 0) {
    const double cosine = -Dot(beam, place) / std::sqrt(square * Dot(place, place));
    irradiance *= cosine > 0 ? std::pow(cosine, stack.near->exponent) : 0;
  }
  return irradiance;
}

void DirectionsAt(const Stack& stack, const std::vector<std::size_t>& index, std::size_t texel,
                  std::vector<Vec3>* directions) {
  directions->resize(index.size());
  for (std::size_t l = 0; l < index.size(); ++l) (*directions)[l] = DirectionAt(stack, index[l], texel);
}

}  // namespace lobefit

#include "lobefit/maps/stack/geometry.h"

#include <cmath>

namespace lobefit {

Vec3 PointOf(const Stack& stack, std::size_t texel) {
  const double pitch = stack.width_mm / static_cast<double>(stack.width);
  const double x = static_cast<double>(texel % stack.width) + 0.5 - 0.5 * static_cast<double>(stack.width);
  const double y = 0.5 * static_cast<double>(stack.height) - static_cast<double>(texel / stack.width) - 0.5;
  return {pitch * x, pitch * y, 0};
}

Vec3 DirectionAt(const Stack& stack, std::size_t light, std::size_t texel) {
  if (!stack.near) return stack.lights[light].direction;
  return Normalized(stack.lights[light].place - PointOf(stack, texel));
}

Vec3 ViewAt(const Stack& stack, std::size_t light, std::size_t texel) {
  if (stack.cameras.empty()) return {0, 0, 1};
  const Vec3& camera = stack.cameras[stack.cameras.size() == 1 ? 0 : light];
  return Normalized(camera - PointOf(stack, texel));
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

void PathsAt(const Stack& stack, const std::vector<std::size_t>& index, std::size_t texel, LightPaths* paths) {
  paths->wi.resize(index.size());
  paths->wo.resize(stack.cameras.empty() ? 0 : index.size());
  for (std::size_t l = 0; l < index.size(); ++l) paths->wi[l] = DirectionAt(stack, index[l], texel);
  for (std::size_t l = 0; l < paths->wo.size(); ++l) paths->wo[l] = ViewAt(stack, index[l], texel);
}

}  // namespace lobefit

// Texels of known truth for tests of the engine.
#pragma once

#include <cmath>
#include <vector>

#include "lobefit/maps/relight.h"
#include "lobefit/maps/synthetic/hills.h"
#include "lobefit/maps/synthetic/write_stack.h"
#include "lobefit/synthesis/random.h"

namespace lobefit::test {

// Values of texels under lights, [channel lights + light], with noise y (1 + m g) + a g'.
class TexelValues {
 public:
  TexelValues(const Maps& maps, std::vector<Vec3> lights, double multiplicative, double additive)
      : lights_(std::move(lights)),
        multiplicative_(multiplicative),
        additive_(additive),
        relighting_(maps, {lights_, {}}, true, {}),
        channels_(static_cast<std::size_t>(maps.channels)) {}

  const std::vector<float>& Of(std::size_t texel, std::uint64_t seed) {
    std::vector<double> exact(channels_ * lights_.size());
    relighting_.Texel(texel, exact.data(), lights_.size());
    RandomNumbers random(StreamSeed(seed, texel));
    values_.clear();
    for (const double v : exact) {
      values_.push_back(static_cast<float>(v * (1 + multiplicative_ * random.Normal()) + additive_ * random.Normal()));
    }
    return values_;
  }

 private:
  std::vector<Vec3> lights_;
  double multiplicative_, additive_;
  Relighting relighting_;
  std::size_t channels_;
  std::vector<float> values_;
};

inline double At(const Maps& maps, MapPart part, const char* name, std::size_t texel) {
  return static_cast<double>(maps.rows.values[PlaneIndex(maps.planes, part, name)][texel]);
}
inline Vec3 NormalAt(const Maps& maps, std::size_t texel) {
  const Vec3 n = {static_cast<double>(maps.rows.values[0][texel]), static_cast<double>(maps.rows.values[1][texel]),
                  static_cast<double>(maps.rows.values[2][texel])};
  return Normalized(n);
}
// Radians, accurate near 0.
inline double AngleBetween(const Vec3& a, const Vec3& b) { return std::atan2(Norm(Cross(a, b)), Dot(a, b)); }

}  // namespace lobefit::test

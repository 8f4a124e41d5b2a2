// The lights of a stack as the fit takes them, and the part of them that a texel uses.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// Lights that are worked on together.
inline constexpr std::size_t kLanes = 8;

// Begins where a cache line does, so that the widest loads and stores do not cross one.
template <class T>
struct OnCacheLine {
  using value_type = T;
  static constexpr std::align_val_t kLine{kLanes * sizeof(double)};
  OnCacheLine() = default;
  template <class U>
  OnCacheLine(const OnCacheLine<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* pointer, std::size_t) { ::operator delete(pointer, kLine); }
  bool operator==(const OnCacheLine&) const { return true; }
};
using LightVector = std::vector<double, OnCacheLine<double>>;

// Unit vectors from a texel.
struct LightPaths {
  std::vector<Vec3> wi;  // to the lights
  std::vector<Vec3> wo;  // to the camera of each photograph; empty: +z for all
};

// Arrays of `count` photographs: wi is (x, y, z), wo is (out_x, out_y, out_z). Padded to a multiple of kLanes by lights
// along z whose `live` is 0. square = |h|^2 where h = wi + wo; k is Schlick's (1 - cos_d)^5.
struct LightArrays {
  std::size_t count = 0, padded = 0;
  bool from_z = true;  // wo = +z for all, which the quicker kernels take for granted
  LightVector x, y, z, out_x, out_y, out_z, square, k, live;

  void Resize(std::size_t lights);
  // As many as before.
  void Set(const LightPaths& paths, bool schlick);
  void Set(std::size_t at, const Vec3& wi, const Vec3& wo, bool schlick);
  // Makes these lights those of `from` at `index`, from 0. Domain: as many at most as these were made for.
  void Take(const LightArrays& from, const std::vector<std::size_t>& index);
  // Makes the lights from `lights` on padding.
  void Close(std::size_t lights);
};

}  // namespace lobefit

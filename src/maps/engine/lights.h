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

// Arrays of `count` lights, padded to a multiple of kLanes by lights along z whose `live` is 0. square = |h|^2 where h =
// wi + wo with wo = +z; k is Schlick's (1 - cos_d)^5.
struct LightArrays {
  std::size_t count = 0, padded = 0;
  LightVector x, y, z, square, k, live;

  void Resize(std::size_t lights);
  void Set(std::size_t at, const Vec3& direction, bool schlick);
  void Copy(const LightArrays& from, std::size_t index, std::size_t at);
  // Makes the lights from `lights` on padding.
  void Close(std::size_t lights);
};

}  // namespace lobefit

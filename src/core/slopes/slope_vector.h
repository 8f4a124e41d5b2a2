// Arithmetic of slopes, for the sources of this folder that integrate over the slope plane.
#pragma once

#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {

inline Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, const Vec2& a) { return {s * a.x, s * a.y}; }
inline double Dot2(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }
// a.x b.y - a.y b.x with the rounding of one product taken back (Kahan): exact zeros of parallel vectors stay small.
inline double Cross2(const Vec2& a, const Vec2& b) {
  const double product = a.y * b.x;
  return std::fma(a.x, b.y, -product) + std::fma(-a.y, b.x, product);
}

}  // namespace lobefit

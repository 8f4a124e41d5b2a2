// Three-vectors and 3x3 matrices, templated on the scalar so that the same formula takes double and ceres::Jet.
// n = +z, x = tangent. All directions point away from the surface.
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace lobefit {

inline constexpr double kPi = 3.14159265358979323846264338327950288;
inline constexpr double kInvPi = 0.318309886183790671537767526745028724;
inline constexpr double kSqrtPi = 1.77245385090551602729816748334114518;
inline constexpr double kInvSqrtPi = 0.564189583547756286948079451560772586;
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class T>
struct Vec3T {
  T x, y, z;
};
using Vec3 = Vec3T<double>;

// Slope of a normal m, (-m_x / m_z, -m_y / m_z) [Heitz eq 61], or any pair in the tangent plane.
template <class T>
struct Vec2T {
  T x, y;
};
using Vec2 = Vec2T<double>;

template <class T>
Vec3T<T> operator+(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vec3T<T> operator-(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vec3T<T> operator-(const Vec3T<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
Vec3T<T> operator*(const T& s, const Vec3T<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T Dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vec3T<T> Cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T Norm(const Vec3T<T>& a) {
  using std::sqrt;
  return sqrt(Dot(a, a));
}
// Domain: a != 0.
template <class T>
Vec3T<T> Normalized(const Vec3T<T>& a) {
  return (static_cast<T>(1.0) / Norm(a)) * a;
}

// Row-major 3x3 matrix.
template <class T>
struct Mat3T {
  std::array<Vec3T<T>, 3> row;
};
using Mat3 = Mat3T<double>;

template <class T>
Vec3T<T> operator*(const Mat3T<T>& a, const Vec3T<T>& v) {
  return {Dot(a.row[0], v), Dot(a.row[1], v), Dot(a.row[2], v)};
}
template <class T>
Mat3T<T> Transposed(const Mat3T<T>& a) {
  return {{{{a.row[0].x, a.row[1].x, a.row[2].x},
            {a.row[0].y, a.row[1].y, a.row[2].y},
            {a.row[0].z, a.row[1].z, a.row[2].z}}}};
}
template <class T>
Mat3T<T> operator*(const Mat3T<T>& a, const Mat3T<T>& b) {
  const Mat3T<T> bt = Transposed(b);
  return {{{bt * a.row[0], bt * a.row[1], bt * a.row[2]}}};
}

inline constexpr double DegreesToRadians(double degrees) { return degrees * (kPi / 180.0); }
inline constexpr double RadiansToDegrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace lobefit

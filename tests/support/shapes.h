// Comparison with rows of the reference tables, and random and hostile ellipsoids and directions for tests of laws.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/reference_table.h"
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid/ellipsoid.h"

namespace lobefit {

inline const std::vector<std::string> kEllipsoidNames = {"alpha_x", "alpha_y", "theta_x", "theta_y", "theta_z"};

inline Ellipsoid EllipsoidOfRow(const ReferenceTable& table, std::size_t row) {
  return {table(row, "alpha_x"), table(row, "alpha_y"), table(row, "theta_x"), table(row, "theta_y"),
          table(row, "theta_z")};
}

// Inputs are unit vectors to rounding; the reference normalises them exactly.
inline Vec3 DirectionOfRow(const ReferenceTable& table, std::size_t row, const std::string& name) {
  return Normalized(Vec3{table(row, name + "x"), table(row, name + "y"), table(row, name + "z")});
}

// |value - expected| <= 64 eps max(1, cond) |expected|.
inline void ExpectValue(double value, double expected, double cond, std::size_t row) {
  EXPECT_NEAR(value, expected, ValueTolerance(cond) * std::abs(expected)) << "row " << row << ", cond " << cond;
}

// Tables without a cond column: 1e-12 relative.
inline void ExpectTabulated(double value, double expected, std::size_t row, const std::string& name) {
  EXPECT_NEAR(value, expected, 1e-12 * std::abs(expected)) << name << ", row " << row;
}

// Each derivative within 1e-9 max(1, cond) of the row's largest.
inline void ExpectGradient(const double* gradient, const ReferenceTable& table, std::size_t row,
                           const std::string& prefix, const std::vector<std::string>& names, double cond) {
  double largest = 0;
  for (const std::string& name : names) largest = std::fmax(largest, std::abs(table(row, prefix + name)));
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_NEAR(gradient[k], table(row, prefix + names[k]), 1e-9 * std::fmax(1, cond) * largest)
        << prefix << names[k] << ", row " << row;
  }
}

// Entries of two gradients agree to `tolerance` of the largest entry. `value`: what they are gradients of; 8 eps
// |value| are allowed for the rounding of an oracle whose terms cancel where the value hardly depends on the parameters
// (u near n, say).
inline void ExpectSameGradient(const double* gradient, const double* expected, int count, double tolerance,
                               double value = 0) {
  double largest = 0;
  for (int k = 0; k < count; ++k) largest = std::fmax(largest, std::abs(expected[k]));
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(value);
  for (int k = 0; k < count; ++k) {
    EXPECT_NEAR(gradient[k], expected[k], tolerance * largest + rounding) << "entry " << k;
  }
}

// Random ellipsoids and directions with a fixed seed; every fourth is a hostile corner.
class ShapeGenerator {
 public:
  explicit ShapeGenerator(unsigned seed) : engine_(seed) {}

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double LogUniform(double low, double high) { return std::exp(Uniform(std::log(low), std::log(high))); }
  int Index(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }

  // alphas in [0.05, 1], tilts to 40 degrees.
  Ellipsoid Moderate() {
    return {LogUniform(0.05, 1), LogUniform(0.05, 1), Uniform(-0.6, 0.6), Uniform(-0.5, 0.5), Uniform(-kPi, kPi)};
  }
  // alphas 1e-4 to 1, tilts to 80 degrees; corners: isotropic, alpha 1, tiny or no tilt, extreme ratio.
  Ellipsoid Hostile() {
    Ellipsoid e = {LogUniform(1e-4, 1), LogUniform(1e-4, 1), Uniform(-1, 1), Uniform(-1, 1), Uniform(-kPi, kPi)};
    switch (Index(8)) {
      case 0:
        e.alpha_y = e.alpha_x;
        break;
      case 1:
        e.alpha_x = 1;
        break;
      case 2:
        e.alpha_y = 1;
        break;
      case 3:
        e.theta_x = LogUniform(1e-9, 1e-3), e.theta_y = -LogUniform(1e-9, 1e-3);
        break;
      case 4:
        e.theta_x = e.theta_y = 0;
        break;
      case 5:
        e.theta_x = std::copysign(DegreesToRadians(80), Uniform(-1, 1)), e.theta_y = 0;
        break;
      case 6:
        e.alpha_x = 1e-4, e.alpha_y = 1;
        break;
      default:
        break;
    }
    return e;
  }
  // A unit vector above the horizon: anywhere, grazing to 1e-6, or near the normal.
  Vec3 Upper() {
    const double phi = Uniform(-kPi, kPi);
    double z = Uniform(0, 1);
    if (const int corner = Index(4); corner == 0) {
      z = LogUniform(1e-6, 1e-1);
    } else if (corner == 1) {
      const double theta = LogUniform(1e-9, 1e-1);
      return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    const double r = std::sqrt((1 - z) * (1 + z));
    return Normalized(Vec3{r * std::cos(phi), r * std::sin(phi), z});
  }
  Vec3 Sphere() {
    const Vec3 u = Upper();
    return Uniform(0, 1) < 0.5 ? u : -u;
  }
  // A normal within a few alphas of the lobe of `e`.
  Vec3 NearLobe(const Ellipsoid& e) {
    const double f = LogUniform(0.05, 5), phi = Uniform(-kPi, kPi);
    const Vec3 w = {f * e.alpha_x * std::cos(phi), f * e.alpha_y * std::sin(phi), 1};
    Vec3 m = Transposed(EllipsoidRotation(e)) * w;
    if (m.z < 0) m = -m;
    return Normalized(m);
  }

 private:
  std::mt19937 engine_;
};

}  // namespace lobefit

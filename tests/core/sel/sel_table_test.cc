#include "lobefit/core/sel/sel_table.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double Uniform(std::mt19937_64& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}

SelShape RandomShape(std::mt19937_64& random) {
  SelShape shape;
  shape.alpha_x = std::exp(Uniform(random, -4, 0));
  shape.alpha_y = shape.alpha_x * std::exp(Uniform(random, -2, 0));
  shape.offset_in = Uniform(random, -0.6, 0.6);
  shape.offset_across = Uniform(random, -0.6, 0.6);
  shape.psi = Uniform(random, -kPi / 2, kPi / 2);
  return shape;
}

double* Entry(SelShape* shape, int k) {
  double* entries[] = {&shape->alpha_x, &shape->alpha_y, &shape->offset_in, &shape->offset_across, &shape->psi};
  return entries[k];
}

TEST(SelLobeInFrame, GradientAgreesWithDifferences) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 300; ++n) {
    const SelShape shape = RandomShape(random);
    const SelLobeInFrame lobe(shape);
    const double t = std::exp(Uniform(random, -2, 2)) * shape.alpha_x, a = Uniform(random, 0, 2 * kPi);
    const Vec3 v = Transposed(lobe.axes()) * Normalized(Vec3{t * std::cos(a), t * std::sin(a), 1});
    double gradient[5];
    const double k = lobe.Evaluate(v, gradient);
    EXPECT_EQ(k, lobe.Evaluate(v, nullptr));
    for (int j = 0; j < 5; ++j) {
      double h = 1e-5 * shape.alpha_y;
      if (j < 2) h = std::min(h, 0.1 * (shape.alpha_x - shape.alpha_y));
      SelShape up = shape, down = shape;
      *Entry(&up, j) += h;
      *Entry(&down, j) -= h;
      const double difference =
          (SelLobeInFrame(up).Evaluate(v, nullptr) - SelLobeInFrame(down).Evaluate(v, nullptr)) / (2 * h);
      EXPECT_NEAR(gradient[j], difference, 1e-5 * (std::fabs(difference) + 1 / shape.alpha_y)) << n << " " << j;
    }
  }
}

TEST(SelLobeInFrame, AxisLiesAtTheOffsetAndTheWideAxisAtPsi) {
  const SelShape shape = {0.3, 0.1, 0.2, -0.1, 0.7};
  const SelLobeInFrame lobe(shape);
  const double length = std::hypot(0.2, 0.1);
  const Vec3 axis = {std::sin(length) * 0.2 / length, -std::sin(length) * 0.1 / length, std::cos(length)};
  EXPECT_NEAR(lobe.Evaluate(axis, nullptr), 1, 1e-14);
  const SelLobeInFrame straight({0.3, 0.1, 0, 0, 0.7});
  const auto at = [](double azimuth) { return FromSpherical(0.2, azimuth); };
  EXPECT_NEAR(straight.Evaluate(at(0.7), nullptr), Ssl(0.3, 0.2), 1e-14);
  EXPECT_LT(straight.Evaluate(at(0.7 + kPi / 2), nullptr), straight.Evaluate(at(0.7), nullptr));
}

TEST(MirrorFrame, IsARightHandedFrameAboutTheMirrorDirection) {
  for (const double phi : {0.0, 1.0, -2.5}) {
    for (const double theta : {0.0, 1e-9, 0.5, 1.5}) {
      const Vec3 wi = FromSpherical(theta, phi);
      const Mat3 frame = MirrorFrame(wi);
      const Vec3 z = Cross(frame.row[0], frame.row[1]);
      EXPECT_NEAR(Norm(z - frame.row[2]), 0, 1e-14);
      EXPECT_NEAR(Norm(z - Vec3{-wi.x, -wi.y, wi.z}), 0, 1e-14);
      EXPECT_NEAR(frame.row[1].z, 0, 1e-14);
      EXPECT_LE(frame.row[0].z, 0);  // growing polar angle leads down
    }
  }
}

SelTable Goniometer() {
  SelTable table;
  std::mt19937_64 random(3);
  for (const double theta : {0.0, 0.5, 1.0}) {
    for (const double phi : {0.0, kPi / 2, kPi, -kPi / 2}) {
      if (theta == 0 && phi != 0) continue;
      SelSlice slice;
      slice.theta_i = theta;
      slice.phi_i = phi;
      slice.lobes = {RandomShape(random), RandomShape(random)};
      slice.amplitude = {{Uniform(random, 0, 1), 2}, {Uniform(random, 0, 1), 3}};
      slice.constant = {0.1, 0.2};
      table.slices.push_back(slice);
    }
  }
  return table;
}

// The slice by its definition.
double Defined(const SelTable& table, std::size_t s, const Vec3& wi, const Vec3& wo, std::size_t channel) {
  const SelSlice& slice = table.slices[s];
  double g = slice.constant[channel];
  for (std::size_t l = 0; l < slice.lobes.size(); ++l)
    g += slice.amplitude[l][channel] * SelLobeInFrame(slice.lobes[l]).Evaluate(MirrorFrame(wi) * wo, nullptr);
  return table.quantity == SelQuantity::kBrdf ? g : g / wo.z;
}

TEST(SelReflectance, IsTheSliceAtItsOwnDirectionAndContinuousBetween) {
  for (const SelQuantity quantity : {SelQuantity::kBrdf, SelQuantity::kBrdfCosineO}) {
    SelTable table = Goniometer();
    table.quantity = quantity;
    const SelReflectance reflectance(table);
    const Vec3 wo = FromSpherical(0.6, 2.0);
    for (std::size_t s = 0; s < table.slices.size(); ++s) {
      const double theta = table.slices[s].theta_i, phi = table.slices[s].phi_i;
      const Vec3 wi = FromSpherical(theta, phi);
      double f[2], beside[2];
      reflectance.Evaluate(wi, wo, f);
      for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(f[c], Defined(table, s, wi, wo, c), 1e-13) << s;
      for (const double step : {1e-5, -1e-5}) {
        if (theta + step > 0) {
          reflectance.Evaluate(FromSpherical(theta + step, phi), wo, beside);
          EXPECT_NEAR(beside[0], f[0], 1e-2) << s;
        }
        reflectance.Evaluate(FromSpherical(theta, phi + step), wo, beside);
        EXPECT_NEAR(beside[0], f[0], 1e-2) << s;
      }
    }
  }
}

TEST(SelReflectance, AlongTheNormalTheLobesDoNotTurnWithTheAzimuth) {
  // A hair off the normal in any direction, the lobes must point where they point at the normal.
  const SelTable table = Goniometer();
  const SelReflectance reflectance(table);
  const Vec3 wo = FromSpherical(0.4, 0.9);
  double at_normal[2], beside[2];
  reflectance.Evaluate({0, 0, 1}, wo, at_normal);
  for (const double phi : {0.3, 1.7, -2.0}) {
    reflectance.Evaluate(FromSpherical(1e-6, phi), wo, beside);
    EXPECT_NEAR(beside[0], at_normal[0], 1e-4 * at_normal[0]) << phi;
  }
}

TEST(SelReflectance, LobesOfAnIsotropicTableTurnWithTheAzimuth) {
  SelTable table = Goniometer();
  std::erase_if(table.slices, [](const SelSlice& slice) { return slice.phi_i != 0; });
  table.isotropic = true;
  const SelReflectance reflectance(table);
  for (const double theta : {0.2, 0.7, 1.2}) {
    double f[2], turned[2];
    reflectance.Evaluate(FromSpherical(theta, 0), FromSpherical(0.6, 2.0), f);
    reflectance.Evaluate(FromSpherical(theta, 1.1), FromSpherical(0.6, 3.1), turned);
    EXPECT_NEAR(f[0], turned[0], 1e-13);
  }
}

TEST(SelReflectance, IsZeroBelowTheHorizon) {
  const SelReflectance reflectance(Goniometer());
  double f[2] = {1, 1};
  reflectance.Evaluate(FromSpherical(0.3, 0), {1, 0, 0}, f);
  EXPECT_EQ(f[0], 0);
  reflectance.Evaluate({0, 1, 0}, FromSpherical(0.3, 0), f);
  EXPECT_EQ(f[1], 0);
}

}  // namespace
}  // namespace lobefit

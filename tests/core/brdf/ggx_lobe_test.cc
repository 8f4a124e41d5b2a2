// The batch kernels against the scalar functions, Jets and the ellipsoid, on every instruction set of this machine.
#include "lobefit/core/brdf/ggx_lobe.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/ndf/slope_ndf.h"

namespace lobefit {
namespace {

constexpr Masking kMaskings[] = {Masking::kSmithSeparable, Masking::kSmithUnclamped, Masking::kSmithHeight};

// Runs `body` once with the best instruction set and once with each of the others alone.
template <class Body>
void ForEachTarget(const Body& body) {
  int count = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(hwy::TargetName(target));
    body();
    ++count;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_GE(count, 1);
}

struct Samples {
  std::vector<double> wi[3], wo[3];
  std::size_t size() const { return wi[0].size(); }
  void Add(const Vec3& i, const Vec3& o) {
    const double a[3] = {i.x, i.y, i.z}, b[3] = {o.x, o.y, o.z};
    for (int k = 0; k < 3; ++k) wi[k].push_back(a[k]), wo[k].push_back(b[k]);
  }
  DirectionArrays Arrays(std::size_t count) const {
    return {wi[0].data(), wi[1].data(), wi[2].data(), wo[0].data(), wo[1].data(), wo[2].data(), count};
  }
  VectorArrays Wi(std::size_t count) const { return {wi[0].data(), wi[1].data(), wi[2].data(), count}; }
  Vec3 I(std::size_t k) const { return {wi[0][k], wi[1][k], wi[2][k]}; }
  Vec3 O(std::size_t k) const { return {wo[0][k], wo[1][k], wo[2][k]}; }
};

// Upper directions: anywhere, at a grazing 1e-6, near the normal, wi = wo, and mirrored about a normal of the lobe.
Samples HostileSamples(const Ellipsoid& e, ShapeGenerator* random, int count) {
  Samples samples;
  for (int k = 0; k < count; ++k) {
    const Vec3 wi = random->Upper();
    Vec3 wo = k % 5 == 0 ? wi : random->Upper();
    if (k % 5 == 1) {
      const Vec3 m = random->NearLobe(e);
      const Vec3 mirrored = (2 * Dot(wi, m)) * m - wi;
      if (mirrored.z > 1e-6) wo = Normalized(mirrored);
    }
    samples.Add(wi, wo);
  }
  return samples;
}

bool SameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(GgxLobeArrays, HaveTheBitsOfTheScalarPathOnEveryTarget) {
  ForEachTarget([] {
    ShapeGenerator random(7);
    for (int trial = 0; trial < 60; ++trial) {
      const Ellipsoid e = random.Hostile();
      const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
      const Samples samples = HostileSamples(e, &random, 17);
      // 17 is no multiple of any vector; shorter tails come in turn.
      const std::size_t count = static_cast<std::size_t>(trial % 18);
      for (const Masking masking : kMaskings) {
        std::vector<double> specular(count + 1, -7), cos_d(count + 1, -7), gradient(5 * count + 1, -7),
            alone(count + 1);
        GgxLobe(samples.Arrays(count), shape, masking, specular.data(), cos_d.data(), gradient.data());
        GgxLobe(samples.Arrays(count), shape, masking, alone.data(), cos_d.data(), nullptr);
        for (std::size_t k = 0; k < count; ++k) {
          double g[5], c = 0;
          const double value = GgxLobe(samples.I(k), samples.O(k), shape, masking, &c, g);
          EXPECT_TRUE(SameBits(value, specular[k])) << value << " " << specular[k];
          EXPECT_TRUE(SameBits(value, alone[k])) << "without gradient";
          EXPECT_TRUE(SameBits(c, cos_d[k]));
          for (std::size_t j = 0; j < 5; ++j) EXPECT_TRUE(SameBits(g[j], gradient[j * count + k])) << "entry " << j;
        }
        // Nothing is written behind the arrays.
        EXPECT_EQ(specular[count], -7);
        EXPECT_EQ(cos_d[count], -7);
        EXPECT_EQ(gradient[5 * count], -7);
      }
    }
  });
}

TEST(GgxFactorArrays, HaveTheBitsOfTheScalarPathOnEveryTarget) {
  ForEachTarget([] {
    ShapeGenerator random(8);
    for (int trial = 0; trial < 60; ++trial) {
      const Ellipsoid e = random.Hostile();
      const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
      const Samples samples = HostileSamples(e, &random, 17);
      const std::size_t count = static_cast<std::size_t>(trial % 18);
      std::vector<double> value(count + 1, -7), alone(count + 1), gradient(5 * count + 1, -7);
      const auto compare = [&](const auto& arrays, const auto& one) {
        arrays(value.data(), gradient.data());
        arrays(alone.data(), nullptr);
        for (std::size_t k = 0; k < count; ++k) {
          double g[5];
          const double expected = one(samples.I(k), g);
          EXPECT_TRUE(SameBits(expected, value[k]) && SameBits(expected, alone[k]));
          EXPECT_TRUE(SameBits(expected, one(samples.I(k), nullptr)));
          for (std::size_t j = 0; j < 5; ++j) EXPECT_TRUE(SameBits(g[j], gradient[j * count + k])) << "entry " << j;
        }
        EXPECT_EQ(value[count], -7);
        EXPECT_EQ(gradient[5 * count], -7);
      };
      compare([&](double* v, double* g) { GgxD(samples.Wi(count), shape, v, g); },
              [&](const Vec3& m, double* g) { return GgxD(m, shape, g); });
      for (const bool clamp : {true, false}) {
        compare([&](double* v, double* g) { GgxG1(samples.Wi(count), shape, clamp, v, g); },
                [&](const Vec3& u, double* g) { return GgxG1(u, shape, clamp, g); });
      }
    }
  });
}

// The definitions in slope space (slope_ndf.h) with Jets in the five coordinates.
using LobeJet = ceres::Jet<double, 5>;

LobeJet SpecularFormula(const LobeJet* v, const Vec3& wi, const Vec3& wo, Masking masking) {
  const auto constant = [](const Vec3& w) { return Vec3T<LobeJet>{LobeJet(w.x), LobeJet(w.y), LobeJet(w.z)}; };
  LobeJet xi = SlopeSigmaFormula(v, constant(wi)), xo = SlopeSigmaFormula(v, constant(wo));
  if (masking != Masking::kSmithUnclamped && xi < wi.z) xi = LobeJet(wi.z);
  if (masking != Masking::kSmithUnclamped && xo < wo.z) xo = LobeJet(wo.z);
  const LobeJet both = masking == Masking::kSmithHeight ? xi * wo.z + (xo - wo.z) * wi.z : xi * xo;
  return SlopeDFormula(v, constant(Normalized(wi + wo))) / (4.0 * both);
}

TEST(GgxLobe, AgreesWithJets) {
  ShapeGenerator random(9);
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Ellipsoid e = random.Hostile();
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
    LobeJet v[5];
    for (int j = 0; j < 5; ++j) v[j] = LobeJet(shape.v[j], j);
    const Samples samples = HostileSamples(e, &random, 10);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Vec3 wi = samples.I(k), wo = samples.O(k);
      // Half vectors across which the lobe changes by orders within the rounding of wh are no fair comparison: the
      // oracle's own wh is off by an ulp.
      const double steep = 1 / (std::fmin(e.alpha_x, e.alpha_y) * std::cos(e.theta_x) * std::cos(e.theta_y));
      const double rounding = 64 * 2.2e-16 * steep * steep;
      if (rounding > 1e-6) continue;
      for (const Masking masking : kMaskings) {
        double g[5], cos_d = 0;
        const double value = GgxLobe(wi, wo, shape, masking, &cos_d, g);
        const LobeJet expected = SpecularFormula(v, wi, wo, masking);
        EXPECT_NEAR(value, expected.a, (1e-12 + rounding) * expected.a);
        ExpectSameGradient(g, expected.v.data(), 5, 1e-10 + rounding, value);
        // The oracle's wi + wo cancels where the two are nearly opposite.
        EXPECT_NEAR(cos_d, Dot(wi, Normalized(wi + wo)), 1e-15 / cos_d);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(GgxFactors, AgreeWithJetsAndTheEllipsoid) {
  ShapeGenerator random(10);
  for (int trial = 0; trial < 2000; ++trial) {
    const Ellipsoid e = random.Moderate();
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
    LobeJet v[5];
    for (int j = 0; j < 5; ++j) v[j] = LobeJet(shape.v[j], j);
    const Vec3 m = trial % 2 == 0 ? random.NearLobe(e) : random.Upper(), u = random.Upper();
    double g[5];
    const double d = GgxD(m, shape, g);
    const LobeJet jet_d = SlopeDFormula(v, {LobeJet(m.x), LobeJet(m.y), LobeJet(m.z)});
    EXPECT_NEAR(d, jet_d.a, 1e-12 * d);
    ExpectSameGradient(g, jet_d.v.data(), 5, 1e-10, d);
    EXPECT_NEAR(d, EllipsoidD(e, m), 1e-11 * d);
    const double g1 = GgxG1(u, shape, false, g);
    const LobeJet jet_g = LobeJet(u.z) / SlopeSigmaFormula(v, {LobeJet(u.x), LobeJet(u.y), LobeJet(u.z)});
    EXPECT_NEAR(g1, jet_g.a, 1e-12 * g1);
    ExpectSameGradient(g, jet_g.v.data(), 5, 1e-10, g1);
    EXPECT_NEAR(g1, EllipsoidG1Unclamped(e, u), 1e-11 * g1);
    const double clamped = GgxG1(u, shape, true, g);
    EXPECT_EQ(clamped, std::fmin(1, g1));
    if (g1 > 1) {
      for (const double entry : g) EXPECT_EQ(entry, 0);
    }
  }
}

TEST(GgxD, IsZeroBelowTheHorizon) {
  const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({0.2, 0.4, 0.1, 0.2, 0.3});
  double g[5];
  EXPECT_EQ(GgxD({0.6, 0, -0.8}, shape, g), 0);
  for (const double entry : g) EXPECT_EQ(entry, 0);
}

// The lobe is D G1 G1 / (4 cos cos) of the ellipsoid it came from, 4 cos^2 in the denominator included.
TEST(GgxLobe, IsTheEllipsoidsBrdf) {
  ShapeGenerator random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    const Ellipsoid e = random.Moderate();
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
    const Vec3 wi = random.Upper(), wo = random.Upper();
    const double d = EllipsoidD(e, Normalized(wi + wo));
    double cos_d = 0;
    const double clamped = d * EllipsoidG1(e, wi) * EllipsoidG1(e, wo) / (4 * wi.z * wo.z);
    EXPECT_NEAR(GgxLobe(wi, wo, shape, Masking::kSmithSeparable, &cos_d, nullptr), clamped, 1e-10 * clamped);
    const double free = d / (4 * EllipsoidSigma(e, wi) * EllipsoidSigma(e, wo));
    EXPECT_NEAR(GgxLobe(wi, wo, shape, Masking::kSmithUnclamped, &cos_d, nullptr), free, 1e-10 * free);
    // Reciprocal to the rounding of sums in the other order.
    const double height = GgxLobe(wi, wo, shape, Masking::kSmithHeight, &cos_d, nullptr);
    EXPECT_NEAR(GgxLobe(wo, wi, shape, Masking::kSmithHeight, &cos_d, nullptr), height, 1e-13 * height);
  }
}

}  // namespace
}  // namespace lobefit

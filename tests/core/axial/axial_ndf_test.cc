#include "lobefit/core/axial/axial_ndf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

std::vector<AxialNdf> Distributions() {
  std::vector<AxialNdf> all;
  for (const double alpha : {1e-3, 0.03, 0.28, 0.32, 1.0, 4.0}) {
    all.push_back({Family::kSphericalGaussian, alpha});
    all.push_back({Family::kBeckmann, alpha});
    all.push_back({Family::kGgx, alpha});
  }
  for (const double b : {1e-3, 0.3, 0.49, 0.51, 0.97, 1 - 1e-6}) all.push_back({Family::kKagiwadaKalaba, b});
  return all;
}

// Integral over the cosine range [0, 1] (up) or [-1, 0] of D times 2 pi times weight(cos).
template <class F>
double OverNormals(const AxialNdf& ndf, bool up, const F& weight) {
  std::vector<double> breaks = {0};
  for (double d = 1e-8; d < 1; d *= 3) breaks.push_back(d);
  breaks.push_back(1);
  const auto f = [&](double d) {
    const double s = std::sqrt(d * (2 - d)), c = up ? 1 - d : d - 1;
    return std::array<double, 1>{2 * kPi * AxialD(ndf, {s, 0, c}) * weight(c)};
  };
  return IntegrateAdaptive<1>(f, breaks, {1e-11, 0, 2000}).value[0];
}

TEST(AxialNdf, IsNormalisedByProjectedArea) {
  for (const AxialNdf& ndf : Distributions()) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(ndf.family) << " " << ndf.parameter);
    EXPECT_NEAR(OverNormals(ndf, true, [](double c) { return c; }), 1, 1e-9);
    // The normalisation, and its derivative: none.
    AxialGradient g;
    EXPECT_NEAR(AxialSigma(ndf, 1, &g), 1, 1e-13);
    EXPECT_NEAR(g.dparameter * ndf.parameter, 0, 1e-9);
    // The factor is that by which the unit-integral form was multiplied.
    const double total =
        OverNormals(ndf, true, [](double) { return 1; }) + OverNormals(ndf, false, [](double) { return 1; });
    if (ndf.family == Family::kKagiwadaKalaba || ndf.family == Family::kSphericalGaussian) {
      EXPECT_NEAR(AxialNormalisation(ndf), total, 1e-9 * total);
    } else {
      EXPECT_EQ(AxialNormalisation(ndf), 1);
      EXPECT_EQ(AxialD(ndf, FromSpherical(1.7, 0)), 0);
    }
  }
}

TEST(AxialNdf, SigmaIsTheIntegralOfD) {
  // Not through the ring: a two-dimensional integral over the normals in spherical coordinates about n.
  for (const AxialNdf& ndf : Distributions()) {
    if (ndf.parameter < 0.02 || ndf.parameter > 0.99) continue;
    SCOPED_TRACE(testing::Message() << static_cast<int>(ndf.family) << " " << ndf.parameter);
    for (const double u : {0.9, 0.2, -0.6}) {
      const double s = std::sqrt(1 - u * u);
      const auto weight = [&](double c) {
        const double sin_m = std::sqrt((1 - c) * (1 + c));
        const QuadratureResult<1> around = IntegrateAdaptive<1>(
            [&](double phi) { return std::array<double, 1>{std::fmax(0.0, u * c + s * sin_m * std::cos(phi))}; },
            {0, std::acos(std::clamp(-u * c / (s * sin_m + 1e-300), -1.0, 1.0)), kPi}, {1e-10, 1e-14, 200});
        return around.value[0] / kPi;
      };
      const double sigma = OverNormals(ndf, true, weight) + OverNormals(ndf, false, weight);
      EXPECT_NEAR(AxialSigma(ndf, u), sigma, 1e-7 * sigma + 1e-10) << u;
    }
  }
}

TEST(AxialNdf, DerivativesByDifferences) {
  for (const AxialNdf& ndf : Distributions()) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(ndf.family) << " " << ndf.parameter);
    const bool kk = ndf.family == Family::kKagiwadaKalaba;
    const double step = 1e-5 * (kk ? std::fmin(ndf.parameter, 1 - ndf.parameter) : ndf.parameter);
    const AxialNdf more = {ndf.family, ndf.parameter + step}, less = {ndf.family, ndf.parameter - step};
    const double h = 0.5 * (more.parameter - less.parameter);  // as rounded
    const double width = kk ? std::sqrt(2 * (1 - ndf.parameter) / ndf.parameter) : ndf.parameter;
    double slope = 0;
    AxialNormalisation(ndf, &slope);
    EXPECT_NEAR((AxialNormalisation(more) - AxialNormalisation(less)) / (2 * h), slope,
                1e-7 * std::fabs(slope) + 1e-15 * AxialNormalisation(ndf) / h);
    for (const double t : {0.05, 0.6, 1.7, 2.9}) {
      const double theta = std::fmin(t * width, 0.9 * t);
      const Vec3 m = FromSpherical(theta, 0.4);
      AxialGradient g;
      const double d = AxialD(ndf, m, &g);
      EXPECT_EQ(AxialD(ndf, m), d);
      if (d < 1e-30) continue;
      EXPECT_NEAR((AxialD(more, m) - AxialD(less, m)) / (2 * h), g.dparameter,
                  2e-6 * (std::fabs(g.dparameter) + d / ndf.parameter));
      const double e = 1e-6 * std::fmin(theta, 1);
      const double dtheta =
          (AxialD(ndf, FromSpherical(theta + e, 0.4)) - AxialD(ndf, FromSpherical(theta - e, 0.4))) / (2 * e);
      EXPECT_NEAR(dtheta, -std::sin(theta) * g.dcos, 2e-6 * (std::fabs(dtheta) + d / theta));
    }
    for (const double u : {1e-4, 0.05, 0.5, 0.95}) {
      AxialGradient g;
      const double g1 = AxialG1(ndf, u, &g);
      EXPECT_EQ(AxialG1(ndf, u), g1);
      EXPECT_GT(g1, 0);
      EXPECT_LE(g1, 1 + 4e-15);
      const double hu = 1e-6 * u;
      EXPECT_NEAR((AxialG1(ndf, u + hu) - AxialG1(ndf, u - hu)) / (2 * hu), g.dcos, 1e-7 * (std::fabs(g.dcos) + 1 / u));
      EXPECT_NEAR((AxialG1(more, u) - AxialG1(less, u)) / (2 * h), g.dparameter,
                  1e-6 * (std::fabs(g.dparameter) + 1e-3 / ndf.parameter));
    }
  }
}

TEST(AxialNdf, GradientOfDEqualsJets) {
  using Jet = ceres::Jet<double, 2>;
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i) {
    const double p = 0.05 + 0.9 * unit(random), theta = 1.5 * unit(random), c = std::cos(theta);
    const Jet q(p, 0), x(c, 1);
    const Jet k = 2.0 / (q * q);
    const Jet l = log((1.0 + q) / (1.0 - q));
    const Jet kk = q / ((1.0 - q * x) * l * 2.0 * kPi) * (q * l / (-q - log(1.0 - q)));
    const Jet sg = k * exp(k * (x - 1.0)) / (2.0 * kPi) * k / (k - 1.0 + exp(-k));
    const Jet tan2 = 1.0 / (x * x) - 1.0;
    const Jet beckmann = exp(-tan2 / (q * q)) / (kPi * q * q * x * x * x * x);
    const Jet den = q * q * x * x + 1.0 - x * x;
    const Jet ggx = q * q / (kPi * den * den);
    const std::pair<Family, Jet> cases[] = {{Family::kKagiwadaKalaba, kk},
                                            {Family::kSphericalGaussian, sg},
                                            {Family::kBeckmann, beckmann},
                                            {Family::kGgx, ggx}};
    for (const auto& [family, jet] : cases) {
      if (jet.a < 1e-280) continue;
      AxialGradient g;
      const double d = AxialD({family, p}, FromSpherical(theta, 0.3), &g);
      // cos(theta) carries one rounding into the definition: cond of D with respect to it is |c dD/dc / D|.
      const double tolerance = 1e-13 * (1 + std::fabs(c * jet.v[1] / jet.a)) + 1e-12;
      EXPECT_NEAR(d, jet.a, tolerance * jet.a) << static_cast<int>(family);
      EXPECT_NEAR(g.dparameter, jet.v[0], 1e-10 * jet.v.norm() + tolerance * std::fabs(jet.v[0]));
      EXPECT_NEAR(g.dcos, jet.v[1], 1e-10 * jet.v.norm() + tolerance * std::fabs(jet.v[1]));
    }
  }
}

// Masked visible normals account for the whole projected area: int G1 D (m.w)+ dm = cos [dEon eq 2 divided by sigma;
// Heitz eq 14].
TEST(AxialNdf, MaskingLaw) {
  for (const AxialNdf& ndf : Distributions()) {
    for (const double u : {1e-6, 0.3, 0.8, 1.0}) EXPECT_NEAR(AxialG1(ndf, u) * AxialSigma(ndf, u), u, 1e-15);
    // Back faces: sigma(u) - sigma(-u) = u int D (m.n) dm, 1 less the share of the normals that face down.
    const double down = OverNormals(ndf, false, [](double c) { return -c; });
    EXPECT_NEAR(AxialSigma(ndf, 0.4) - AxialSigma(ndf, -0.4), 0.4 * (1 - down), 1e-9);
  }
}

TEST(AxialNdf, GrazingNormalsAreFinite) {
  for (const AxialNdf& ndf : Distributions()) {
    for (const double z : {1e-6, 1e-160, 1e-320, 0.0, -1e-320, -1.0}) {
      AxialGradient g;
      const double d = AxialD(ndf, {std::sqrt((1 - z) * (1 + z)), 0, z}, &g);
      EXPECT_TRUE(std::isfinite(d) && std::isfinite(g.dparameter) && std::isfinite(g.dcos))
          << ndf.parameter << " " << z;
      EXPECT_GE(d, 0);
    }
  }
}

TEST(AxialNdf, FamiliesMeetInTheirLimits) {
  // The spherical Gaussian tends to Beckmann for small alpha; both whole-sphere families to the isotropic one, sigma =
  // 1, D = 1 / pi.
  EXPECT_NEAR(AxialD({Family::kSphericalGaussian, 0.01}, FromSpherical(0.01, 0)) /
                  AxialD({Family::kBeckmann, 0.01}, FromSpherical(0.01, 0)),
              1, 1e-3);
  const Vec3 m = FromSpherical(2, 1);
  EXPECT_NEAR(AxialD({Family::kSphericalGaussian, 1e4}, m), kInvPi, 1e-7);
  EXPECT_NEAR(AxialD({Family::kKagiwadaKalaba, 1e-8}, m), kInvPi, 1e-7);
  EXPECT_NEAR(AxialSigma({Family::kKagiwadaKalaba, 1e-8}, -0.7), 1, 1e-7);
}

}  // namespace
}  // namespace lobefit

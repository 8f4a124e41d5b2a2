// A crooked sample, gains, quadrature of the means, and the stabilising transform, against their tables and by what
// defines them.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/core/instrument/asinh_residual.h"
#include "lobefit/core/instrument/ellipsoid_means.h"
#include "lobefit/core/instrument/gain.h"
#include "lobefit/core/instrument/misalignment.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

TEST(Misalignment, TurnsDirectionsBack) {
  const Misalignment e = {0.1, -0.2, 0.3};
  const Vec3 w = Normalized(Vec3{0.3, -0.4, 0.8});
  const Vec3 turned = RotateX(RotateY(RotateZ(w, -e.e_z), -e.e_y), -e.e_x), found = InSampleFrame(e, w);
  EXPECT_NEAR(Norm(found - turned), 0, 1e-15);
  EXPECT_EQ(Norm(InSampleFrame(Misalignment{0, 0, 0}, w) - w), 0);
}

TEST(Misalignment, AxesAreTheDerivatives) {
  using Jet = ceres::Jet<double, 3>;
  const Misalignment e = {0.1, -0.2, 0.3};
  const Vec3 w = Normalized(Vec3{0.3, -0.4, 0.8}), turned = InSampleFrame(e, w);
  const Vec3T<Jet> jet = InSampleFrame(MisalignmentT<Jet>{Jet(e.e_x, 0), Jet(e.e_y, 1), Jet(e.e_z, 2)},
                                       Vec3T<Jet>{Jet(w.x), Jet(w.y), Jet(w.z)});
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 expected = -Cross(MisalignmentAxes(e)[k], turned);
    const int at = static_cast<int>(k);
    EXPECT_NEAR(jet.x.v[at], expected.x, 1e-15);
    EXPECT_NEAR(jet.y.v[at], expected.y, 1e-15);
    EXPECT_NEAR(jet.z.v[at], expected.z, 1e-15);
  }
}

// Turning the sample about its normal and turning the lobe are one motion.
TEST(Misalignment, TurnAboutTheNormalIsTheLobesTurn) {
  const Vec3 wi = Normalized(Vec3{0.3, 0.1, 0.9}), wo = Normalized(Vec3{-0.4, 0.2, 0.8});
  const Ellipsoid e = {0.3, 0.1, 0.05, -0.04, 0.4};
  Ellipsoid turned = e;
  turned.theta_z -= 0.2;
  const double a = MisalignedConductorBrdf(e, {0.2, 3}, wo, wi, {0, 0, 0.2}, ValueKind::kBrdf, nullptr);
  const double b = EllipsoidConductorBrdf(turned, {0.2, 3}, wo, wi, Masking::kSmithSeparable);
  EXPECT_NEAR(a, b, 1e-13 * b);
}

TEST(Misalignment, BelowTheSamplesHorizonIsZero) {
  double gradient[8];
  EXPECT_EQ(MisalignedConductorBrdf({0.3, 0.3, 0, 0, 0}, {0.2, 3}, Normalized(Vec3{0, 0.99, 0.02}), {0, 0, 1},
                                    {0.1, 0, 0}, ValueKind::kFlux, gradient),
            0);
  for (const double d : gradient) EXPECT_EQ(d, 0);
}

// A minimum over g: no other gain does better, and the gradient is that of the minimum.
template <class Profile>
void ExpectMinimum(const Profile& profile) {
  const double f[4] = {0.1, 1, 5, 0.02};
  double by_f[4];
  const ProfiledGain<double> best = profile(f, by_f);
  for (int k = 0; k < 4; ++k) {
    double low[4], high[4];
    std::copy(f, f + 4, low);
    std::copy(f, f + 4, high);
    const double step = 1e-6 * f[k];
    low[k] -= step, high[k] += step;
    EXPECT_NEAR(by_f[k], (profile(high, nullptr).cost - profile(low, nullptr).cost) / (2 * step),
                1e-5 * std::fabs(by_f[k]) + 1e-4 * best.cost);
  }
}

TEST(Gain, GradientIsThatOfTheMinimum) {
  const double y[4] = {0.12, 1.1, 5.3, -0.01}, sd[4] = {0.02, 0.1, 0.3, 0.02};
  ExpectMinimum([&](const double* f, double* d) { return ProfileLinearGain(f, y, sd, 4, 0.1, d); });
  ExpectMinimum([&](const double* f, double* d) { return ProfileAsinhGain(f, y, 4, 0.2, 0.05, 0.1, d); });
}

TEST(Gain, PriorHoldsOrLetsGo) {
  const double f[2] = {1, 2}, y[2] = {1.1, 2.2}, sd[2] = {0.01, 0.01};
  EXPECT_NEAR(ProfileLinearGain(f, y, sd, 2, 1e6, static_cast<double*>(nullptr)).gain, 1.1, 1e-9);
  EXPECT_NEAR(ProfileLinearGain(f, y, sd, 2, 1e-6, static_cast<double*>(nullptr)).gain, 1, 1e-6);
  EXPECT_NEAR(std::exp(ProfileAsinhGain(f, y, 2, 0.001, 0.05, 1e3, static_cast<double*>(nullptr)).gain), 1.1, 1e-6);
  EXPECT_NEAR(ProfileAsinhGain(f, y, 2, 0.001, 0.05, 1e-6, static_cast<double*>(nullptr)).gain, 0, 1e-6);
}

// Noise of the stated size has the standard deviation rho in asinh, and the corrected residual the mean 0, at any
// level: by quadrature over the normal distribution.
TEST(AsinhResidual, StabilisesTheNoise) {
  const NoiseModel noise = {0.01, 0.05};
  for (const double v : {0.0, 0.05, 0.2, 1.0, 50.0}) {
    double mean = 0, square = 0, corrected = 0, total = 0;
    for (int k = -400; k <= 400; ++k) {
      const double z = 0.02 * k, weight = std::exp(-0.5 * z * z);
      const AsinhResidual<double> r = EvaluateAsinhResidual(noise, v, v + z * noise.Deviation(v));
      total += weight;
      mean += weight * r.residual;
      square += weight * r.residual * r.residual;
      corrected += weight * r.corrected;
    }
    mean /= total, square /= total, corrected /= total;
    EXPECT_NEAR(std::sqrt(square - mean * mean), noise.relative, 0.01 * noise.relative) << v;
    EXPECT_NEAR(corrected, 0, 0.02 * noise.relative * noise.relative) << v;
  }
}

TEST(QuadratureMeans, OfAPointAreTheValues) {
  const Ellipsoid e = {0.2, 0.1, 0.05, 0.02, 0.3};
  const Vec3 wi = Normalized(Vec3{0.4, 0.1, 0.8}), wo = Normalized(Vec3{-0.5, -0.1, 0.8});
  const EllipsoidMeans m = QuadratureMeans(e, {0.2, 3}, wo, wi, {});
  EXPECT_EQ(m.D.value, EllipsoidD(e, Normalized(wo + wi)));
  EXPECT_EQ(m.fr.value, EllipsoidConductorBrdf(e, {0.2, 3}, wo, wi, Masking::kSmithSeparable));
  EXPECT_NEAR(m.flux.value, m.fr.value, 1e-15 * m.fr.value);
}

// Where the masking of a tilted lobe is clamped on part of the disc only, what is summed has a kink: without a split
// along it derivatives were off by up to 8e-5.
TEST(QuadratureMeans, DerivativesHoldAcrossTheEndOfTheClamp) {
  const ConductorIndex index = {0.2, 3};
  const Aperture aperture = {0, 0.06};
  std::mt19937_64 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int tried = 0;
  for (int trial = 0; trial < 4000 && tried < 5; ++trial) {
    double p[5] = {uniform(0.1, 0.5), uniform(0.1, 0.5), uniform(-0.15, 0.15), uniform(-0.15, 0.15), uniform(-1, 1)};
    const double theta = uniform(0.2, 1.3), phi = uniform(-kPi, kPi), beside = uniform(-0.3, 0.3);
    const Vec3 wo = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const double theta_i = uniform(0.2, 1.2), phi_i = phi + kPi + beside;
    const Vec3 wi = {std::sin(theta_i) * std::cos(phi_i), std::sin(theta_i) * std::sin(phi_i), std::cos(theta_i)};
    const auto ellipsoid = [&] { return Ellipsoid{p[0], p[1], p[2], p[3], p[4]}; };
    const Vec3 across = Normalized(Cross(Vec3{0, 0, 1}, wo)), along = Cross(across, wo);
    int clamped = 0;
    for (int k = 0; k < 24; ++k) {
      const double psi = k * kPi / 12, c = std::cos(0.06), s = std::sin(0.06);
      BrdfFactors factors;
      EllipsoidConductorBrdf(ellipsoid(), index, c * wo + s * std::cos(psi) * along + s * std::sin(psi) * across, wi,
                             Masking::kSmithSeparable, nullptr, &factors);
      clamped += factors.clamped_o ? 1 : 0;
    }
    if (clamped < 4 || clamped > 20) continue;
    ++tried;
    const EllipsoidMeans means = QuadratureMeans(ellipsoid(), index, wo, wi, aperture);
    double largest = 0;
    for (const double g : means.fr.gradient) largest = std::max(largest, std::fabs(g));
    for (int j = 0; j < 5; ++j) {
      const double step = 1e-5, kept = p[j];
      p[j] = kept + step;
      const double above = QuadratureMeans(ellipsoid(), index, wo, wi, aperture).fr.value;
      p[j] = kept - step;
      const double below = QuadratureMeans(ellipsoid(), index, wo, wi, aperture).fr.value;
      p[j] = kept;
      EXPECT_NEAR(means.fr.gradient[j], (above - below) / (2 * step), 3e-7 * largest) << trial << " " << j;
    }
  }
  EXPECT_EQ(tried, 5);
}

// A lobe that is nearly a mirror under a wide disc: all of it is seen, so that the flux is F / (2 pi tau cos).
TEST(QuadratureMeans, MirrorUnderAWideDisc) {
  const Vec3 wi = Normalized(Vec3{0.3, 0, 1}), wo = {-wi.x, 0, wi.z};
  const double half_angle = 0.05;
  const EllipsoidMeans m = QuadratureMeans({1e-5, 1e-5, 0, 0, 0}, {0.2, 3}, wo, wi, {0, half_angle});
  const double expected = FresnelConductor(wi.z, {0.2, 3}) / (2 * kPi * DiscTau(half_angle) * wi.z);
  EXPECT_NEAR(m.flux.value * (1 - 0.5 * DiscTau(half_angle)), expected, 1e-6 * expected);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/core/radial/profile.h"

#include <cmath>
#include <memory>
#include <vector>

#include "tests/support/differences.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/ndf/shape_invariant.h"
#include "lobefit/core/ndf/student.h"
#include "lobefit/core/radial/profile_masking.h"
#include "lobefit/core/radial/smith.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

using Spline = std::shared_ptr<const ProfileSpline>;

Spline SplineOf(std::vector<double> knots) { return std::make_shared<const ProfileSpline>(std::move(knots)); }

const std::shared_ptr<const ProfileGrid>& Grid() {
  static const auto grid = std::make_shared<const ProfileGrid>(SplineOf({0, 1, 2, 4, 8, 16, 32}));
  return grid;
}
const std::shared_ptr<const ProfileGrid>& ShortGrid() {
  static const auto grid = std::make_shared<const ProfileGrid>(SplineOf({0, 0.25, 0.5, 0.75, 1, 1.5, 2}));
  return grid;
}

// Generic, flat-topped, core and pedestal, steep, and with the heaviest tail of a fit.
std::vector<std::vector<double>> Coefficients() {
  return {{0, 0, 0, 0, 0, 0},        {0.4, -0.3, 0.2, 0.5, -0.4, 0.3},
          {-2, 0.8, 0.1, 0.1, 0, 0}, {-1, 3, -2.5, 0.3, -0.5, 0.2},
          {-0.6, 2, 4, 6, 9, 12},    {0.1, -0.7, -0.4, 0.2, -0.3, -0.45}};
}

SlopeDistribution RandomSlopes(ShapeGenerator* random) {
  return {Family::kGgx,
          random->LogUniform(0.02, 1),
          random->LogUniform(0.02, 1),
          random->Uniform(-0.8, 0.8),
          random->Uniform(-0.5, 0.5),
          random->Uniform(-0.5, 0.5)};
}

Vec3 UpperWithHorizon(ShapeGenerator* random) {
  const Vec3 u = random->Sphere();
  return {u.x, u.y, std::abs(u.z)};
}

TEST(ProfileSpline, PinsTheQuarter) {
  for (const auto& knots :
       {std::vector<double>{0, 1}, {0, 1, 2, 4}, {0, 0.25, 0.5, 0.75, 1, 1.5, 2}, {0, 0.5, 1, 2, 64}}) {
    const ProfileSpline spline(knots);
    std::vector<double> basis(spline.size()), slope(spline.size());
    ASSERT_EQ(spline.size(), knots.size() - 1);
    spline.Evaluate(std::log(2.0), basis.data());
    for (const double b : basis) EXPECT_NEAR(b, 0, 1e-16);
    spline.Evaluate(0, basis.data());
    for (const double b : basis) EXPECT_EQ(b, 0);
    for (const double u : {0.1, 0.5, 0.9, 2.5, 9.5}) {
      spline.Evaluate(u, basis.data(), slope.data());
      for (std::size_t k = 0; k < spline.size(); ++k) {
        const auto b = [&](double x) {
          std::vector<double> values(spline.size());
          spline.Evaluate(x, values.data());
          return values[k];
        };
        EXPECT_NEAR(slope[k], Difference(b, u, 1e-3), 1e-9) << u;
      }
    }
  }
}

// The tail's exponent is the last coefficient plus 2; the others do not act there.
TEST(ProfileSpline, TailIsAPower) {
  const ProfileSpline spline({0, 1, 2, 4});
  double slope[3], basis[3];
  spline.Evaluate(4, basis, slope);
  EXPECT_EQ(slope[0], 0);
  EXPECT_EQ(slope[1], 0);
  EXPECT_EQ(slope[2], -1);
  EXPECT_EQ(spline.FirstRadius(0), 0);
  EXPECT_EQ(spline.FirstRadius(1), 0);
  EXPECT_EQ(spline.FirstRadius(2), 1);
}

TEST(ProfileSpline, RefusesKnots) {
  for (const auto& knots : {std::vector<double>{0}, {1, 2}, {0, 2, 4}, {0, 1, 1}, {0, 2, 1}, {0, 1, HUGE_VAL}})
    EXPECT_THROW(ProfileSpline{knots}, InputError);
  EXPECT_THROW(Profile(SplineOf({0, 1, 2}), {0.1}), InputError);
  EXPECT_THROW(Profile(SplineOf({0, 1, 2}), {0.1, NAN}), InputError);
  EXPECT_THROW(Profile(SplineOf({0, 1, 2}), {0.1, -0.5}), InputError);
  EXPECT_NO_THROW(Profile(SplineOf({0, 1, 2}), {0.1, -0.49}));
}

TEST(Profile, IsNormalised) {
  for (const auto& q : Coefficients()) {
    const Profile profile(Grid()->spline(), q);
    const auto f = [&](double u) { return std::exp(profile.Excess(u) - u); };
    QuadratureOptions fine;
    fine.relative = 1e-13;
    std::vector<double> breaks;
    for (const double r : Grid()->spline()->knots()) breaks.push_back(std::log1p(r * r));
    breaks.push_back(breaks.back() + 60 / (1 + q.back()));
    const auto integral = [&](double from) {
      std::vector<double> ends = {from};
      for (const double x : breaks) {
        if (x > from) ends.push_back(x);
      }
      return IntegrateAdaptive<1>([&](double u) { return std::array<double, 1>{f(u)}; }, ends, fine).value[0];
    };
    const double mass = integral(0);
    EXPECT_NEAR(1 + profile.mass_excess(), mass, 1e-13 * mass);
    for (const double r : {0.5, 3.0, 32.0, 100.0}) {
      EXPECT_NEAR(profile.MassBeyond(r), integral(std::log1p(r * r)) / mass, 1e-12) << r;
    }
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto log_mass = [&](double x) {
        std::vector<double> changed = q;
        changed[k] = x;
        return std::log1p(Profile(Grid()->spline(), changed).mass_excess());
      };
      const double step = k + 1 == q.size() ? 1e-3 : 5e-3;  // q_K may stand at -.45
      EXPECT_NEAR(profile.dlog_mass()[k], Difference(log_mass, q[k], step), 1e-9) << k;
    }
  }
}

TEST(ProfileLaws, ZeroIsGgxToTheBit) {
  const auto masking =
      std::make_shared<const ProfileMasking>(Grid(), Profile(Grid()->spline(), std::vector<double>(6, 0.0)));
  ShapeGenerator random(301);
  for (int i = 0; i < 500; ++i) {
    const SlopeDistribution slopes = RandomSlopes(&random);
    const ShapeInvariantDistribution profile(masking, slopes);
    const SlopeNormalDistribution ggx(slopes);
    const Vec3 u = i % 2 == 0 ? random.Sphere() : UpperWithHorizon(&random);
    double a[11], b[5];
    EXPECT_EQ(profile.D(u, a), ggx.D(u, b));
    ExpectSameGradient(a, b, 5, 1e-15);
    EXPECT_EQ(profile.Sigma(u, a), ggx.Sigma(u, b));
    for (int k = 0; k < 5; ++k) EXPECT_EQ(a[k], b[k]);
  }
}

// S(a) as an integral over slopes that knows nothing of M: over radius, the angle in closed form.
double DirectS(const Profile& profile, double a) {
  const auto f = [&](double r) {
    const double u = std::log1p(r * r);
    const double density = std::exp(profile.Excess(u) - 2 * u) * r / (kPi * (1 + profile.mass_excess()));
    if (r <= std::abs(a)) return std::array<double, 1>{a > 0 ? density * 2 * kPi * a : 0.0};
    const double phi = std::acos(a / r);
    return std::array<double, 1>{density * 2 * (a * (kPi - phi) + r * std::sin(phi))};
  };
  std::vector<double> breaks = {0};
  for (double r = 1e-3; r < 1e20; r *= r < 100 ? 1.5 : 8) breaks.push_back(r);
  breaks.push_back(std::abs(a));
  std::sort(breaks.begin(), breaks.end());
  QuadratureOptions fine;
  fine.relative = 1e-12;
  fine.max_intervals = 4000;
  return IntegrateAdaptive<1>(f, breaks, fine).value[0];
}

TEST(ProfileMasking, IsTheIntegralOverSlopes) {
  for (const auto& grid : {Grid(), ShortGrid()}) {
    for (std::size_t n = 1; n < 5; ++n) {  // the heaviest tail needs slopes to 1e20
      const Profile profile(grid->spline(), Coefficients()[n]);
      const ProfileMasking masking(grid, profile);
      for (const double a : {-2.0, -0.6, 0.3, 0.99, 1.7, 5.0, 20.0, 45.0}) {
        const double ggx = 0.5 * (a + std::sqrt(1 + a * a));
        std::vector<double> difference(masking.stride());
        const double at = std::abs(a);
        masking.Differences(&at, 1, nullptr, difference.data());
        EXPECT_NEAR(ggx + difference[0], DirectS(profile, a), 2e-11 * std::fmax(1, a)) << a;
      }
    }
  }
}

// The table against the rule at its own a, values and derivatives, and the derivative in a against that of the
// interpolant.
TEST(ProfileMasking, TableIsNearTheRule) {
  ShapeGenerator random(302);
  const QuadratureRule rule = GaussLegendre(32);
  for (const auto& grid : {Grid(), ShortGrid()}) {
    for (const auto& q : Coefficients()) {
      const Profile profile(grid->spline(), q);
      const ProfileMasking masking(grid, profile);
      for (int i = 0; i < 100; ++i) {
        const double a = i == 0 ? 0 : i == 1 ? 1e7 : random.LogUniform(1e-3, 1e4);
        double expected[21], found[8], slope;
        ProfileRule(*grid->spline(), a, rule, 4)
            .Apply(profile, ProfileTail(profile.tail_exponent()), true, expected, 7);
        masking.Differences(&a, 1, &slope, found);
        EXPECT_NEAR(found[0], expected[0], 1.5e-12) << a;
        EXPECT_NEAR(slope, -expected[7], 2e-10) << a;
        for (std::size_t k = 0; k < 6; ++k)
          EXPECT_NEAR(found[1 + k], expected[1 + k], 3e-12 * std::fmax(1, std::abs(expected[1 + k]))) << a << " " << k;
      }
    }
  }
}

TEST(ProfileMasking, IsNothingAtInfinity) {
  const ProfileMasking masking(Grid(), Profile(Grid()->spline(), Coefficients()[1]));
  double slope, found[8];
  const double a = HUGE_VAL;
  masking.Differences(&a, 1, &slope, found);
  EXPECT_EQ(slope, 0);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(found[k], 0);
}

// All of the gradient by differences of the functions themselves.
template <class Make>
void ExpectGradients(const Make& make, const std::vector<double>& p, unsigned seed) {
  constexpr std::size_t kDirections = 20;
  constexpr double kWeights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const std::size_t size = p.size();
  ShapeGenerator random(seed);
  std::vector<Vec3> u, m;
  for (std::size_t i = 0; i < kDirections; ++i) {
    u.push_back(i % 3 == 0 ? random.Sphere() : UpperWithHorizon(&random));
    m.push_back(Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), 1}));
  }
  std::vector<std::vector<double>> expected_D(kDirections, std::vector<double>(size)), expected_sigma = expected_D;
  for (std::size_t k = 0; k < size; ++k) {
    const double step = 2e-4 * (k < 2 || p[k] > 1 ? p[k] : 1.0);
    for (int n = 1; n <= 3; ++n) {
      for (const double sign : {-1.0, 1.0}) {
        std::vector<double> changed = p;
        changed[k] += sign * n * step;
        const auto distribution = make(changed);
        for (std::size_t i = 0; i < kDirections; ++i) {
          expected_D[i][k] += sign * kWeights[n - 1] / step * distribution->D(m[i]);
          expected_sigma[i][k] += sign * kWeights[n - 1] / step * distribution->Sigma(u[i]);
        }
      }
    }
  }
  const auto distribution = make(p);
  for (std::size_t i = 0; i < kDirections; ++i) {
    std::vector<double> dD(size), dsigma(size);
    const double D = distribution->D(m[i], dD.data()), sigma = distribution->Sigma(u[i], dsigma.data());
    EXPECT_EQ(D, distribution->D(m[i]));
    EXPECT_EQ(sigma, distribution->Sigma(u[i]));
    ExpectSameGradient(dD.data(), expected_D[i].data(), static_cast<int>(size), 1e-8, 1e5 * D);
    ExpectSameGradient(dsigma.data(), expected_sigma[i].data(), static_cast<int>(size), 1e-8, 1e5);
  }
}

SlopeDistribution SlopesOf(const std::vector<double>& p) { return {Family::kGgx, p[0], p[1], p[2], p[3], p[4]}; }

TEST(ShapeInvariantDistribution, GradientsAreDerivatives) {
  unsigned seed = 310;
  for (const auto& q : Coefficients()) {
    std::vector<double> p = {0.3, 0.2, 0.4, 0.1, -0.2};
    p.insert(p.end(), q.begin(), q.end());
    ExpectGradients(
        [](const std::vector<double>& x) {
          return std::make_shared<ShapeInvariantDistribution>(
              std::make_shared<const ProfileMasking>(Grid(), Profile(Grid()->spline(), {x.begin() + 5, x.end()})),
              SlopesOf(x));
        },
        p, seed++);
  }
}

const std::shared_ptr<const ProfileGrid>& PowerLawGrid() {
  static const auto grid =
      std::make_shared<const ProfileGrid>(std::make_shared<const ProfileSpline>(ProfileSpline::PowerLaw()));
  return grid;
}

std::shared_ptr<const ProfileMasking> PowerLaw(double gamma) {
  return std::make_shared<const ProfileMasking>(PowerLawGrid(),
                                                Profile(PowerLawGrid()->spline(), std::vector<double>{gamma - 2}));
}

TEST(StudentDistribution, GradientsAreDerivatives) {
  unsigned seed = 320;
  for (const double gamma : {1.6, 2.0, 3.5, 20.0, 90.0}) {
    ExpectGradients(
        [](const std::vector<double>& x) { return std::make_shared<StudentDistribution>(PowerLaw(x[5]), SlopesOf(x)); },
        {0.3, 0.2, 0.4, 0.1, -0.2, gamma}, seed++);
  }
}

TEST(StudentLaws, TwoIsGgxToTheBit) {
  ShapeGenerator random(303);
  for (int i = 0; i < 200; ++i) {
    const SlopeDistribution slopes = RandomSlopes(&random);
    const StudentDistribution student(PowerLaw(2), slopes);
    const SlopeNormalDistribution ggx(slopes);
    const Vec3 u = random.Sphere();
    EXPECT_EQ(student.D(u), ggx.D(u));
    EXPECT_EQ(student.Sigma(u), ggx.Sigma(u));
  }
}

// D(gamma) differs from Beckmann's by t^2 / (2 gamma) - t / gamma in the logarithm.
TEST(StudentLaws, TendsToBeckmann) {
  SlopeDistribution slopes = {Family::kBeckmann, 0.3, 0.2, 0.4, 0.1, -0.2};
  ShapeGenerator random(304);
  for (int i = 0; i < 100; ++i) {
    const Vec3 m = Normalized(Vec3{random.Uniform(-0.8, 0.8), random.Uniform(-0.8, 0.8), 1});
    const double D = SlopeDistributionD(slopes, m);
    const double t = -std::log(D * std::pow(m.z, 4) / SlopeNormalisation(slopes));
    EXPECT_NEAR(std::log(StudentD(1e8, slopes, m) / D), (0.5 * t * t - t) / 1e8, 1e-12 * (1 + t * t * t));
    const Vec3 u = UpperWithHorizon(&random);
    EXPECT_NEAR(StudentDistribution(PowerLaw(100), slopes).Sigma(u), SmithSigma(slopes, u), 3e-3 * slopes.alpha_x);
  }
}

TEST(StudentDistribution, RefusesWhatHasNoMean) {
  const SlopeDistribution slopes = {Family::kGgx, 0.3, 0.2, 0.4, 0.1, -0.2};
  EXPECT_THROW(StudentDistribution(PowerLaw(1.5), slopes), InputError);
  EXPECT_THROW(StudentDistribution(PowerLaw(NAN), slopes), InputError);
}

}  // namespace
}  // namespace lobefit

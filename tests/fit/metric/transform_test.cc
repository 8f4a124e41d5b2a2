// The curves against long double over the whole range of doubles, on every instruction set of this machine.
#include "lobefit/fit/metric/transform.h"

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/reference_table.h"
#include "tests/support/simd_targets.h"
#include <gtest/gtest.h>

#include "lobefit/fit/metric/metric.h"

namespace lobefit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kKnee = 0.2, kShift = 0.005;
const Transform kTransforms[] = {
    {Curve::kLogOnePlus}, {Curve::kCubeRoot}, {Curve::kLinear}, {Curve::kRelative}, {Curve::kAsinh, kKnee, kShift}};

long double Definition(Curve curve, long double v) {
  switch (curve) {
    case Curve::kLogOnePlus:
      return std::log1p(v);
    case Curve::kCubeRoot:
      return std::cbrt(v);
    case Curve::kAsinh:
      return std::asinh(v / kKnee);
    case Curve::kLinear:
    case Curve::kRelative:
      break;
  }
  return v;
}

long double Derivative(Curve curve, long double v, long double m) {
  switch (curve) {
    case Curve::kLogOnePlus:
      return 1 / (1 + v);
    case Curve::kCubeRoot:
      return 1 / (3 * std::pow(std::cbrt(v), 2.0L));
    case Curve::kAsinh: {
      const long double h = std::hypot(v, static_cast<long double>(kKnee));
      return 1 / h - kShift * kKnee * kKnee / (h * h * h);
    }
    case Curve::kRelative:
      return 1 / m;
    case Curve::kLinear:
      break;
  }
  return 1;
}

// T(f) - T(m) without loss.
long double ExactDifference(Curve curve, long double f, long double m) {
  const long double gap = f - m;
  switch (curve) {
    case Curve::kLogOnePlus:
      return gap > 0 ? std::log1p(gap / (1 + m)) : -std::log1p(-gap / (1 + f));
    case Curve::kCubeRoot: {
      const long double a = std::cbrt(f), b = std::cbrt(m);
      return gap == 0 ? 0 : gap / (a * a + a * b + b * b);
    }
    case Curve::kRelative:
      return gap / m;
    case Curve::kAsinh: {
      // By the mean of the derivative where both are near, else directly.
      const long double mean = (f + m) / 2, h = std::hypot(mean, static_cast<long double>(kKnee));
      const long double near = gap / h * (1 + gap * gap / 24 * (2 * mean * mean - kKnee * kKnee) / (h * h * h * h));
      const long double direct = std::asinh(f / kKnee) - std::asinh(m / kKnee);
      return (std::fabs(gap) < 1e-4L * h ? near : direct) - kShift * f / std::hypot(f, static_cast<long double>(kKnee));
    }
    case Curve::kLinear:
      break;
  }
  return gap;
}

// From 1e-308 to 1e308, with pairs near to each other.
std::vector<double> Values() {
  std::vector<double> values;
  for (int k = -1232; k <= 1232; ++k) {
    const double value = std::pow(10, k / 4.0) * (1 + 0.0003 * k);
    values.push_back(value);
    values.push_back(value * (1 + 1e-9));
  }
  return values;
}

double One(void (*function)(const Transform&, const double*, const double*, std::size_t, double*),
           const Transform& transform, double f) {
  const double cosine = 1;
  double value = 0;
  function(transform, &f, &cosine, 1, &value);
  return value;
}

TEST(ApplyTransform, IsRightToRoundingFromTheLeastToTheLargestNumber) {
  ForEachSimdTarget([] {
    for (const Transform& transform : kTransforms) {
      std::vector<double> f, cosine, value;
      for (const double v : Values()) {
        // Above, v / knee is no number.
        if (transform.curve == Curve::kAsinh && v > 1e307) continue;
        f.push_back(v);
        if (Takes(transform, -v, 1)) f.push_back(-v);
      }
      cosine.assign(f.size(), 1.0);
      value.resize(f.size());
      ApplyTransform(transform, f.data(), cosine.data(), f.size(), value.data());
      for (std::size_t i = 0; i < f.size(); ++i) {
        const auto expected = static_cast<double>(Definition(transform.curve, f[i]));
        // ln(1 + v) for v < 0 loses what 1 + v loses.
        const double cond = transform.curve == Curve::kLogOnePlus && f[i] < 0 ? 1 + std::fabs(1 / (1 + f[i])) : 1;
        ASSERT_NEAR(value[i], expected, cond * 1e-15 * std::fabs(expected) + 1e-323)
            << static_cast<int>(transform.curve) << " " << f[i];
      }
    }
  });
}

TEST(ApplyTransform, ZeroInfinityAndNanStayWhatTheyAre) {
  ForEachSimdTarget([] {
    for (const Transform& transform : kTransforms) {
      SCOPED_TRACE(static_cast<int>(transform.curve));
      EXPECT_EQ(One(ApplyTransform, transform, 0), 0);
      EXPECT_EQ(One(ApplyTransform, transform, kInfinity), kInfinity);
      EXPECT_TRUE(std::isnan(One(ApplyTransform, transform, kNan)));
      if (transform.curve != Curve::kLogOnePlus) {
        EXPECT_EQ(One(ApplyTransform, transform, -kInfinity), -kInfinity);
      }
    }
    EXPECT_EQ(One(ApplyTransform, {Curve::kLogOnePlus}, -1), -kInfinity);
    EXPECT_TRUE(std::isnan(One(ApplyTransform, {Curve::kLogOnePlus}, -1.5)));
  });
}

TEST(ApplyTransform, TheCubeRootKeepsTheSignOfSubnormalNumbers) {
  ForEachSimdTarget([] {
    EXPECT_NEAR(One(ApplyTransform, {Curve::kCubeRoot}, 8e-312), 2e-104, 1e-114);
    EXPECT_NEAR(One(ApplyTransform, {Curve::kCubeRoot}, -8e-312), -2e-104, 1e-114);
  });
}

TEST(Residuals, AreDifferencesWithoutCancellationAndTheirSlopes) {
  ForEachSimdTarget([] {
    const std::vector<double> values = Values();
    for (const Transform& transform : kTransforms) {
      std::vector<double> f, m, cosine, residual, slope;
      for (std::size_t i = 0; i + 300 < values.size(); ++i) {
        // The neighbour, the same value, and one 1e37 away.
        for (const std::size_t other : {i + 1, i, i + 300}) {
          if (values[other] > 1e307) continue;
          f.insert(f.end(), {values[i], values[other]});
          m.insert(m.end(), {values[other], values[i]});
        }
        if (Takes(transform, -0.5, 1) && values[i] < 0.5) {
          f.push_back(values[i]);
          m.push_back(-values[i] * 0.75);
        }
      }
      cosine.assign(f.size(), 1.0);
      residual.resize(f.size());
      slope.resize(f.size());
      Residuals(transform, f.data(), cosine.data(), m.data(), nullptr, f.size(), residual.data(), slope.data());
      for (std::size_t i = 0; i < f.size(); ++i) {
        const auto expected = static_cast<double>(ExactDifference(transform.curve, f[i], m[i]));
        // The mean that the noise gives is a term of its own.
        const double scale =
            transform.curve == Curve::kAsinh ? std::fabs(expected) + kShift : std::fabs(expected) + 1e-323;
        ASSERT_NEAR(residual[i], expected, 2e-15 * scale)
            << static_cast<int>(transform.curve) << " " << f[i] << " " << m[i];
        if (transform.curve == Curve::kCubeRoot && (f[i] < 1e-40 || f[i] < 1e-5 * std::fabs(m[i]))) continue;
        const auto derivative = static_cast<double>(Derivative(transform.curve, f[i], m[i]));
        ASSERT_NEAR(slope[i], derivative, 2e-15 * derivative + 1e-323)
            << static_cast<int>(transform.curve) << " " << f[i] << " " << m[i];
      }
    }
  });
}

TEST(Residuals, NanStaysNanAndAnInfiniteModelIsInfinitelyFarOff) {
  ForEachSimdTarget([] {
    for (const Transform& transform : kTransforms) {
      SCOPED_TRACE(static_cast<int>(transform.curve));
      const double f[] = {kNan, 1, kInfinity, 0, 0, 1e-300}, m[] = {1, kNan, 1, 1e-300, 1, 1e-300},
                   cosine[] = {1, 1, 1, 1, 1, 1};
      double residual[6], slope[6];
      Residuals(transform, f, cosine, m, nullptr, 6, residual, slope);
      EXPECT_TRUE(std::isnan(residual[0]));
      EXPECT_TRUE(std::isnan(residual[1]));
      EXPECT_EQ(residual[2], kInfinity);
      EXPECT_LT(residual[3], 0);
      EXPECT_TRUE(std::isfinite(residual[3]));
      EXPECT_TRUE(std::isfinite(residual[4]) && std::isfinite(slope[4]));
      EXPECT_NEAR(residual[5], 0, 1e-300);
    }
  });
}

TEST(Residuals, AreWeightedByTheSquareRootAndTheSameWithoutSlope) {
  const double f[] = {0.3, 2, 5}, m[] = {0.2, 3, 4}, cosine[] = {0.5, 0.7, 0.9}, root[] = {2, 0, 0.5};
  for (const Transform& transform : kTransforms) {
    double plain[3], plain_slope[3], weighted[3], slope[3], alone[3];
    Residuals(transform, f, cosine, m, nullptr, 3, plain, plain_slope);
    Residuals(transform, f, cosine, m, root, 3, weighted, slope);
    Residuals(transform, f, cosine, m, root, 3, alone, nullptr);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(weighted[i], root[i] * plain[i]);
      EXPECT_EQ(slope[i], root[i] * plain_slope[i]);
      EXPECT_EQ(alone[i], weighted[i]);
    }
  }
}

TEST(Curvatures, AreTheSecondDerivativesOfWhatNoiseBends) {
  for (const Transform& transform : kTransforms) {
    for (const double v : {0.01, 0.3, 5.0}) {
      const long double h = 1e-4L * v;
      long double expected = 0;
      if (transform.curve == Curve::kLogOnePlus || transform.curve == Curve::kCubeRoot) {
        expected = (Definition(transform.curve, v + h) - 2 * Definition(transform.curve, v) +
                    Definition(transform.curve, v - h)) /
                   (h * h);
      }
      // (f / m - 1) / m at f = v, over the slope 1 / v.
      const auto pull = [v](long double m) { return (v / m - 1) * v / m; };
      if (transform.curve == Curve::kRelative) expected = -(pull(v + h) + pull(v - h)) / (h * h);
      EXPECT_NEAR(One(Curvatures, transform, v), static_cast<double>(expected),
                  1e-6 * static_cast<double>(std::fabs(expected)));
    }
  }
}

TEST(Takes, WhatTheCurveHasANumberFor) {
  EXPECT_TRUE(Takes({Curve::kLogOnePlus}, -1.9, 0.5));
  EXPECT_FALSE(Takes({Curve::kLogOnePlus}, -2, 0.5));
  EXPECT_FALSE(Takes({Curve::kRelative}, 0, 1));
  EXPECT_TRUE(Takes({Curve::kRelative}, 1e-300, 1));
  for (const Curve curve : {Curve::kCubeRoot, Curve::kLinear, Curve::kAsinh}) EXPECT_TRUE(Takes({curve}, -1e300, 1));
}

// The metric asinh and every metric's weight from a noise model, against 60 digits.
// With counting noise: what is taken out of the difference is the mean that the noise gives it, by integration over the
// noise, and the slope is its derivative.
TEST(AsinhTransform, TakesTheMeanOfCountingNoiseOut) {
  const NoiseModel noise = {0.001, 0.03, 0.002};
  const Transform transform = TransformOf(Metric::kAsinh, noise);
  EXPECT_DOUBLE_EQ(transform.knee, 0.06);
  const double cosine = 1;
  const auto residual = [&](double v, double m, double* slope) {
    double value, unused;
    Residuals(transform, &v, &cosine, &m, nullptr, 1, &value, slope != nullptr ? slope : &unused);
    return value;
  };
  for (const double v : {0.01, 0.03, 0.1, 0.5, 2., 20.}) {
    const double deviation = std::sqrt(noise.VarianceAt(v));
    double mean = 0, mass = 0;
    for (double z = -8; z <= 8; z += 1e-3) {
      const double weight = std::exp(-0.5 * z * z);
      mean += weight * residual(v, v + deviation * z, nullptr);
      mass += weight;
    }
    double slope;
    residual(v, v, &slope);
    const double spread = deviation * slope;
    // Without the shift up to 0.09 of the residual's standard deviation.
    EXPECT_LT(std::fabs(mean / mass), 0.012 * spread) << v;
    const double step = 1e-6 * v, m = 1.3 * v;
    residual(v, m, &slope);
    EXPECT_NEAR(slope, (residual(v + step, m, nullptr) - residual(v - step, m, nullptr)) / (2 * step), 1e-7 * slope);
  }
}

// Without it the transform is what it was.
TEST(AsinhTransform, WithoutCountingNoiseHasNoOtherShift) {
  const Transform transform = TransformOf(Metric::kAsinh, {0.002, 0.04});
  EXPECT_EQ(transform.knee, 0.002 / 0.04);
  EXPECT_EQ(transform.floor_shift, 0);
  EXPECT_EQ(transform.poisson_shift, 0);
}

TEST(ReferenceTable, AsinhResidual) {
  const ReferenceTable table("asinh_residual");
  ASSERT_EQ(table.size(), 80U);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto at = [&](const char* column) { return table(row, column); };
    const double m = at("m"), v = at("v"), sd = at("sd"), cosine = 1;
    const NoiseModel noise = {at("s0"), at("rho")};
    const Transform asinh = TransformOf(Metric::kAsinh, noise);
    EXPECT_NEAR(asinh.knee, at("knee"), 1e-15 * at("knee"));
    EXPECT_NEAR(One(ApplyTransform, asinh, v), at("T_v"), 4e-15 * std::fabs(at("T_v")));
    EXPECT_NEAR(One(ApplyTransform, asinh, m), at("T_m"), 4e-15 * std::fabs(at("T_m")));
    double residual = 0, slope = 0;
    Residuals(asinh, &v, &cosine, &m, nullptr, 1, &residual, &slope);
    const double scale =
        std::fabs(at("r")) + std::fabs(v - m) * std::fabs(at("dr_dv")) + 0.5 * noise.relative * noise.relative;
    EXPECT_NEAR(residual, at("r_corrected"), 4e-15 * scale + 1e-15 * std::fabs(m) * at("dr_dv")) << row;
    EXPECT_NEAR(slope, at("dr_corrected_dv"), 4e-15 * at("dr_dv"));
    Residuals({Curve::kAsinh, asinh.knee, 0}, &v, &cosine, &m, nullptr, 1, &residual, &slope);
    EXPECT_NEAR(residual, at("r"), 4e-15 * scale + 1e-15 * std::fabs(m) * at("dr_dv"));
    EXPECT_NEAR(slope, at("dr_dv"), 4e-15 * at("dr_dv"));
    const auto weight = [&](Metric metric) {
      const double inverse = One(InverseSlopes, TransformOf(metric, noise), v) / sd;
      return inverse * inverse;
    };
    EXPECT_NEAR(weight(Metric::kLog), at("w_log"), 1e-14 * at("w_log"));
    EXPECT_NEAR(weight(Metric::kCubeRoot), at("w_cube_root"), 1e-14 * at("w_cube_root"));
    EXPECT_NEAR(weight(Metric::kRelative), at("w_relative"), 1e-14 * at("w_relative"));
    EXPECT_NEAR(weight(Metric::kCosineL2), at("w_cosine_l2"), 1e-14 * at("w_cosine_l2"));
    // For its own noise the weight is the same everywhere.
    EXPECT_NEAR(weight(Metric::kAsinh) * noise.relative * noise.relative, 1, 1e-13);
  }
}

TEST(MetricTable, IsInTheOrderOfTheEnumeration) {
  for (std::size_t i = 0; i < MetricTable().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(MetricTable()[i].metric), i);
    EXPECT_EQ(RowOf(MetricTable()[i].metric).name, MetricTable()[i].name);
  }
  EXPECT_EQ(MetricChoices().size(), MetricTable().size());
}

TEST(AngularWeight, IsTheSinesOfNganAndLow) {
  EXPECT_NEAR(AngularWeight(Metric::kNgan, 0.6, 0.8), 0.8 * 0.6, 1e-15);
  EXPECT_NEAR(AngularWeight(Metric::kLowLog, 0.6, 0.8), 0.8, 1e-15);
  EXPECT_EQ(AngularWeight(Metric::kCubeRoot, 0.6, 0.8), 1);
}

}  // namespace
}  // namespace lobefit

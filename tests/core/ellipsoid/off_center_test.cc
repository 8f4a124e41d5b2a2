#include "lobefit/core/ellipsoid/off_center.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/ndf/slope_ndf.h"

namespace lobefit {
namespace {

const std::vector<std::string> kOffCenterNames = {"slope_x", "slope_y", "q11", "q12", "q22"};

// Tables without a cond column: 1e-12 relative to the value; to the row's largest for derivatives.
void ExpectJacobian(const double* jacobian, const ReferenceTable& table, std::size_t row,
                    const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, double tolerance) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    double largest = 0;
    for (const std::string& input : inputs)
      largest = std::fmax(largest, std::abs(table(row, "d" + outputs[k] + "_d" + input)));
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      const std::string name = "d" + outputs[k] + "_d" + inputs[j];
      EXPECT_NEAR(jacobian[5 * k + j], table(row, name), tolerance * largest) << name << ", row " << row;
    }
  }
}

TEST(OffCenterTables, FromEllipsoid) {
  const ReferenceTable table("offcenter_from_ellipsoid");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = EllipsoidOfRow(table, row);
    double jacobian[25];
    const OffCenter o = OffCenterFromEllipsoid(e, jacobian);
    const double values[5] = {o.slope_x, o.slope_y, o.q11, o.q12, o.q22};
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = table(row, kOffCenterNames[k]);
      EXPECT_NEAR(values[k], expected, 1e-12 * std::abs(expected)) << kOffCenterNames[k] << ", row " << row;
    }
    ExpectJacobian(jacobian, table, row, kOffCenterNames, kEllipsoidNames, 1e-9);
  }
}

TEST(OffCenterTables, EllipsoidFromOffCenter) {
  const ReferenceTable table("ellipsoid_from_offcenter");
  const std::vector<std::string> inputs = {"slope_x", "slope_y", "slope_alpha_x", "slope_alpha_y", "slope_r"};
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double ax = table(row, "slope_alpha_x"), ay = table(row, "slope_alpha_y"), r = table(row, "slope_r");
    double jacobian[25], chained[25];
    const Ellipsoid e =
        EllipsoidFromOffCenter({table(row, "slope_x"), table(row, "slope_y"), ax * ax, ax * ay * r, ay * ay}, jacobian);
    const double values[5] = {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z};
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = table(row, kEllipsoidNames[k]);
      EXPECT_NEAR(values[k], expected, 1e-9 * std::abs(expected)) << kEllipsoidNames[k] << ", row " << row;
      // Chain from q11, q12, q22 to slope_alpha_x, slope_alpha_y, slope_r.
      const double* d = jacobian + 5 * k;
      chained[5 * k] = d[0];
      chained[5 * k + 1] = d[1];
      chained[5 * k + 2] = 2 * ax * d[2] + ay * r * d[3];
      chained[5 * k + 3] = ax * r * d[3] + 2 * ay * d[4];
      chained[5 * k + 4] = ax * ay * d[3];
    }
    ExpectJacobian(chained, table, row, kEllipsoidNames, inputs, 1e-9);
  }
}

using OffCenterJet = ceres::Jet<double, 5>;

TEST(OffCenterJets, JacobianFromEllipsoid) {
  ShapeGenerator random(31);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Moderate();
    const OffCenterJet p[5] = {OffCenterJet(e.alpha_x, 0), OffCenterJet(e.alpha_y, 1), OffCenterJet(e.theta_x, 2),
                               OffCenterJet(e.theta_y, 3), OffCenterJet(e.theta_z, 4)};
    OffCenterJet expected[5];
    OffCenterFormula(p, expected);
    double jacobian[25];
    const OffCenter o = OffCenterFromEllipsoid(e, jacobian);
    const double values[5] = {o.slope_x, o.slope_y, o.q11, o.q12, o.q22};
    for (int k = 0; k < 5; ++k) {
      EXPECT_NEAR(values[k], expected[k].a, 1e-12);
      ExpectSameGradient(jacobian + 5 * k, expected[k].v.data(), 5, 1e-10, 1);
    }
  }
}

void ExpectNear(const SlopeCoordinates& a, const SlopeCoordinates& b, double tolerance) {
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(a.v[k], b.v[k], tolerance * std::fmax(1, std::abs(b.v[k]))) << k;
}

// alphas 1e-4 to 1, tilts to 80 degrees, equal axes: angles and back to slope space.
TEST(OffCenterLaws, SlopeCoordinatesRoundTrip) {
  ShapeGenerator random(32);
  for (int i = 0; i < 2000; ++i) {
    const SlopeCoordinates s = SlopeCoordinatesFromEllipsoid(random.Hostile());
    const Ellipsoid canonical = EllipsoidFromSlopeCoordinates(s);
    EXPECT_LE(canonical.alpha_y, canonical.alpha_x);
    EXPECT_LE(canonical.alpha_x, 1 + 1e-14);
    EXPECT_GT(EllipsoidRotation(canonical).row[2].z, 0);
    EXPECT_GT(canonical.theta_z, -kPi / 2);
    EXPECT_LE(canonical.theta_z, kPi / 2);
    ExpectNear(SlopeCoordinatesFromEllipsoid(canonical), s, 1e-12);
  }
}

// Slope coordinates chosen directly: strong correlation, large mean slopes.
TEST(OffCenterLaws, AnySlopeCoordinatesAreAnEllipsoid) {
  ShapeGenerator random(33);
  for (int i = 0; i < 2000; ++i) {
    const SlopeCoordinates s = {{random.Uniform(-3, 3), random.Uniform(-3, 3), std::log(random.LogUniform(1e-4, 5)),
                                 random.Uniform(-1, 1) * random.LogUniform(1e-4, 5),
                                 std::log(random.LogUniform(1e-4, 5))}};
    const Ellipsoid e = EllipsoidFromSlopeCoordinates(s);
    // One rounding of an angle moves the shortest axis by eps / alpha_y of its length.
    const double angle_rounding = 64 * std::numeric_limits<double>::epsilon() / e.alpha_y;
    ExpectNear(SlopeCoordinatesFromEllipsoid(e), s, std::fmax(1e-12, angle_rounding));
  }
}

TEST(OffCenterLaws, EllipsoidRoundTripWhereTheAxesDiffer) {
  ShapeGenerator random(34);
  for (int i = 0; i < 2000; ++i) {
    Ellipsoid e = random.Hostile();
    e = EllipsoidFromSlopeCoordinates(SlopeCoordinatesFromEllipsoid(e));
    const double gap = std::fmin(1 - e.alpha_y / e.alpha_x, 1 - e.alpha_x);
    if (gap < 1e-3) continue;
    const Ellipsoid back = EllipsoidFromSlopeCoordinates(SlopeCoordinatesFromEllipsoid(e));
    EXPECT_NEAR(back.alpha_x, e.alpha_x, 1e-12 / gap * e.alpha_x);
    EXPECT_NEAR(back.alpha_y, e.alpha_y, 1e-12 / gap * e.alpha_y);
    EXPECT_NEAR(back.theta_x, e.theta_x, 1e-12 / gap);
    EXPECT_NEAR(back.theta_y, e.theta_y, 1e-12 / gap);
    EXPECT_NEAR(std::remainder(back.theta_z - e.theta_z, kPi), 0, 1e-12 / gap);
  }
}

TEST(OffCenterLaws, OffCenterRoundTrip) {
  ShapeGenerator random(35);
  for (int i = 0; i < 2000; ++i) {
    const OffCenter o = OffCenterFromEllipsoid(random.Moderate());
    const OffCenter back = OffCenterFromEllipsoid(EllipsoidFromOffCenter(o));
    EXPECT_NEAR(back.slope_x, o.slope_x, 1e-12);
    EXPECT_NEAR(back.slope_y, o.slope_y, 1e-12);
    EXPECT_NEAR(back.q11, o.q11, 1e-12 * (o.q11 + o.q22));
    EXPECT_NEAR(back.q12, o.q12, 1e-12 * (o.q11 + o.q22));
    EXPECT_NEAR(back.q22, o.q22, 1e-12 * (o.q11 + o.q22));
    const OffCenter through = OffCenterFromSlopeCoordinates(SlopeCoordinatesFromOffCenter(o));
    EXPECT_NEAR(through.q11, o.q11, 1e-14 * o.q11);
    EXPECT_NEAR(through.q12, o.q12, 1e-14 * std::sqrt(o.q11 * o.q22));
    EXPECT_NEAR(through.q22, o.q22, 1e-14 * o.q22);
  }
}

// out = a b, all 5 x 5 row-major.
void Multiply(const double* a, const double* b, double* out) {
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      out[5 * i + j] = 0;
      for (int k = 0; k < 5; ++k) out[5 * i + j] += a[5 * i + k] * b[5 * k + j];
    }
  }
}

void ExpectIdentity(const double* product, double tolerance) {
  for (int i = 0; i < 25; ++i) EXPECT_NEAR(product[i], i % 6 == 0 ? 1 : 0, tolerance) << i;
}

TEST(OffCenterLaws, JacobiansAreInverses) {
  ShapeGenerator random(36);
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = EllipsoidFromOffCenter(OffCenterFromEllipsoid(random.Moderate()));
    if (std::fmin(1 - e.alpha_y / e.alpha_x, 1 - e.alpha_x) < 0.01) continue;
    double forward[25], backward[25], slope_forward[25], slope_backward[25], product[25];
    const OffCenter o = OffCenterFromEllipsoid(e, forward);
    EllipsoidFromOffCenter(o, backward);
    Multiply(backward, forward, product);
    ExpectIdentity(product, 1e-9);
    const SlopeCoordinates s = SlopeCoordinatesFromEllipsoid(e, slope_forward);
    EllipsoidFromSlopeCoordinates(s, slope_backward);
    Multiply(slope_backward, slope_forward, product);
    ExpectIdentity(product, 1e-9);
    double o_from_s[25], s_from_o[25], chained[25];
    OffCenterFromSlopeCoordinates(s, o_from_s);
    SlopeCoordinatesFromOffCenter(o, s_from_o);
    Multiply(s_from_o, o_from_s, product);
    ExpectIdentity(product, 1e-9);
    Multiply(o_from_s, slope_forward, chained);
    for (int k = 0; k < 5; ++k) ExpectSameGradient(chained + 5 * k, forward + 5 * k, 5, 1e-10, 1);
  }
}

TEST(OffCenterDegeneracy, EqualAxesHaveNoJacobianAndAFixedChoiceOfAngles) {
  const auto convert = [](const Ellipsoid& e, double* jacobian) {
    return EllipsoidFromSlopeCoordinates(SlopeCoordinatesFromEllipsoid(e), jacobian);
  };
  double jacobian[25];
  for (const double alpha : {1e-4, 0.3, 0.9}) {
    const Ellipsoid e = convert({alpha, alpha, 0.3, -0.2, 1.1}, jacobian);
    EXPECT_NEAR(e.alpha_x, alpha, 1e-13 * alpha);
    EXPECT_NEAR(e.alpha_y, alpha, 1e-13 * alpha);
    EXPECT_EQ(e.theta_z, 0);
    for (const double d : jacobian) EXPECT_TRUE(std::isnan(d));
  }
  const Ellipsoid lambert = convert({1, 1, 0.3, -0.2, 1.1}, jacobian);
  EXPECT_NEAR(lambert.alpha_x, 1, 1e-14);
  EXPECT_EQ(lambert.theta_x, 0);
  EXPECT_EQ(lambert.theta_y, 0);
  EXPECT_EQ(lambert.theta_z, 0);
  convert({1, 0.3, 0.2, 0.4, 0.1}, jacobian);
  for (const double d : jacobian) EXPECT_TRUE(std::isnan(d));
  convert({0.5, 0.3, 0.2, 0.4, 0.1}, jacobian);
  for (const double d : jacobian) EXPECT_FALSE(std::isnan(d));
}

TEST(OffCenterErrors, RefuseWhatIsNoDistribution) {
  const double nan = std::nan("");
  for (const OffCenter& bad :
       {OffCenter{0, 0, -1, 0, 1}, OffCenter{0, 0, 1, 1.1, 1}, OffCenter{0, 0, 1, 1, 1}, OffCenter{nan, 0, 1, 0, 1},
        OffCenter{0, 0, nan, 0, 1}, OffCenter{0, 0, 1, 0, HUGE_VAL}}) {
    EXPECT_THROW(EllipsoidFromOffCenter(bad), InputError);
    EXPECT_THROW(SlopeCoordinatesFromOffCenter(bad), InputError);
  }
}

// The same distribution in both coordinates: D, sigma and G1, and their gradients through the Jacobian of the
// conversion.
TEST(SlopeNdf, EqualsTheEllipsoid) {
  ShapeGenerator random(37);
  for (int i = 0; i < 2000; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate() : random.Hostile();
    const double accuracy = i % 2 == 0 ? 1e-11 : 1e-7;  // hostile: D conditioned by 1 / alpha in each coordinate system
    double jacobian[25];
    const SlopeFrame frame(SlopeCoordinatesFromEllipsoid(e, jacobian));
    const Vec3 m = random.NearLobe(e), u = random.Sphere();
    const auto expect_chain = [&](const double* slope_gradient, const double* gradient) {
      double chained[5] = {};
      for (int k = 0; k < 25; ++k) chained[k % 5] += slope_gradient[k / 5] * jacobian[k];
      ExpectSameGradient(chained, gradient, 5, 10 * accuracy, 1);
    };
    double gradient[5], slope_gradient[5];
    Vec3 dw, slope_dw;
    const double D = EllipsoidD(e, m, gradient, &dw);
    EXPECT_NEAR(SlopeD(frame, m, slope_gradient, &slope_dw), D, accuracy * D);
    if (i % 2 == 0) {
      expect_chain(slope_gradient, gradient);
      EXPECT_NEAR(Norm(slope_dw - dw), 0, 10 * accuracy * Norm(dw));
      const double sigma = EllipsoidSigma(e, u, gradient, &dw);
      EXPECT_NEAR(SlopeSigma(frame, u, slope_gradient, &slope_dw), sigma, accuracy * sigma);
      expect_chain(slope_gradient, gradient);
      EXPECT_NEAR(Norm(slope_dw - dw), 0, 10 * accuracy * Norm(dw));
      bool clamped, slope_clamped;
      EXPECT_NEAR(SlopeG1(frame, u, slope_gradient, nullptr, &slope_clamped), EllipsoidG1(e, u, gradient, &clamped),
                  accuracy);
      EXPECT_EQ(clamped, slope_clamped);
      expect_chain(slope_gradient, gradient);
    }
  }
}

TEST(SlopeNdf, AgreesWithJets) {
  using SlopeJet = ceres::Jet<double, 8>;
  ShapeGenerator random(38);
  for (int i = 0; i < 2000; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate() : random.Hostile();
    // Hostile: y2 = (t2 - b y1) / c has lost |b y1 / c| eps in both.
    const double accuracy = i % 2 == 0 ? 1e-10 : 1e-8;
    const SlopeCoordinates s = SlopeCoordinatesFromEllipsoid(e);
    const SlopeFrame frame(s);
    SlopeJet v[5];
    for (int k = 0; k < 5; ++k) v[k] = SlopeJet(s.v[k], k);
    for (const Vec3& w : {random.NearLobe(e), random.Sphere()}) {
      const Vec3T<SlopeJet> jet_w = {SlopeJet(w.x, 5), SlopeJet(w.y, 6), SlopeJet(w.z, 7)};
      double gradient[8];
      Vec3 dw;
      const double D = SlopeD(frame, w, gradient, &dw);
      gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
      const SlopeJet jet_D = SlopeDFormula(v, jet_w);
      EXPECT_NEAR(D, jet_D.a, accuracy * D);
      ExpectSameGradient(gradient, jet_D.v.data(), 8, accuracy);
      EXPECT_EQ(D, SlopeD(frame, w));
      const double sigma = SlopeSigma(frame, w, gradient, &dw);
      gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
      const SlopeJet jet_sigma = SlopeSigmaFormula(v, jet_w);
      EXPECT_NEAR(sigma, jet_sigma.a, accuracy * sigma);
      ExpectSameGradient(gradient, jet_sigma.v.data(), 8, accuracy, sigma);
      EXPECT_EQ(sigma, SlopeSigma(frame, w));
      const double g1 = SlopeG1Unclamped(frame, w, gradient, &dw);
      gradient[5] = dw.x, gradient[6] = dw.y, gradient[7] = dw.z;
      const SlopeJet jet_g1 = (w.z > 0 ? jet_w.z : -jet_w.z) / jet_sigma;
      EXPECT_NEAR(g1, jet_g1.a, accuracy * g1);
      ExpectSameGradient(gradient, jet_g1.v.data(), 8, accuracy, g1);
    }
  }
}

}  // namespace
}  // namespace lobefit

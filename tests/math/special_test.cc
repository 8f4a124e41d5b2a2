#include "lobefit/math/special.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "lobefit/math/carlson.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// The reference values of this file were computed with 40 digits (mpmath 1.3) from the exact value of each double
// argument.
void ExpectRelative(double value, double reference, double units) {
  EXPECT_LE(std::fabs(value - reference), units * kEps * std::fabs(reference)) << value << " instead of " << reference;
}

TEST(Special, Erfcx) {
  const std::array<std::array<double, 2>, 11> reference = {{{-5, 1.4400979867466104e+11},
                                                            {-0.75, 3.0031716636274523},
                                                            {1e-9, 9.9999999887162083e-1},
                                                            {0.4, 6.7078778529476151e-1},
                                                            {1.9, 2.6650937366167266e-1},
                                                            {3.25, 1.6633534842682188e-1},
                                                            {9.99, 5.619664070685882e-2},
                                                            {10.5, 5.3491899746564117e-2},
                                                            {30, 1.8795888861416751e-2},
                                                            {1e6, 5.6418958354747419e-7},
                                                            {1e200, 5.641895835477563e-201}}};
  for (const auto& [x, value] : reference) ExpectRelative(Erfcx(x), value, 6);
  EXPECT_EQ(Erfcx(0), 1);
  EXPECT_EQ(Erfcx(-30), std::numeric_limits<double>::infinity());
}

TEST(Special, Langevin) {
  const std::array<std::array<double, 3>, 8> reference = {{{1e-8, 3.3333333333333334e-9, 3.3333333333333333e-1},
                                                           {0.01, 3.3333111113227493e-3, 3.3332666677248529e-1},
                                                           {0.5, 1.6395341373865285e-1, 3.1730562316883072e-1},
                                                           {0.999, 3.1275929788578569e-1, 2.7603688107390691e-1},
                                                           {1.001, 3.1331117454990691e-1, 2.7583975515509094e-1},
                                                           {5, 8.0009080398201938e-1, 3.9818383790598098e-2},
                                                           {40, 9.75e-1, 6.25e-4},
                                                           {900, 9.9888888888888889e-1, 1.2345679012345679e-6}}};
  for (const auto& [x, value, derivative] : reference) {
    double d = 0;
    ExpectRelative(Langevin(x, &d), value, 12);
    ExpectRelative(d, derivative, 12);
    EXPECT_EQ(Langevin(x), Langevin(x, &d));
    EXPECT_EQ(Langevin(-x), -Langevin(x));
  }
  double d = 0;
  EXPECT_EQ(Langevin(0, &d), 0);
  ExpectRelative(d, 1.0 / 3, 2);
}

TEST(Special, ScaledBessel) {
  const std::array<std::array<double, 4>, 9> reference = {
      {{1e-6, 9.9999900000075e-1, 4.9999950000031248e-7, 1.2499987500007291e-13},
       {0.3, 7.5758062518254786e-1, 1.123775606398388e-1, 8.3968875836225304e-3},
       {2, 3.0850832255367104e-1, 2.1526928924893766e-1, 9.323903330473338e-2},
       {11, 1.217301681665896e-1, 1.160577581698902e-1, 1.0062875759024593e-1},
       {24.9, 8.0359332611532214e-2, 7.8728794882103129e-2, 7.403573462903397e-2},
       {25.1, 8.0035197254296236e-2, 7.8424315178368414e-2, 7.3786247837693176e-2},
       {60, 5.1611549173609841e-2, 5.1179630189028718e-2, 4.9905561500642217e-2},
       {800, 1.4106945005869184e-2, 1.4098125406526997e-2, 1.4071699692352866e-2},
       {1e6, 3.9894233026924578e-4, 3.9894213079803078e-4, 3.9894153238498418e-4}}};
  for (const auto& [x, i0, i1, i2] : reference) {
    const ScaledBesselI result = BesselIScaled(x);
    ExpectRelative(result.i0, i0, 8);
    ExpectRelative(result.i1, i1, 8);
    ExpectRelative(result.i2, i2, 8);
    EXPECT_EQ(BesselIScaled(-x).i1, -result.i1);
  }
  ExpectRelative(BesselIScaled(25.1).i0_minus_i1, 1.6108820759278226e-3, 16);
  ExpectRelative(BesselIScaled(1e6).i0_minus_i1, 1.9947121500246404e-10, 4);
  EXPECT_EQ(BesselIScaled(0).i0, 1);
  EXPECT_EQ(BesselIScaled(0).i1, 0);
}

TEST(Special, ScaledBesselRecurrence) {
  for (double x = 1e-3; x < 1e5; x *= 1.7) {
    const ScaledBesselI i = BesselIScaled(x);
    EXPECT_NEAR(i.i0 - 2 * i.i1 / x, i.i2, 16 * kEps * i.i0) << x;
    EXPECT_NEAR(i.i0 - i.i1, i.i0_minus_i1, 4 * kEps * i.i0) << x;
    EXPECT_EQ(BesselIScaled(-x).i0_minus_i1, i.i0_minus_i1);
  }
}

TEST(Special, SphericalBesselRatios) {
  struct Row {
    double k;
    int l;
    double ratio, derivative;
  };
  const std::array<Row, 16> reference = {{{0.02, 1, 6.6664888956611049e-3, 3.3330666835969355e-1},
                                          {0.02, 2, 3.9999542865269686e-3, 1.9999314306031199e-1},
                                          {0.02, 7, 1.3333312418359363e-3, 6.6666352942644186e-2},
                                          {0.02, 40, 2.4691356555623671e-4, 1.2345676808744319e-2},
                                          {1, 1, 3.130352854993313e-1, 2.7593833903368953e-1},
                                          {1, 2, 1.9452804946532511e-1, 1.8404664010991557e-1},
                                          {1, 7, 6.6407048633808958e-2, 6.5891423018421521e-2},
                                          {1, 40, 1.2343843210763595e-2, 1.2340172673700457e-2},
                                          {50, 1, 9.8e-1, 4.0e-4},
                                          {50, 2, 9.6040816326530612e-1, 7.8350687213660975e-4},
                                          {50, 7, 8.6853528280507348e-1, 2.4565833372904637e-3},
                                          {50, 40, 4.7826735624050389e-1, 6.0325659699127094e-3},
                                          {5000, 1, 9.998e-1, 4.0e-8},
                                          {5000, 2, 9.996000400080016e-1, 7.998399519871968e-8},
                                          {5000, 7, 9.9860084016769734e-1, 2.7966389944218195e-7},
                                          {5000, 40, 9.9203120575477831e-1, 1.5875166442490982e-6}}};
  for (const Row& row : reference) {
    std::vector<double> rho, derivative;
    SphericalBesselRatios(row.k, row.l, &rho, &derivative);
    ExpectRelative(rho[row.l], row.ratio, 4);
    EXPECT_NEAR(derivative[row.l], row.derivative, 1e-11 * row.derivative);
    ExpectRelative(rho[1], Langevin(row.k), 8);
  }
}

TEST(Special, Carlson) {
  struct Row {
    double x, y, z, rf, rd;
  };
  const std::array<Row, 7> reference = {{{1, 2, 0, 1.3110287771460599, 0},
                                         {0.5, 1, 2.5, 9.2298075280662474e-1, 4.9231373047778386e-1},
                                         {1, 1, 1, 1, 1},
                                         {1e-8, 0.25, 0.26, 3.1104723616519787, 1.8030757129075523e+1},
                                         {0.999, 1, 1.0001, 1.0001500707922163, 1.0002101366950189},
                                         {2, 3, 1e-5, 9.9978844691002589e-1, 3.8606286495726136e+2},
                                         {1e-12, 1e-4, 1, 5.9914893455080359, 1.4975141833421448e+1}}};
  for (const Row& row : reference) {
    ExpectRelative(CarlsonRF(row.x, row.y, row.z), row.rf, 6);
    ExpectRelative(CarlsonRF(row.z, row.x, row.y), row.rf, 6);
    if (row.z > 0) ExpectRelative(CarlsonRD(row.x, row.y, row.z), row.rd, 8);
  }
}

TEST(Special, CancellationFreeTrigonometry) {
  for (const double x : {1e-8, 1e-3, 0.5, 0.999, 1.001, 2.0}) {
    EXPECT_NEAR(OneMinusCos(x) * (1 + std::cos(x)), std::sin(x) * std::sin(x), 4 * kEps * std::sin(x) * std::sin(x));
    EXPECT_NEAR(XMinusSin(x) + std::sin(x), x, 2 * kEps * x);
    EXPECT_EQ(XMinusSin(-x), -XMinusSin(x));
  }
  ExpectRelative(XMinusSin(1e-3), 1.6666665833333353e-10, 4);
  for (const double x : {1e-8, 0.1, 0.4999, 0.5001, 0.999}) {
    EXPECT_NEAR(AtanhMinusX(x) + x, std::atanh(x), 2 * kEps * std::atanh(x));
    EXPECT_EQ(AtanhMinusX(-x), -AtanhMinusX(x));
  }
  EXPECT_EQ(AtanhMinusX(0), 0);
  ExpectRelative(AtanhMinusX(1e-3), 3.3333353333347621e-10, 4);
  ExpectRelative(AtanhMinusX(0.25), 5.4128118829953416e-3, 4);
}

// mpmath, 40 digits.
TEST(Special, GammaHalfRatio) {
  const double reference[][3] = {{0.01, 0.017483353835975519346, 98.645897933705096718},
                                 {0.5, 0.56418958354775628695, 1.3862943611198906188},
                                 {1.1, 0.9392070491651822066, 0.54980239318455299602},
                                 {15.9, 3.9562603126057745162, 0.031940739355319313875},
                                 {40.0, 6.3048224474268303946, 0.012578118898390458475}};
  for (const auto& [x, ratio, dlog] : reference) {
    double found;
    ExpectRelative(GammaHalfRatio(x, &found), ratio, 16);
    ExpectRelative(found, dlog, 16);
  }
}

}  // namespace
}  // namespace lobefit

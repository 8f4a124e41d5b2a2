#include <tuple>

#include "tests/maps/texels.h"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kDegree = kPi / 180;

MapPoint SomePoint(MapLobe lobe) {
  MapPoint point;
  point.normal = Normalized(Vec3{0.3, -0.2, 0.9});
  point.width = {-1.3, lobe == MapLobe::kGgxAnisotropic ? 0.07 : 0.0, lobe == MapLobe::kGgxAnisotropic ? -1.9 : -1.3};
  point.diffuse = {0.3, 0.1, 0.2}, point.f0 = {0.4, 0.5, 0.1};
  return point;
}

class EachLobe : public testing::TestWithParam<MapLobe> {};
INSTANTIATE_TEST_SUITE_P(Lobes, EachLobe, testing::Values(MapLobe::kGgx, MapLobe::kGgxAnisotropic));

// The oracle is core's lobe, evaluated with both directions turned into the frame of the normal.
TEST_P(EachLobe, AgreesWithCoreInTheTurnedFrame) {
  const MapPoint point = SomePoint(GetParam());
  const MapFrame frame = FrameOf(point.normal);
  const std::vector<Vec3> directions = DomeLights(50, 85 * kDegree);
  LightArrays lights;
  lights.Resize(directions.size());
  for (std::size_t l = 0; l < directions.size(); ++l) lights.Set(l, directions[l], {0, 0, 1}, true);
  ShapeArrays shape;
  shape.Resize(lights.padded);
  EvaluateShape(GetParam(), point, lights, false, &shape);
  SlopeCoordinates slopes;
  for (double& v : slopes.v) v = 0;
  slopes.v[2] = point.width[0], slopes.v[3] = point.width[1], slopes.v[4] = point.width[2];
  int below = 0;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const auto local = [&](const Vec3& w) { return Vec3{Dot(frame.t, w), Dot(frame.b, w), Dot(frame.n, w)}; };
    const Vec3 wi = local(directions[l]), wo = local({0, 0, 1});
    if (wi.z <= 0) {
      ++below;
      EXPECT_EQ(shape.cosine[l], 0);
      EXPECT_EQ(shape.specular[l], 0);
      continue;
    }
    double cos_d;
    const double expected = wi.z * GgxLobe(wi, wo, slopes, Masking::kSmithSeparable, &cos_d, nullptr);
    EXPECT_NEAR(shape.specular[l], expected, 1e-12 * expected);
    EXPECT_NEAR(shape.cosine[l], wi.z, 1e-14);
    EXPECT_NEAR(lights.k[l], std::pow(1 - cos_d, 5), 1e-13);
  }
  EXPECT_GT(below, 0);
}

TEST_P(EachLobe, DerivativesAreThoseOfTheCost) {
  const MapModel model = {GetParam(), 3, true};
  TexelData data;
  const std::vector<Vec3> directions = DomeLights(41, 70 * kDegree);
  data.Resize(directions.size());
  RandomNumbers random(4);
  for (std::size_t l = 0; l < directions.size(); ++l) {
    data.lights.Set(l, directions[l], {0, 0, 1}, true);
    for (int c = 0; c < 3; ++c) data.value[c][l] = random.Uniform();
  }
  data.scale = 0.7;
  TexelObjective objective;
  objective.Resize(data.lights.padded);
  const MapPoint point = SomePoint(GetParam());
  const double loss = 0.4;
  MapVector gradient;
  MapMatrix hessian;
  objective.Derivatives(model, data, point, loss, Curvature::kWhole, &gradient, &hessian);
  const MapFrame frame = FrameOf(point.normal);
  for (int j = 0; j < model.Unknowns(); ++j) {
    const auto moved = [&](double step) {
      MapPoint p = point;
      if (j < 2) {
        p.normal = Normalized(point.normal + step * (j == 0 ? frame.t : frame.b));
      } else if (j < model.Shape()) {
        p.width[static_cast<std::size_t>(j - 2)] += step;
      } else {
        const int at = j - model.Shape();
        (at % 2 == 0 ? p.diffuse : p.f0)[static_cast<std::size_t>(at / 2)] += step;
      }
      return objective.Cost(model, data, p, loss);
    };
    // Fourth-order central differences.
    const double h = 2e-4;
    const double expected = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
    EXPECT_NEAR(gradient[static_cast<std::size_t>(j)], expected, 1e-9) << "unknown " << j;
  }
}

// The matrix and the errors against their definitions, with the model's derivatives by differences: sum w J^T J + bend
// (J^T r)(J^T r)^T, and what the solution moves by, to first order, where one light after the other is left out,
// kJackknife of the way from what its residual as it is says.
class EachModel : public testing::TestWithParam<std::tuple<MapLobe, int>> {};
INSTANTIATE_TEST_SUITE_P(Models, EachModel,
                         testing::Combine(testing::Values(MapLobe::kNone, MapLobe::kGgx, MapLobe::kGgxAnisotropic),
                                          testing::Values(1, 3)));

TEST_P(EachModel, MatrixAndErrorsAreThoseOfTheirDefinitions) {
  const auto [lobe, channels] = GetParam();
  const MapModel model = {lobe, channels, true};
  const std::vector<Vec3> directions = DomeLights(43, 60 * kDegree);
  TexelData data;
  data.Resize(directions.size());
  data.scale = 0.7;
  TexelObjective objective;
  objective.Resize(data.lights.padded);
  const MapPoint point = SomePoint(lobe == MapLobe::kNone ? MapLobe::kGgx : lobe);
  MapVector gradient;
  MapMatrix hessian;
  // Values near the model's, with noise and an outlier.
  for (std::size_t l = 0; l < directions.size(); ++l) data.lights.Set(l, directions[l], {0, 0, 1}, true);
  const double loss = 0.1;
  objective.Derivatives(model, data, point, loss, Curvature::kWhole, &gradient, &hessian);
  RandomNumbers random(6);
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
    for (std::size_t l = 0; l < directions.size(); ++l) {
      const double exact = objective.residual(static_cast<int>(c))[l] + data.value[c][l];
      data.value[c][l] = exact * (l == 7 ? 0.5 : 1 + 0.03 * random.Normal());
    }
  }
  objective.Derivatives(model, data, point, loss, Curvature::kWhole, &gradient, &hessian);
  const MapErrors errors = ErrorsOf(
      model, data, point, {.amplitudes = {false, false, 1e6}, .least_width = -5, .most_width = 0}, loss, &objective);
  ASSERT_TRUE(errors.regular);
  const auto unknowns = static_cast<std::size_t>(model.Unknowns());
  const MapFrame frame = FrameOf(point.normal);
  // J[c][l][j].
  std::vector<std::vector<std::vector<double>>> J(
      static_cast<std::size_t>(channels),
      std::vector<std::vector<double>>(directions.size(), std::vector<double>(unknowns)));
  for (std::size_t j = 0; j < unknowns; ++j) {
    const double h = 1e-4;
    for (const double step : {h, -h}) {
      MapPoint p = point;
      if (j < 2) {
        p.normal = Normalized(point.normal + step * (j == 0 ? frame.t : frame.b));
      } else if (static_cast<int>(j) < model.Shape()) {
        p.width[j - 2] += step;
      } else {
        const std::size_t at = j - static_cast<std::size_t>(model.Shape()),
                          per = static_cast<std::size_t>(model.PerChannel());
        (at % per == 0 ? p.diffuse : p.f0)[at / per] += step;
      }
      MapVector g;
      MapMatrix m;
      objective.Derivatives(model, data, p, loss, Curvature::kWhole, &g, &m);
      for (std::size_t c = 0; c < J.size(); ++c) {
        for (std::size_t l = 0; l < directions.size(); ++l) {
          J[c][l][j] += objective.residual(static_cast<int>(c))[l] / (2 * step);
        }
      }
    }
  }
  objective.Derivatives(model, data, point, loss, Curvature::kWhole, &gradient, &hessian);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(model.Unknowns(), model.Unknowns());
  std::vector<Eigen::MatrixXd> parts;
  std::vector<Eigen::VectorXd> slopes;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    double square = 0;
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(model.Unknowns(), model.Unknowns());
    Eigen::VectorXd row = Eigen::VectorXd::Zero(model.Unknowns());
    for (std::size_t c = 0; c < J.size(); ++c) {
      const double r = objective.residual(static_cast<int>(c))[l];
      const Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(J[c][l].data(), model.Unknowns());
      square += r * r, row += r * column, part += column * column.transpose();
    }
    const double w = 1 / (1 + square / (loss * loss));
    part = w * part - 2 * w * w / (loss * loss) * row * row.transpose();
    whole += part;
    parts.push_back(part), slopes.push_back(w * row);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(model.Unknowns(), model.Unknowns());
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const Eigen::VectorXd without = (whole - parts[l]).fullPivLu().solve(slopes[l]);
    const Eigen::VectorXd moved = kJackknife * without + (1 - kJackknife) * whole.fullPivLu().solve(slopes[l]);
    covariance += moved * moved.transpose();
  }
  for (std::size_t j = 0; j < unknowns; ++j) {
    for (std::size_t k = 0; k < unknowns; ++k) {
      const auto at = [&](const Eigen::MatrixXd& m, std::size_t a, std::size_t b) {
        return m(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      };
      const auto unit = [&](const Eigen::MatrixXd& m) { return std::sqrt(at(m, j, j) * at(m, k, k)); };
      EXPECT_NEAR(hessian[j][k], at(whole, j, k), 1e-6 * unit(whole)) << j << " " << k;
      EXPECT_NEAR(errors.covariance[j][k], at(covariance, j, k), 1e-4 * unit(covariance)) << j << " " << k;
    }
  }
}

TEST_P(EachLobe, NoiseFreeTexelsAreRecovered) {
  const Hills hills = MakeHills(24, GetParam());
  const std::vector<Vec3> lights = DomeLights(96, 65 * kDegree);
  test::TexelValues values(hills.maps, lights, 0, 0);
  MapRules rules;
  rules.lobe = GetParam(), rules.schlick = true;
  TexelFitter fitter(rules, {lights, {}}, 3);
  const char* width = GetParam() == MapLobe::kGgx ? "alpha" : "alpha_x";
  for (std::size_t t = 0; t < 24 * 24; ++t) {
    const TexelFit fit = fitter.Fit(values.Of(t, 1).data(), lights.size());
    EXPECT_LT(test::AngleBetween(fit.normal, test::NormalAt(hills.maps, t)), 1e-5 * kDegree) << t;
    for (int c = 0; c < 3; ++c) {
      const std::string channel(1, "RGB"[c]);
      EXPECT_NEAR(fit.diffuse[c], test::At(hills.maps, MapPart::kParameters, ("diffuse." + channel).c_str(), t), 1e-6);
      const double f0 = test::At(hills.maps, MapPart::kParameters, ("f0." + channel).c_str(), t);
      if (!std::isnan(f0)) {
        EXPECT_NEAR(fit.f0[c], f0, 1e-6) << t;
      }
    }
    const double alpha = test::At(hills.maps, MapPart::kParameters, width, t);
    EXPECT_EQ((fit.status & kMapNoLobe) != 0, std::isnan(alpha)) << t;
    if (std::isnan(alpha)) continue;
    EXPECT_NEAR(fit.alpha_x, alpha, 1e-6) << t;
    if (GetParam() == MapLobe::kGgx) continue;
    EXPECT_NEAR(fit.alpha_y, test::At(hills.maps, MapPart::kParameters, "alpha_y", t), 1e-6) << t;
    EXPECT_NEAR(fit.angle / kDegree, test::At(hills.maps, MapPart::kParameters, "angle_deg", t), 1e-4) << t;
  }
}

TEST(TexelFitter, OutliersAndSaturationCostLittle) {
  const Hills hills = MakeHills(16, MapLobe::kGgx);
  const std::vector<Vec3> lights = DomeLights(96, 65 * kDegree);
  test::TexelValues values(hills.maps, lights, 0.01, 0);
  MapRules rules;
  rules.schlick = true;
  TexelFitter fitter(rules, {lights, {}}, 3);
  double clean = 0, spoilt = 0;
  for (std::size_t t = 0; t < 16 * 16; ++t) {
    std::vector<float> v = values.Of(t, 1);
    clean += test::AngleBetween(fitter.Fit(v.data(), lights.size()).normal, test::NormalAt(hills.maps, t));
    for (std::size_t l = 0; l < lights.size(); l += 8) {
      for (std::size_t c = 0; c < 3; ++c) v[c * lights.size() + l] *= 0.4F;  // half a shadow
    }
    for (float& value : v) value = value > 0.3F ? std::numeric_limits<float>::infinity() : value;
    spoilt += test::AngleBetween(fitter.Fit(v.data(), lights.size()).normal, test::NormalAt(hills.maps, t));
  }
  EXPECT_LT(spoilt, 2 * clean);
}

// Values that no model of a texel follows leave many valleys: nearly all texels end in the lowest that descents from
// every start find, whatever is given up on the way.
TEST(TexelFitter, FindsTheLowestMinimumOfRoughTexels) {
  const Hills hills = MakeHills(64, MapLobe::kGgx, 0.6);
  const std::vector<Vec3> lights = DomeLights(48, 65 * kDegree);
  test::TexelValues values(hills.maps, lights, 0.4, 0.01);
  MapRules rules, every;
  every.every_start = true;
  TexelFitter quick(rules, {lights, {}}, 3), whole(every, {lights, {}}, 3);
  int texels = 0, above = 0;
  for (std::size_t t = 0; t < 64 * 64; t += 3) {
    const std::vector<float>& v = values.Of(t, 5);
    const double found = quick.Fit(v.data(), lights.size()).cost, lowest = whole.Fit(v.data(), lights.size()).cost;
    ++texels;
    above += found > lowest * (1 + 1e-6) ? 1 : 0;
  }
  EXPECT_LE(above, texels / 200) << texels;
}

TEST(TexelFitter, SaysWhatIsNotDetermined) {
  const std::vector<Vec3> lights = DomeLights(40, 60 * kDegree);
  MapRules rules;
  TexelFitter fitter(rules, {lights, {}}, 1);
  const std::vector<float> dark(lights.size(), 0.0F), nothing(lights.size(), std::numeric_limits<float>::quiet_NaN());
  for (const std::vector<float>& values : {dark, nothing}) {
    const TexelFit fit = fitter.Fit(values.data(), lights.size());
    EXPECT_EQ(fit.status, kMapTooFew | kMapNotDetermined);
    EXPECT_TRUE(std::isnan(fit.normal.z));
    EXPECT_TRUE(std::isnan(fit.diffuse[0]));
  }
  // A matt texel: no lobe, and so no width.
  std::vector<float> matt;
  RandomNumbers random(3);
  for (const Vec3& w : lights) matt.push_back(static_cast<float>(w.z * 0.1 * (1 + 0.02 * random.Normal())));
  const TexelFit fit = fitter.Fit(matt.data(), lights.size());
  EXPECT_EQ(fit.status, kMapNoLobe);
  EXPECT_TRUE(std::isnan(fit.alpha_x));
  EXPECT_LT(test::AngleBetween(fit.normal, {0, 0, 1}), 0.01);
  EXPECT_NEAR(fit.diffuse[0], 0.1 * kPi, 0.01);
}

}  // namespace
}  // namespace lobefit

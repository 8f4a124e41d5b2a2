#include <algorithm>
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
  std::vector<Eigen::VectorXd> slopes, pulls;  // J^T W r without the loss's bend, J^T W y
  double squares = 0, predicted = 0;
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
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(model.Unknowns());
    double along = 0;
    const auto prediction = [&](std::size_t c) {
      return objective.residual(static_cast<int>(c))[l] + data.value[c][l];
    };
    for (std::size_t c = 0; c < J.size(); ++c) along += objective.residual(static_cast<int>(c))[l] * prediction(c);
    for (std::size_t c = 0; c < J.size(); ++c) {
      const double r = objective.residual(static_cast<int>(c))[l];
      const Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(J[c][l].data(), model.Unknowns());
      pull += (w * prediction(c) - 2 * w * w / (loss * loss) * r * along) * column;
      squares += w * r * r, predicted += w * prediction(c) * prediction(c);
    }
    pulls.push_back(pull);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(model.Unknowns(), model.Unknowns());
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const Eigen::VectorXd without = (whole - parts[l]).fullPivLu().solve(slopes[l]);
    const Eigen::VectorXd moved = kJackknife * without + (1 - kJackknife) * whole.fullPivLu().solve(slopes[l]);
    covariance += moved * moved.transpose();
  }
  // Of the misfit's variance a quarter is smooth: between lights as the bumps about 16 directions overlap.
  const auto bumps = [&](std::size_t l) {
    Eigen::VectorXd b(16);
    for (int g = 0; g < 16; ++g) {
      const double z = 1 - (g + 0.5) / 16, turn = g * kPi * (3 - std::sqrt(5.0));
      const Vec3 center = FromSpherical(std::acos(z), turn);
      b(g) = std::pow((1 + Dot(center, directions[l])) / 2, 8);
    }
    return Eigen::VectorXd(b.normalized());
  };
  double doubt = 0;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const Eigen::Vector2d left = whole.fullPivLu().solve(pulls[l]).head(2);
    for (std::size_t m = 0; m < directions.size(); ++m) {
      const Eigen::Vector2d right = whole.fullPivLu().solve(pulls[m]).head(2);
      doubt += squares / predicted * (0.25 * bumps(l).dot(bumps(m)) + (l == m ? 0.75 : 0)) * left.dot(right);
    }
  }
  EXPECT_NEAR(errors.doubt, std::sqrt(doubt), 1e-5 * errors.doubt);
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

// Residuals whose products of 1 + r^2 / c^2 are large numbers.
TEST(TexelObjective, CostOfFarValuesIsThatOfTheirLogarithms) {
  const std::vector<Vec3> directions = DomeLights(43, 60 * kDegree);
  TexelData data;
  data.Resize(directions.size());
  TexelObjective objective;
  objective.Resize(data.lights.padded);
  const double loss = 0.05;
  double expected = 0;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    data.lights.Set(l, directions[l], {0, 0, 1}, false);
    data.value[0][l] = l % 3 == 0 ? 1e-6 : l % 3 == 1 ? 0.1 : 3e6;
    expected += 0.5 * loss * loss * std::log1p(data.value[0][l] * data.value[0][l] / (loss * loss));
  }
  EXPECT_NEAR(objective.Cost({MapLobe::kNone, 1, false}, data, {}, loss), expected, 1e-13 * expected);
}

// Light from a facing slope is a misfit that changes slowly with the light: errors from independent residuals see less
// of it than the doubt.
TEST(TexelFitter, DoubtSortsTexelsWhoseMisfitIsNoNoise) {
  const Hills hills = MakeHills(32, MapLobe::kGgx, 1.6);
  const std::vector<Vec3> lights = DomeLights(96, 60 * kDegree);
  test::TexelValues values(hills.maps, lights, 0.02, 0.001);
  TexelFitter fitter({}, {lights, {}}, 3);
  std::vector<std::pair<double, double>> by_error, by_doubt;
  for (std::size_t t = 0; t < 32 * 32; ++t) {
    std::vector<float> v = values.Of(t, 1);
    const Vec3 n = test::NormalAt(hills.maps, t), facing = {-n.x, -n.y, n.z};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double diffuse = static_cast<double>(hills.maps.rows.values[3 + i / lights.size()][t]);
      const double lit = std::max(0.0, Dot(facing, lights[i % lights.size()]));
      v[i] += static_cast<float>(0.25 * (1 - Dot(n, facing)) * diffuse * diffuse * kInvPi * lit);
    }
    const TexelFit fit = fitter.Fit(v.data(), lights.size());
    if (std::isnan(fit.normal.z)) continue;
    const double off = test::AngleBetween(fit.normal, n);
    by_error.emplace_back(fit.normal_angle_error, off), by_doubt.emplace_back(fit.normal_doubt, off);
  }
  const auto mean = [](std::vector<std::pair<double, double>> texels, std::size_t count) {
    std::sort(texels.begin(), texels.end());
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += texels[i].second;
    return sum / static_cast<double>(count);
  };
  const std::size_t all = by_doubt.size(), half = all / 2;
  std::printf("  surest half over all: %.3f by error, %.3f by doubt\n", mean(by_error, half) / mean(by_error, all),
              mean(by_doubt, half) / mean(by_doubt, all));
  EXPECT_LT(mean(by_doubt, half), 0.7 * mean(by_doubt, all));
  EXPECT_LT(mean(by_doubt, half), 0.9 * mean(by_error, half));
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

#include "lobefit/core/brdf/lobe.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/core/brdf/diffuse_facets.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/microfacet/diffuse_microfacets.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Pair {
  Vec3 wi, wo;
};

// Directions within 75 degrees of the normal.
std::vector<Pair> Pairs(std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto direction = [&] { return FromSpherical(1.3 * std::sqrt(unit(random)), 2 * kPi * unit(random)); };
    const Vec3 wi = direction();
    pairs.push_back({wi, direction()});
  }
  return pairs;
}

SlopeCoordinates ShapeFor(Ndf ndf) {
  if (IsTilted(ndf)) return SlopeCoordinatesFromEllipsoid({0.4, 0.22, 0.05, -0.04, 0.6});
  if (IsRound(ndf)) return SlopeCoordinatesFromEllipsoid({0.35, 0.35, 0, 0, 0});
  return SlopeCoordinatesFromEllipsoid({0.4, 0.22, 0, 0, 0.6});
}

// What a family has beside its ellipse.
std::vector<double> ProfileFor(const Lobe& lobe) {
  std::vector<double> profile = {3.1};
  const std::size_t size = ShapeParameters(lobe) - kEllipseParameters;
  for (std::size_t k = 0; FamilyOf(lobe.ndf) == Family::kProfile && k < size; ++k)
    profile.resize(k + 1, k % 2 == 0 ? 0.4 : -0.3);
  if (FamilyOf(lobe.ndf) == Family::kProfile) profile[0] = 0.7;
  return profile;
}

std::vector<Lobe> EveryLobe() {
  std::vector<Lobe> lobes;
  for (const Choice<Ndf>& ndf : NdfChoices()) {
    for (const Choice<Masking>& masking : MaskingChoices()) {
      const Fresnel fresnel = masking.value == Masking::kNone ? Fresnel::kNone : Fresnel::kSchlick;
      const Lobe lobe = {ndf.value, masking.value, fresnel};
      if (WhyNotEvaluable({{lobe}, Diffuse::kLambert}).empty()) lobes.push_back(lobe);
      Lobe retro = lobe;
      retro.direction = LobeDirection::kRetro;
      if (WhyNotEvaluable({{retro}, Diffuse::kLambert}).empty()) lobes.push_back(retro);
    }
  }
  return lobes;
}

std::string Name(const Lobe& lobe) {
  return std::string(NameOf(NdfChoices(), lobe.ndf)) + " " + NameOf(MaskingChoices(), lobe.masking) + " " +
         NameOf(LobeDirectionChoices(), lobe.direction);
}

// By the coordinates that a fit of the NDF moves. A lobe that may tilt has kinks where the masking of a direction
// begins; a pair of directions that lies on one by chance (differences by two steps disagree) is passed over.
TEST(SpecularLobe, GradientIsThatOfTheValue) {
  int kinks = 0;
  for (const Lobe& lobe : EveryLobe()) {
    SCOPED_TRACE(Name(lobe));
    const SlopeCoordinates ellipse = ShapeFor(lobe.ndf);
    const std::vector<double> profile = ProfileFor(lobe);
    const LobeShape shape(lobe, ellipse, profile);
    const std::size_t first = IsTilted(lobe.ndf) ? 0 : 2;
    const bool tabulated = shape.masking != nullptr;
    for (const Pair& pair : Pairs(tabulated ? 10 : 40)) {
      std::vector<double> gradient(ShapeParameters(lobe));
      double cos_d = 0;
      const double value = SpecularLobe(pair.wi, pair.wo, lobe, shape, &cos_d, gradient.data());
      EXPECT_EQ(value, SpecularLobe(pair.wi, pair.wo, lobe, shape, &cos_d, nullptr));
      for (std::size_t j = first; j < ShapeParameters(lobe); ++j) {
        const auto at = [&](double by) {
          SlopeCoordinates moved = ellipse;
          std::vector<double> changed = profile;
          (j < kEllipseParameters ? moved.v[j] : changed[j - kEllipseParameters]) += by;
          if (j < kEllipseParameters && tabulated) {
            LobeShape other = shape;  // the table does not depend on the ellipse
            other.slope = moved;
            return SpecularLobe(pair.wi, pair.wo, lobe, other, &cos_d, nullptr);
          }
          return SpecularLobe(pair.wi, pair.wo, lobe, LobeShape(lobe, moved, changed), &cos_d, nullptr);
        };
        const auto slope = [&](double h) { return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h); };
        const double difference = slope(1e-5), wider = slope(4e-5);
        if (std::fabs(difference - wider) > 1e-6 * (value + std::fabs(difference))) {
          ++kinks;
          continue;
        }
        // The table of a profile's masking is smooth to its second derivative only.
        const double tolerance = tabulated ? 2e-7 : 1e-8;
        EXPECT_NEAR(gradient[j], difference, tolerance * (value + std::fabs(difference)) + 1e-12) << j;
      }
    }
  }
  EXPECT_LE(kinks, 4);  // of some 9000 derivatives
}

TEST(SpecularLobe, IsReciprocalAndTheSameInArrays) {
  const std::vector<Pair> pairs = Pairs(33);
  std::vector<double> fields[6];
  for (const Pair& pair : pairs) {
    const double all[6] = {pair.wi.x, pair.wi.y, pair.wi.z, pair.wo.x, pair.wo.y, pair.wo.z};
    for (std::size_t k = 0; k < 6; ++k) fields[k].push_back(all[k]);
  }
  const DirectionArrays arrays = {fields[0].data(), fields[1].data(), fields[2].data(), fields[3].data(),
                                  fields[4].data(), fields[5].data(), pairs.size()};
  for (const Lobe& lobe : EveryLobe()) {
    SCOPED_TRACE(Name(lobe));
    const LobeShape shape(lobe, ShapeFor(lobe.ndf), ProfileFor(lobe));
    const std::size_t size = ShapeParameters(lobe);
    std::vector<double> specular(pairs.size()), cos_d(pairs.size()), gradient(size * pairs.size());
    SpecularLobe(arrays, lobe, shape, specular.data(), cos_d.data(), gradient.data());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      double c = 0;
      std::vector<double> g(size);
      const double value = SpecularLobe(pairs[i].wi, pairs[i].wo, lobe, shape, &c, g.data());
      EXPECT_EQ(value, specular[i]);
      EXPECT_EQ(c, cos_d[i]);
      for (std::size_t j = 0; j < size; ++j) EXPECT_EQ(g[j], gradient[j * pairs.size() + i]);
      EXPECT_NEAR(SpecularLobe(pairs[i].wo, pairs[i].wi, lobe, shape, &c, nullptr), value, 1e-13 * value);
    }
  }
}

// Two implementations of GGX: in SIMD by slope coordinates, and through the general microfacet BRDF.
TEST(SpecularLobe, GgxIsTheGeneralMicrofacetBrdf) {
  const SlopeCoordinates shape = ShapeFor(Ndf::kEllipsoid);
  std::vector<double> jacobian;
  const std::unique_ptr<NormalDistribution> distribution = DistributionOf({Ndf::kEllipsoid}, shape, &jacobian);
  for (const Masking masking : {Masking::kSmithSeparable, Masking::kSmithUnclamped, Masking::kSmithHeight}) {
    for (const Pair& pair : Pairs(60)) {
      double c = 0, by_shape[5], by_parameter[5];
      const double value = SpecularLobe(pair.wi, pair.wo, {Ndf::kEllipsoid, masking}, shape, &c, by_shape);
      const double general =
          MicrofacetSpecular(*distribution, ShadowingOf(masking, shape), pair.wo, pair.wi, by_parameter);
      EXPECT_NEAR(value, general, 1e-12 * general);
      for (std::size_t j = 0; j < 5; ++j) {
        double chained = 0;
        for (std::size_t k = 0; k < 5; ++k) chained += by_parameter[k] * jacobian[5 * k + j];
        EXPECT_NEAR(by_shape[j], chained, 1e-11 * general);
      }
    }
  }
}

// The tables that fits evaluate against the general form of the same lobe.
TEST(SpecularLobe, ProfilesAreTheGeneralMicrofacetBrdf) {
  for (const Ndf ndf : {Ndf::kProfileEllipsoid, Ndf::kStudentEllipsoid}) {
    for (const Masking masking : {Masking::kSmithSeparable, Masking::kSmithUnclamped, Masking::kSmithHeight}) {
      const Lobe lobe = {ndf, masking};
      const LobeShape shape(lobe, ShapeFor(ndf), ProfileFor(lobe));
      const std::size_t size = ShapeParameters(lobe);
      std::vector<double> jacobian, by_shape(size), by_parameter(size);
      const std::unique_ptr<NormalDistribution> distribution = DistributionOf(lobe, shape, &jacobian);
      for (const Pair& pair : Pairs(60)) {
        double c = 0;
        const double value = SpecularLobe(pair.wi, pair.wo, lobe, shape, &c, by_shape.data());
        const double general =
            MicrofacetSpecular(*distribution, ShadowingOf(masking, shape.slope), pair.wo, pair.wi, by_parameter.data());
        EXPECT_NEAR(value, general, 1e-11 * general);
        for (std::size_t j = 0; j < size; ++j) {
          double chained = 0;
          for (std::size_t k = 0; k < size; ++k) chained += by_parameter[k] * jacobian[size * k + j];
          EXPECT_NEAR(by_shape[j], chained, 1e-9 * (general + std::fabs(chained))) << j;
        }
      }
    }
  }
}

// Coefficients of 0 and gamma = 2: the same bits, through the tables.
TEST(SpecularLobe, ProfileOfNothingIsGgxToTheBit) {
  for (const Masking masking : {Masking::kSmithSeparable, Masking::kSmithUnclamped, Masking::kSmithHeight}) {
    const SlopeCoordinates ellipse = ShapeFor(Ndf::kEllipsoid);
    const Lobe ggx = {Ndf::kEllipsoid, masking}, profile = {Ndf::kProfileEllipsoid, masking},
               student = {Ndf::kStudentEllipsoid, masking};
    for (const Pair& pair : Pairs(60)) {
      double c = 0;
      const double value = SpecularLobe(pair.wi, pair.wo, ggx, ellipse, &c, nullptr);
      const std::vector<double> zero(ShapeParameters(profile) - kEllipseParameters, 0.0);
      EXPECT_EQ(SpecularLobe(pair.wi, pair.wo, profile, LobeShape(profile, ellipse, zero), &c, nullptr), value);
      EXPECT_EQ(SpecularLobe(pair.wi, pair.wo, student, LobeShape(student, ellipse, {2.0}), &c, nullptr), value);
    }
  }
}

// What the alphas of the families mean, from their printed formulas.
TEST(DistributionOf, AlphaOfEachFamily) {
  const double alpha = 0.3, theta = 0.4;
  const Vec3 m = FromSpherical(theta, 1);
  const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid({alpha, alpha, 0, 0, 0});
  const double tan = std::tan(theta), cos = std::cos(theta);
  const double beckmann = std::exp(-tan * tan / (alpha * alpha)) / (kPi * alpha * alpha * std::pow(cos, 4));
  EXPECT_NEAR(DistributionOf({Ndf::kBeckmann}, shape, nullptr)->D(m), beckmann, 1e-13 * beckmann);
  // Ratios to the peak: exp(k (cos - 1)), and (1 - b) / (1 - b cos).
  const auto ratio = [&](Ndf ndf) {
    const std::unique_ptr<NormalDistribution> d = DistributionOf({ndf}, shape, nullptr);
    return d->D(m) / d->D({0, 0, 1});
  };
  EXPECT_NEAR(ratio(Ndf::kSphericalGaussian), std::exp(2 / (alpha * alpha) * (cos - 1)), 1e-13);
  const double b = 1 / (1 + alpha * alpha / 2);
  EXPECT_NEAR(ratio(Ndf::kKagiwadaKalaba), (1 - b) / (1 - b * cos), 1e-13);
}

TEST(DistributionOf, BeckmannWithoutTiltHasItsOwnAlphas) {
  const Ellipsoid e = {0.5, 0.2, 0, 0, 0.7};
  const std::unique_ptr<NormalDistribution> d =
      DistributionOf({Ndf::kBeckmannAnisotropic}, SlopeCoordinatesFromEllipsoid(e), nullptr);
  const Vec3 m = FromSpherical(0.3, 0.5);
  // theta_z turns the axes clockwise.
  const double x = m.x * std::cos(e.theta_z) - m.y * std::sin(e.theta_z),
               y = m.x * std::sin(e.theta_z) + m.y * std::cos(e.theta_z);
  const double exponent = (x * x / 0.25 + y * y / 0.04) / (m.z * m.z);
  const double expected = std::exp(-exponent) / (kPi * 0.1 * std::pow(m.z, 4));
  EXPECT_NEAR(d->D(m), expected, 1e-12 * expected);
}

TEST(FresnelFactorTest, ValuesAndDerivatives) {
  const double conductor[] = {0.2, 3.9}, dielectric[] = {1.5}, f0[] = {0.04}, scale[] = {2.5}, f82[] = {0.6, 0.8},
               curve[] = {0.9, 0.5, 0.2, 0.1, 0.15, 0.3}, coat[] = {1.5, 0.2};
  const std::pair<Fresnel, const double*> cases[] = {
      {Fresnel::kConductor, conductor}, {Fresnel::kDielectric, dielectric}, {Fresnel::kSchlick, f0},
      {Fresnel::kSchlickF82, f82},      {Fresnel::kCurve, curve},           {Fresnel::kNone, scale},
      {Fresnel::kCoatLayered, coat},    {Fresnel::kCoatRefracted, coat}};
  for (const auto& [fresnel, parameters] : cases) {
    for (const double cos_d : {0.05, 0.4, 0.9, 1.0}) {
      double dF[kMaxFresnelParameters];
      EXPECT_EQ(FresnelFactor(fresnel, parameters, cos_d, dF), FresnelFactor(fresnel, parameters, cos_d, nullptr));
      for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k) {
        std::vector<double> up(parameters, parameters + FresnelParameters(fresnel)), down = up;
        up[k] += 1e-5;
        down[k] -= 1e-5;
        const double difference =
            (FresnelFactor(fresnel, up.data(), cos_d, nullptr) - FresnelFactor(fresnel, down.data(), cos_d, nullptr)) /
            2e-5;
        EXPECT_NEAR(dF[k], difference, 1e-9) << k;
      }
    }
  }
  EXPECT_NEAR(FresnelFactor(Fresnel::kDielectric, dielectric, 1, nullptr), 0.04, 1e-15);
  EXPECT_EQ(FresnelFactor(Fresnel::kConductor, conductor, 0.5, nullptr), FresnelConductor(0.5, {0.2, 3.9}));
}

std::vector<Lobe> FacetLobes() {
  return {{Ndf::kEllipsoid, Masking::kSmithSeparable},
          {Ndf::kBeckmannAnisotropic, Masking::kSmithHeight},
          {Ndf::kGgx, Masking::kSmithHeightDirection}};
}

TEST(DiffuseFacets, AgreeWithTheAdaptiveIntegral) {
  for (const Lobe& lobe : FacetLobes()) {
    SCOPED_TRACE(Name(lobe));
    const SlopeCoordinates shape = ShapeFor(lobe.ndf);
    const DiffuseFacets facets(lobe, shape);
    const std::unique_ptr<NormalDistribution> distribution = DistributionOf(lobe, shape, nullptr);
    for (const Pair& pair : Pairs(25)) {
      const double expected =
          DiffuseMicrofacetBrdf(*distribution, ShadowingOf(lobe.masking, shape), pair.wo, pair.wi, nullptr, 1e-6);
      EXPECT_NEAR(facets.Evaluate(pair.wi, pair.wo, nullptr), expected, 2e-3 * expected);
    }
  }
}

TEST(DiffuseFacets, GradientIsThatOfTheValue) {
  for (const Lobe& lobe : FacetLobes()) {
    SCOPED_TRACE(Name(lobe));
    const SlopeCoordinates shape = ShapeFor(lobe.ndf);
    for (const Pair& pair : Pairs(25)) {
      double gradient[5];
      const double value = DiffuseFacets(lobe, shape).Evaluate(pair.wi, pair.wo, gradient);
      for (std::size_t j = IsTilted(lobe.ndf) ? 0 : 2; j < 5; ++j) {
        SlopeCoordinates up = shape, down = shape;
        up.v[j] += 1e-6;
        down.v[j] -= 1e-6;
        const double difference = (DiffuseFacets(lobe, up).Evaluate(pair.wi, pair.wo, nullptr) -
                                   DiffuseFacets(lobe, down).Evaluate(pair.wi, pair.wo, nullptr)) /
                                  2e-6;
        // A node that crosses an edge within the step costs up to its share of the sum.
        EXPECT_NEAR(gradient[j], difference, 1e-5 * value) << j;
      }
    }
  }
}

TEST(DiffuseFacets, OfANarrowLobeAreLambertian) {
  const Lobe lobe = {Ndf::kGgx, Masking::kSmithSeparable};
  const DiffuseFacets facets(lobe, SlopeCoordinatesFromEllipsoid({0.001, 0.001, 0, 0, 0}));
  for (const Pair& pair : Pairs(20)) EXPECT_NEAR(facets.Evaluate(pair.wi, pair.wo, nullptr), kInvPi, 2e-3 * kInvPi);
}

TEST(WhyNotEvaluable, NamesWhatWouldWork) {
  EXPECT_NE(WhyNotEvaluable({{{Ndf::kEllipsoid, Masking::kVCavity}}, Diffuse::kLambert}).find("ggx-anisotropic"),
            std::string::npos);
  EXPECT_NE(WhyNotEvaluable({{{Ndf::kGgx, Masking::kKelemen}}, Diffuse::kMicrofacet}).find("Smith"), std::string::npos);
  EXPECT_NE(WhyNotEvaluable({{{Ndf::kKagiwadaKalaba}}, Diffuse::kMicrofacet}).find("Beckmann"), std::string::npos);
  EXPECT_EQ(WhyNotEvaluable({{{Ndf::kKagiwadaKalaba}}, Diffuse::kLambert}), "");
}

TEST(WhyNotEvaluable, ACoatLiesOverSomethingOnceAndAboutTheNormal) {
  const Lobe coat = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered};
  EXPECT_EQ(WhyNotEvaluable({{coat}, Diffuse::kLambert}), "");
  EXPECT_EQ(WhyNotEvaluable({{{Ndf::kEllipsoid}, coat}, Diffuse::kNone}), "");
  EXPECT_NE(WhyNotEvaluable({{coat}, Diffuse::kNone}).find("over something"), std::string::npos);
  EXPECT_NE(WhyNotEvaluable({{coat, coat}, Diffuse::kLambert}).find("one coat"), std::string::npos);
  EXPECT_NE(WhyNotEvaluable({{coat}, Diffuse::kOrenNayar}).find("lambert or none"), std::string::npos);
  Lobe wrong = coat;
  wrong.ndf = Ndf::kEllipsoid;
  EXPECT_NE(WhyNotEvaluable({{wrong}, Diffuse::kLambert}).find("ggx-anisotropic"), std::string::npos);
  wrong = coat;
  wrong.direction = LobeDirection::kRetro;
  EXPECT_NE(WhyNotEvaluable({{wrong}, Diffuse::kLambert}).find("mirror direction"), std::string::npos);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/fit/inference/rivals.h"

#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

GoniometerLayout InPlane(double azimuth_deg) {
  GoniometerLayout layout = StandardLayout();
  layout.azimuths = {DegreesToRadians(azimuth_deg)};
  layout.in_plane = true;
  return layout;
}

Recipe EllipsoidRecipe() { return DefaultRecipe(OneLobe(Ndf::kEllipsoid, 0.3, 0.1, 0, 0, 0).model, "ellipsoid"); }

std::size_t Sentences(const Material& material, const std::string& words) {
  std::size_t count = 0;
  for (const std::string& sentence : material.degenerate) count += sentence.find(words) != std::string::npos ? 1 : 0;
  return count;
}

bool Names(const Material& material, const std::string& words) { return Sentences(material, words) > 0; }

// A lobe turned by 25 degrees and one turned by -25 look the same to a detector in the plane of incidence.
TEST(Rivals, TheMirrorImageOfALobeIsNamedForSamplesInOnePlane) {
  for (const double plane_deg : {0.0, 40.0}) {
    const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, plane_deg + 25);
    Measurement measurement = Synthetic(truth, InPlane(plane_deg), 0.02, 1);
    const Material material = CheckedFit(EllipsoidRecipe(), {}, &measurement);
    EXPECT_TRUE(Names(material, "the mirror image of the solution fits as well: ")) << plane_deg;
    EXPECT_EQ(Sentences(material, "fits as well"), 1U) << "the search finds it too; it is named once";
    EXPECT_FALSE(material.termination.determined);
    EXPECT_TRUE(std::isnan(material.parameters[4].standard_error[0]));
    EXPECT_FALSE(std::isnan(material.parameters[0].standard_error[0])) << "both images have the same alphas";
    // The two solutions lie on either side of the plane.
    const double turn = std::remainder(material.parameters[4].values[0] - DegreesToRadians(plane_deg), kPi);
    EXPECT_NEAR(std::fabs(turn), DegreesToRadians(25), DegreesToRadians(5));
  }
}

TEST(Rivals, ALobeThatIsItsOwnMirrorImageHasNone) {
  const SyntheticCase truth = OneLobe(Ndf::kGgxTilted, 0.3, 0.3, 0, 5, 0);
  Measurement measurement = Synthetic(truth, InPlane(0), 0.02, 1);
  Recipe recipe = DefaultRecipe(truth.model, "tilted");
  recipe.parameters[2].fixed = {0};
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_FALSE(Names(material, "fits as well"));
  EXPECT_TRUE(material.termination.determined);
}

// Minima that the search is said to have found, on a measurement that determines all.
class FoundMinima : public ::testing::Test {
 protected:
  FoundMinima()
      : measurement_(Synthetic(OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25), StandardLayout(), 0.05, 1)),
        material_(CheckedFit(EllipsoidRecipe(), {}, &measurement_)),
        layout_(EllipsoidRecipe(), measurement_.channels.names),
        problem_(measurement_.samples, EllipsoidRecipe()),
        pool_(1) {
    DistinctMinimum best;
    best.solution.u = Point(1);
    best.solution.cost = material_.cost;
    best.solution.converged = true;
    minima_ = {best, best};
  }

  // The fit, alpha_y times `factor`.
  std::vector<double> Point(double factor) const {
    const auto value = [&](std::size_t i) { return material_.parameters[i].values[0]; };
    std::vector<double> u = layout_.FromShapes({{value(0), factor * value(1), value(2), value(3), value(4)}});
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 2; ++k)
        u[static_cast<std::size_t>(layout_.linear(c)[k].index)] = material_.parameters[5 + k].values[c];
    }
    return u;
  }

  // alpha_y times `factor`, cost higher by `variances` of one residual.
  bool Flagged(double factor, double variances) {
    minima_[1].solution.u = Point(factor);
    const double residuals = static_cast<double>(problem_.size() * problem_.channels() - layout_.size());
    minima_[1].solution.cost = material_.cost * (1 + variances / residuals);
    Material material = material_;
    const bool flagged = FlagRivals(problem_, layout_, measurement_.samples, minima_, &pool_, &material);
    EXPECT_EQ(flagged, material.degenerate.size() > material_.degenerate.size());
    EXPECT_EQ(flagged, std::isnan(material.parameters[1].standard_error[0]));
    return flagged;
  }

  Measurement measurement_;
  Material material_;
  Layout layout_;
  Problem problem_;
  ThreadPool pool_;
  std::vector<DistinctMinimum> minima_;
};

TEST_F(FoundMinima, ASecondOneThatFitsAsWellElsewhereIsNamed) {
  EXPECT_TRUE(Flagged(0.9, 3));
  EXPECT_TRUE(Flagged(1.1, 0));
}

TEST_F(FoundMinima, OneThatFitsWorseIsNot) { EXPECT_FALSE(Flagged(0.9, 5)); }

TEST_F(FoundMinima, OneAtTheSamePlaceIsNot) {
  const double error = material_.parameters[1].standard_error[0] / material_.parameters[1].values[0];
  EXPECT_FALSE(Flagged(1 + 0.5 * error, 0));
}

// Across theta_z = 90 degrees the reported tilts change sign.
TEST(Rivals, OneLobeOnBothSidesOfTheCutOfItsAnglesIsNoRival) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 90);
  Measurement measurement = Synthetic(truth, StandardLayout(), 0.05, 1);
  Material material = CheckedFit(EllipsoidRecipe(), {}, &measurement);
  const auto value = [&](std::size_t i) { return material.parameters[i].values[0]; };
  const double across = std::copysign(kPi / 2, value(4)) - value(4);  // to the cut
  ASSERT_LT(std::fabs(across), 1.9 * material.parameters[4].standard_error[0]);
  const Layout layout(EllipsoidRecipe(), measurement.channels.names);
  const Problem problem(measurement.samples, EllipsoidRecipe());
  ThreadPool pool(1);
  std::vector<DistinctMinimum> minima(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const double turn = k == 0 ? 0 : 1.01 * across;
    minima[k].solution.u = layout.FromShapes({{value(0), value(1), value(2), value(3), value(4) + turn}});
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 2; ++i)
        minima[k].solution.u[static_cast<std::size_t>(layout.linear(c)[i].index)] =
            material.parameters[5 + i].values[c];
    }
    minima[k].solution.cost = material.cost;
    minima[k].solution.converged = true;
  }
  ASSERT_LT(layout.Report(minima[1].solution.u.data())[4][0] * value(4), 0) << "on the other side";
  EXPECT_FALSE(FlagRivals(problem, layout, measurement.samples, minima, &pool, &material));
}

// Its Fresnel reflectance, not its shape.
TEST_F(FoundMinima, OneThatDiffersInAReflectanceIsNamed) {
  minima_[1].solution.u[static_cast<std::size_t>(layout_.linear(1)[0].index)] *= 0.9;
  Material material = material_;
  EXPECT_TRUE(FlagRivals(problem_, layout_, measurement_.samples, minima_, &pool_, &material));
  EXPECT_TRUE(Names(material, "f0[G] ")) << material.degenerate.back();
  EXPECT_TRUE(std::isnan(material.parameters[5].standard_error[1]));
  EXPECT_FALSE(std::isnan(material.parameters[5].standard_error[0]));
}

TEST_F(FoundMinima, OneThatWasNotFoundOnAllSamplesOrNotToTheEndIsNot) {
  minima_[1].on_all_samples = false;
  EXPECT_FALSE(Flagged(0.9, 0));
  minima_[1].on_all_samples = true;
  minima_[1].solution.converged = false;
  EXPECT_FALSE(Flagged(0.9, 0));
}

}  // namespace
}  // namespace lobefit

#include "lobefit/validate/truth.h"

#include <cmath>
#include <fstream>

#include "tests/support/temporary_file.h"
#include "tests/validate/brushed.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/io/read.h"
#include "lobefit/recipe/recipe.h"
#include "lobefit/validate/experiment.h"
#include "lobefit/validate/truth_file.h"

namespace lobefit {
namespace {

Ellipsoid FirstLobe(const ParameterValues& v) { return {v[0][0], v[1][0], v[2][0], v[3][0], v[4][0]}; }

TEST(Truth, AlignedWritingIsTheSameDistributionNearTheReportedAngle) {
  Truth truth = test::BrushedMetal();
  truth.values[2] = {0.1};
  truth.values[4] = {DegreesToRadians(89)};
  ParameterValues reported = truth.values;
  reported[4] = {DegreesToRadians(-90)};  // one degree away, written on the other side
  const ParameterValues aligned = AlignedWith(reported, truth);
  EXPECT_NEAR(RadiansToDegrees(aligned[4][0]), -91, 1e-9);
  EXPECT_NEAR(aligned[2][0], -truth.values[2][0], 1e-12);
  EXPECT_NEAR(aligned[3][0], -truth.values[3][0], 1e-12);
  for (const Vec3& m : {Vec3{0.1, 0.2, 0.97}, Vec3{-0.3, 0.1, 0.9}}) {
    const double expected = EllipsoidD(FirstLobe(truth.values), Normalized(m));
    EXPECT_NEAR(EllipsoidD(FirstLobe(aligned), Normalized(m)), expected, 1e-12 * expected);
  }
  // A truth whose axes are given in the other order is sorted.
  truth.values[0].swap(truth.values[1]);
  EXPECT_NEAR(AlignedWith(reported, truth)[0][0], 0.35, 1e-12);
}

TEST(Truth, SlopeDifferenceIsZeroOnlyForTheSameLobe) {
  const Truth truth = test::BrushedMetal();
  EXPECT_NEAR(SlopeDifference(truth, AlignedWith(truth.values, truth)), 0, 1e-14);
  ParameterValues other = truth.values;
  other[0][0] *= 1 + 1e-6;
  EXPECT_NEAR(SlopeDifference(truth, other), 1e-6, 5e-7);
}

TEST(Truth, DrawnMaterialsStayInTheirRangeAndKeepWhatTheModelTies) {
  MaterialRange range;
  Truth like = test::BrushedMetal();
  RandomNumbers random(1);
  double steepest = 0, most_anisotropic = 1;
  for (int i = 0; i < 500; ++i) {
    const Truth truth = DrawMaterial(range, like, &random);
    const Ellipsoid e = FirstLobe(truth.values);
    EXPECT_LE(e.alpha_x, range.alpha_high);
    EXPECT_GE(e.alpha_y, range.alpha_low * (1 - 1e-12));
    most_anisotropic = std::max(most_anisotropic, e.alpha_x / e.alpha_y);
    steepest = std::max(steepest, std::acos(EllipsoidRotation(e).row[2].z));
    EXPECT_EQ(truth.values[5].size(), 3U);
  }
  EXPECT_LE(steepest, range.largest_tilt + 1e-12);
  EXPECT_GT(steepest, 0.95 * range.largest_tilt);
  EXPECT_LE(most_anisotropic, range.largest_anisotropy * (1 + 1e-12));
  EXPECT_GT(most_anisotropic, 0.8 * range.largest_anisotropy);
  like.model.lobes[0].ndf = Ndf::kGgx;
  const Ellipsoid isotropic = FirstLobe(DrawMaterial(range, like, &random).values);
  EXPECT_EQ(isotropic.alpha_x, isotropic.alpha_y);
  EXPECT_EQ(isotropic.theta_x, 0);
  EXPECT_EQ(isotropic.theta_z, 0);
}

// What a fit leaves at its start is there in the truth too.
TEST(Truth, OfARecipeHasTheStartsOfWhatIsNotFitted) {
  const Recipe recipe = ParseRecipe(
      "diffuse = \"interfaced\"\n[[lobe]]\nndf = \"ggx\"\n[parameters]\nalpha_x = { start = 0.2 }\nf0 = { start = "
      "0.4 }\ndiffuse = { start = 0.3 }\n",
      "r.toml");
  const Truth truth = TruthOf(recipe, {"R", "G"}, "r.toml");
  EXPECT_EQ(truth.values[1], std::vector<double>{0.2});  // alpha_y
  EXPECT_EQ(truth.values[6], (std::vector<double>{1.5, 1.5}));
  EXPECT_EQ(truth.values[7], (std::vector<double>{0.3, 0.3}));
}

TEST(Truth, DrawnMaterialsOfRicherKinds) {
  const Recipe recipe = ParseRecipe(
      "[[lobe]]\nndf = \"student\"\nfresnel = \"curve\"\n[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n"
      "[parameters]\nalpha_x = { start = 0.2 }\ngamma = { start = 2 }\nF_0 = { start = 1 }\nF_1 = { start = 1 }\n"
      "F_2 = { start = 1 }\nF_3 = { start = 1 }\nF_4 = { start = 1 }\nF_5 = { start = 1 }\n"
      "\"lobe2.alpha_x\" = { start = 0.1 }\n\"lobe2.ior\" = { start = 1.5 }\ndiffuse = { start = 0.1 }\n",
      "r.toml");
  const Truth like = TruthOf(recipe, {"R", "G"}, "r.toml");
  RandomNumbers random(1);
  const Truth a = DrawMaterial({}, like, &random), b = DrawMaterial({}, like, &random);
  const std::vector<Parameter> parameters = Parameters(like.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_EQ(a.values[i] != b.values[i], parameters[i].free || parameters[i].name.ends_with("alpha_y"))
        << parameters[i].name;
    for (const double value : a.values[i]) {
      EXPECT_GE(value, parameters[i].low) << parameters[i].name;
      EXPECT_LE(value, parameters[i].high) << parameters[i].name;
    }
    EXPECT_TRUE(!parameters[i].shared || a.values[i][0] == a.values[i][1]) << parameters[i].name;
  }
}

TEST(SameModel, LobesOfOtherDirectionsOrKnotsAreOthers) {
  Model model = {{{Ndf::kProfile}}, Diffuse::kLambert}, retro = model, knots = model;
  retro.lobes[0].direction = LobeDirection::kRetro;
  knots.lobes[0].grid = GridWithKnots({0, 1, 2});
  EXPECT_TRUE(IsSameModel(model, model));
  EXPECT_FALSE(IsSameModel(model, retro));
  EXPECT_FALSE(IsSameModel(model, knots));
}

TEST(TruthFile, CommentsAndSidecarsReadBackAndFitsReadTheSamplesOnly) {
  const TruthRecord record = {test::BrushedMetal(), ParseNoise("multiplicative=0.05,rectified"), 42, "lobefit synth x"};
  Experiment experiment = test::BrushedExperiment("none");
  const Measurement measurement =
      Synthesise(experiment.directions, {record.truth.channels, {}}, BrdfOf(record.truth), record.noise, record.seed);
  const TemporaryFile file;
  WriteCsv(measurement, TruthComments(record), file.path());
  EXPECT_EQ(ReadMeasurement(file.path(), {}).samples.size(), measurement.samples.size());
  const std::optional<TruthRecord> found = FindTruth(file.path());
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->truth.values[5], record.truth.values[5]);
  EXPECT_NEAR(found->truth.values[4][0], record.truth.values[4][0], 1e-15);
  EXPECT_EQ(found->noise, record.noise);
  EXPECT_EQ(found->seed, 42U);

  const TemporaryFile plain("no truth in here");
  EXPECT_FALSE(FindTruth(plain.path()).has_value());
  const std::filesystem::path beside = WriteTruthBeside(record, plain.path());
  EXPECT_EQ(FindTruth(plain.path())->truth.channels, record.truth.channels);
  std::ofstream(beside) << "{\"material\": 3}";
  EXPECT_THROW(FindTruth(plain.path()), InputError);
  std::filesystem::remove(beside);
}

TEST(Truth, RecipeWithoutValuesNamesTheParameter) {
  Recipe recipe = DefaultRecipe(test::BrushedMetal().model, "r");
  try {
    TruthOf(recipe, {"Y"}, "r.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("r.toml: parameter 'alpha_x' has 0 values"));
  }
}

}  // namespace
}  // namespace lobefit

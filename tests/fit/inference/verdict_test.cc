// The verdict of a fit: its numbers against the noise that was put in, its words against what is wrong with the model.
#include "lobefit/fit/inference/verdict.h"

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

Verdict VerdictOf(const SyntheticCase& truth, double noise, const Model& fitted) {
  Measurement measurement = Synthetic(truth, StandardLayout(), noise, 11);
  return *CheckedFit(DefaultRecipe(fitted, "fitted"), {}, &measurement).verdict;
}

SyntheticCase RoundTruth() { return OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0); }

// Half of normal errors lie within 0.6745 deviations.
TEST(Verdict, OfTheTruthIsTheNoiseThatWasPutIn) {
  for (const double noise : {0.01, 0.05}) {
    const Verdict verdict = VerdictOf(RoundTruth(), noise, RoundTruth().model);
    EXPECT_EQ(verdict.kind, VerdictKind::kWithinNoise) << noise;
    EXPECT_NEAR(verdict.noise, noise, 0.1 * noise);
    EXPECT_NEAR(verdict.typical_error, 0.6745 * noise, 0.07 * noise);
    EXPECT_GT(verdict.explained, 0.99);
  }
}

TEST(Verdict, AModelThatIsOffByMoreThanTheNoiseIsCloseOnly) {
  SyntheticCase student = RoundTruth();
  student.model.lobes[0].ndf = Ndf::kStudent;
  student.values.insert(student.values.begin() + 5, {{1.8}});
  const Verdict verdict = VerdictOf(student, 0.002, RoundTruth().model);
  EXPECT_EQ(verdict.kind, VerdictKind::kClose);
  EXPECT_GT(verdict.typical_error, 3 * 0.002);
  EXPECT_LT(verdict.typical_error, 0.1);
}

TEST(Verdict, AnisotropyThatIsLeftOutIsRoughAndALobeElsewhereIsNotDescribed) {
  const Verdict rough = VerdictOf(OneLobe(Ndf::kGgxAnisotropic, 0.26, 0.16, 0, 0, 0), 0.01, RoundTruth().model);
  EXPECT_EQ(rough.kind, VerdictKind::kRough) << rough.typical_error;
  SyntheticCase retro = OneLobe(Ndf::kGgx, 0.1, 0.1, 0, 0, 0, {0.7, 0.6, 0.5}, {0.001, 0.001, 0.001});
  retro.model.lobes[0].direction = LobeDirection::kRetro;
  const Verdict wrong = VerdictOf(retro, 0.01, RoundTruth().model);
  EXPECT_EQ(wrong.kind, VerdictKind::kDoesNotDescribe) << wrong.typical_error;
}

}  // namespace
}  // namespace lobefit

#include "lobefit/material/badge.h"

#include <gtest/gtest.h>

namespace lobefit {
namespace {

Material With(VerdictKind kind, bool converged, bool determined) {
  Material material;
  material.termination.converged = converged;
  material.termination.determined = determined;
  material.verdict = Verdict{kind, 0.072, 0.01, 0.99, ""};
  return material;
}

TEST(Badge, WhatFailedComesFirst) {
  const struct {
    VerdictKind kind;
    bool converged, determined;
    BadgeMark mark;
    const char* words;
  } cases[] = {
      {VerdictKind::kWithinNoise, true, true, BadgeMark::kGood, "within the noise, typical error 7.2 %"},
      {VerdictKind::kClose, true, true, BadgeMark::kGood, "close, typical error 7.2 %"},
      {VerdictKind::kRough, true, true, BadgeMark::kRough, "rough, typical error 7.2 %"},
      {VerdictKind::kClose, true, false, BadgeMark::kRough, "not fully determined, typical error 7.2 %"},
      {VerdictKind::kDoesNotDescribe, true, false, BadgeMark::kBad, "does not describe the data, typical error 7.2 %"},
      {VerdictKind::kWithinNoise, false, true, BadgeMark::kBad, "not converged"},
  };
  for (const auto& expected : cases) {
    const Badge badge = BadgeOf(With(expected.kind, expected.converged, expected.determined));
    EXPECT_EQ(badge.mark, expected.mark) << expected.words;
    EXPECT_EQ(badge.words, expected.words);
  }
}

TEST(Badge, SaysWhereTheFitCannotBeASurfaceAndWhereItsScaleIsFree) {
  Material material = With(VerdictKind::kRough, true, true);
  material.energy = EnergyBalance{true, 8.22, 0.5, 0, "Y", 3, 4};
  EXPECT_EQ(BadgeOf(material).mark, BadgeMark::kRough);
  EXPECT_EQ(BadgeOf(material).words, "reflects more than it receives, albedo 8.22, typical error 7.2 %");
  EXPECT_EQ(EnergyText(*material.energy),
            "an albedo of 8.22 at theta_i 28.65, phi_i 0 degrees in Y, above 1 at 3 of 4 incident directions");
  material.energy->albedo = 0.9;
  EXPECT_EQ(BadgeOf(material).words, "rough, typical error 7.2 %");
  EXPECT_EQ(EnergyText(*material.energy), "");
  material = With(VerdictKind::kClose, true, true);
  material.energy = EnergyBalance{};
  material.energy->absolute = false;
  EXPECT_EQ(BadgeOf(material).mark, BadgeMark::kGood);
  EXPECT_EQ(BadgeOf(material).words, "close, typical error 7.2 %, scale free");
}

// Documents of version 0.1 have no verdict.
TEST(Badge, WithoutAVerdictOnlyTheSolverSpeaks) {
  Material material = With(VerdictKind::kClose, true, true);
  material.verdict.reset();
  EXPECT_EQ(BadgeOf(material).words, "converged");
  EXPECT_EQ(BadgeOf(material).mark, BadgeMark::kGood);
  material.termination.determined = false;
  EXPECT_EQ(BadgeOf(material).mark, BadgeMark::kRough);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/core/brdf/model.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

Model Of(std::vector<Lobe> lobes, Diffuse diffuse) {
  Model model;
  model.lobes = std::move(lobes);
  model.diffuse = diffuse;
  return model;
}

std::vector<std::string> NamesOf(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.json_name);
  return names;
}

// The contract of the documents that users read.
TEST(Model, NamesOfOneLobe) {
  const std::vector<Parameter> parameters = Parameters(Of({Lobe{}}, Diffuse::kLambert));
  EXPECT_EQ(NamesOf(parameters), (std::vector<std::string>{"alpha_x", "alpha_y", "theta_x_deg", "theta_y_deg",
                                                           "theta_z_deg", "f0", "diffuse"}));
  EXPECT_EQ(parameters[2].name, "theta_x");
}

TEST(Model, SecondLobeIsPrefixed) {
  Lobe plain;
  plain.fresnel = Fresnel::kNone;
  const std::vector<Parameter> parameters = Parameters(Of({Lobe{}, plain}, Diffuse::kNone));
  EXPECT_EQ(NamesOf(parameters),
            (std::vector<std::string>{"alpha_x", "alpha_y", "theta_x_deg", "theta_y_deg", "theta_z_deg", "f0",
                                      "lobe2.alpha_x", "lobe2.alpha_y", "lobe2.theta_x_deg", "lobe2.theta_y_deg",
                                      "lobe2.theta_z_deg", "lobe2.scale"}));
}

TEST(Model, WhatEachDistributionFrees) {
  const auto free = [](Ndf ndf) {
    Lobe lobe;
    lobe.ndf = ndf;
    std::set<std::string> names;
    for (const Parameter& parameter : Parameters(Of({lobe}, Diffuse::kNone))) {
      if (parameter.free && parameter.group == ParameterGroup::kShape) names.insert(parameter.name);
    }
    return names;
  };
  using Set = std::set<std::string>;
  EXPECT_EQ(free(Ndf::kGgx), (Set{"alpha_x"}));
  EXPECT_EQ(free(Ndf::kGgxTilted), (Set{"alpha_x", "theta_y"}));
  EXPECT_EQ(free(Ndf::kGgxAnisotropic), (Set{"alpha_x", "alpha_y", "theta_z"}));
  EXPECT_EQ(free(Ndf::kEllipsoid), (Set{"alpha_x", "alpha_y", "theta_x", "theta_y", "theta_z"}));
}

TEST(Model, RangesUnitsAndGroups) {
  for (const Parameter& parameter : Parameters(Of({Lobe{}, Lobe{}}, Diffuse::kLambert))) {
    EXPECT_LT(parameter.low, parameter.high) << parameter.name;
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
    const bool angle = parameter.name.find("theta") != std::string::npos;
    EXPECT_EQ(parameter.unit, angle ? "deg" : "1") << parameter.name;
    EXPECT_EQ(InsideFactor(parameter), angle ? kPi / 180 : 1.0) << parameter.name;
    EXPECT_EQ(parameter.json_name, parameter.name + (angle ? "_deg" : ""));
    EXPECT_EQ(parameter.per_channel, parameter.group != ParameterGroup::kShape) << parameter.name;
  }
}

template <class Enum>
void ExpectChoicesFindThemselves(const std::vector<Choice<Enum>>& choices) {
  std::set<std::string> names;
  for (const Choice<Enum>& choice : choices) {
    const Choice<Enum>* found = Find(choices, choice.name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->value, choice.value);
    EXPECT_STREQ(NameOf(choices, choice.value), choice.name);
    EXPECT_TRUE(names.insert(choice.name).second) << choice.name << " is there twice";
    EXPECT_FALSE(std::string(choice.description).empty());
  }
  EXPECT_EQ(Names(choices).size(), choices.size());
  EXPECT_EQ(Find(choices, "no such choice"), nullptr);
}

TEST(Model, ChoicesHaveOneNameEach) {
  ExpectChoicesFindThemselves(NdfChoices());
  ExpectChoicesFindThemselves(MaskingChoices());
  ExpectChoicesFindThemselves(FresnelChoices());
  ExpectChoicesFindThemselves(DiffuseChoices());
}

}  // namespace
}  // namespace lobefit

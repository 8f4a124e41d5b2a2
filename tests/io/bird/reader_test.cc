#include "tests/io/csv/read_csv.h"
#include <gmock/gmock.h>

namespace lobefit {
namespace {

std::string BirdDocument(const std::string& data) {
  return R"({"metadata":{"type":"BRDF","method":"measurement"},"data":{)" + data + "}}";
}

constexpr const char* kAngles =
    R"("theta_i":{"unit":"°","values":[45,45]},"phi_i":{"unit":"deg","values":[10,10]},)"
    R"("theta_r":{"unit":"rad","values":[0.7853981633974483,0.5235987755982988]},"phi_r":{"unit":"°","values":[190,20]},)";

TEST(Bird, ReadsArraysOfVariables) {
  const Measurement m = ReadText(BirdDocument(
      std::string(kAngles) +
      R"("wavelength_i":{"unit":"nm","values":[550,550]},)"
      R"("BRDF":{"unit":"sr^-1","values":[1.9,0.6],"uncertainty":{"unit":"sr^-1","value":[0.02,0.006]}})"));
  EXPECT_EQ(m.format, "bird");
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 45, 10, 45, 190, 1.9);
  ExpectSample(m, 1, 45, 10, 30, 20, 0.6);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"550nm"}));
  EXPECT_EQ(m.samples.sigma.size(), 2U);
}

TEST(Bird, PolarisationsAreAveragedAndWavelengthsAreChannels) {
  const Measurement m = ReadText(BirdDocument(
      R"("theta_i":{"unit":"deg","values":[0,0,0,0]},"phi_i":{"unit":"deg","values":[0,0,0,0]},"theta_r":{"unit":"deg","values":[10,10,10,10]},)"
      R"("phi_r":{"unit":"deg","values":[60,60,60,60]},"wavelength_i":{"unit":"um","values":[0.55,0.55,0.65,0.65]},)"
      R"("polarization_i":{"notation":"inStokes","values":[[1,1,0,0],[1,-1,0,0],[1,1,0,0],[1,-1,0,0]]},"BRDF":{"unit":"sr^-1","values":[0.2,0.4,0.3,0.5]})"));
  ASSERT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{550, 650}));
  EXPECT_NEAR(m.samples.values[0][0], 0.3, 1e-15);
  EXPECT_NEAR(m.samples.values[1][0], 0.4, 1e-15);
  EXPECT_TRUE(HasRemark(m, "averaged to f_r of unpolarised light"));
}

TEST(Bird, ReadsDraftsOfRows) {
  const Measurement m = ReadText(
      R"({"data":{"variables":[{"name":"theta_i","unit":"deg"},{"name":"phi_i","unit":"deg"},{"name":"theta_r","unit":"deg"},)"
      R"({"name":"phi_r","unit":"deg"},{"name":"BRDF","unit":"1/sr"},{"name":"uBRDF","unit":"1/sr"}],)"
      R"("values":[[45,0,45,180,1.9,0.02],[45,0,30,180,null,0.01]]}})");
  ASSERT_EQ(m.samples.size(), 1U);
  ExpectSample(m, 0, 45, 0, 45, 180, 1.9);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);
}

TEST(Bird, OnePolarisationIsSaid) {
  const std::string values = R"(,"BRDF":{"unit":"sr^-1","values":[1,2]})";
  const Measurement s =
      ReadText(BirdDocument(kAngles + std::string(R"("polarization_i":{"values":["s","s"]})") + values));
  EXPECT_TRUE(HasRemark(s, "the polarisation is 's'"));
  for (const char* name : {"u", "unpolarized", "unpolarised", ""}) {
    const Measurement m = ReadText(BirdDocument(kAngles + std::string(R"("polarization_i":{"values":[")") + name +
                                                R"(",")" + name + R"("]})" + values));
    EXPECT_TRUE(m.remarks.empty()) << name;
  }
}

TEST(Bird, UncertaintiesRelativeToTheValue) {
  const auto sigma = [](const std::string& unit, const std::string& number) {
    return ReadText(BirdDocument(std::string(kAngles) +
                                 R"("BRDF":{"unit":"sr^-1","values":[2,4],"uncertainty":{"unit":")" + unit +
                                 R"(","value":)" + number + "}}"))
        .samples.sigma;
  };
  EXPECT_THAT(sigma("%", "2"), testing::Pointwise(testing::DoubleEq(), {0.04, 0.08}));
  EXPECT_THAT(sigma("relative", "0.02"), testing::Pointwise(testing::DoubleEq(), {0.04, 0.08}));
  // Without a dimension beside values in 1/sr.
  EXPECT_THAT(sigma("1", "0.02"), testing::Pointwise(testing::DoubleEq(), {0.04, 0.08}));
  EXPECT_THAT(sigma("sr^-1", "0.02"), testing::Pointwise(testing::DoubleEq(), {0.02, 0.02}));
  EXPECT_THROW(sigma("furlong", "1"), InputError);
}

TEST(Bird, RefusesWhatItCannotUnderstand) {
  EXPECT_NE(MessageOf(BirdDocument(std::string(kAngles) + R"("BRDF":{"unit":"furlong","values":[1,2]})"))
                .find("BRDF has the unit 'furlong'"),
            std::string::npos);
  EXPECT_NE(MessageOf(BirdDocument(std::string(kAngles) + R"("BRDF":{"unit":"sr^-1","values":[1]})"))
                .find("'theta_i' has 2 values, BRDF has 1"),
            std::string::npos);
  EXPECT_NE(MessageOf(BirdDocument(R"("theta_r":{"unit":"deg","values":[1]},"BRDF":{"unit":"sr^-1","values":[1]})"))
                .find("no variable 'theta_i'"),
            std::string::npos);
  EXPECT_NE(
      MessageOf(BirdDocument(std::string(kAngles) + R"("BRDF":{"unit":"sr^-1","values":[1,2)")).find("no valid JSON"),
      std::string::npos);
}

}  // namespace
}  // namespace lobefit

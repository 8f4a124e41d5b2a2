#include "lobefit/validate/layouts.h"

#include <cmath>

#include "tests/support/temporary_file.h"
#include "tests/validate/brushed.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

LayoutRequest Request(const std::string& name) {
  LayoutRequest request;
  request.name = name;
  request.goniometer.polar_angles = {0.3, 0.8};
  request.goniometer.azimuths = {0, 1};
  request.samples = 100;
  return request;
}

Truth Isotropic() {
  Truth truth = test::BrushedMetal();
  truth.model.lobes[0].ndf = Ndf::kGgx;
  truth.values = {{0.2}, {0.2}, {0}, {0}, {0}, {0.7, 0.5, 0.4}, {0.02, 0.05, 0.03}};
  return truth;
}

TEST(Layouts, EveryNameMakesUnitDirectionsAboveTheHorizon) {
  for (const LayoutChoice& choice : LayoutChoices()) {
    const MeasurementLayout layout = MakeLayout(Request(choice.name), Isotropic());
    ASSERT_GT(layout.directions.size(), 50U) << choice.name;
    EXPECT_EQ(layout.directions.wi.size(), layout.directions.wo.size());
    EXPECT_GT(layout.step, 0) << choice.name;
    EXPECT_EQ(layout.isotropic, std::string(choice.name) == "merl");
    std::size_t below = 0;
    for (std::size_t i = 0; i < layout.directions.size(); ++i) {
      EXPECT_NEAR(Norm(layout.directions.wi[i]), 1, 1e-12);
      EXPECT_NEAR(Norm(layout.directions.wo[i]), 1, 1e-12);
      below += layout.directions.wi[i].z <= 0 || layout.directions.wo[i].z <= 0 ? 1 : 0;
    }
    EXPECT_EQ(below, 0U) << choice.name;
  }
}

TEST(Layouts, TablesHaveTheSizesOfTheirFormats) {
  EXPECT_EQ(MakeLayout(Request("utia"), test::BrushedMetal()).directions.size(), 288U * 288U);
  EXPECT_EQ(MakeLayout(Request("klems"), test::BrushedMetal()).directions.size(), 145U * 145U);
  const std::size_t merl = MakeLayout(Request("merl"), Isotropic()).directions.size();
  EXPECT_GT(merl, 900000U);
  EXPECT_LT(merl, 90U * 90U * 180U);
  EXPECT_LE(MakeLayout(Request("rgl"), test::BrushedMetal()).directions.size(), 16U * 8U * 100U);
}

TEST(Layouts, VisibleNormalsPutSamplesWhereTheLobeIs) {
  const Truth truth = test::BrushedMetal();
  const BrdfFunction brdf = BrdfOf(truth);
  const auto mean = [&](const char* name) {
    double sum = 0;
    const MeasurementLayout layout = MakeLayout(Request(name), truth);
    for (std::size_t i = 0; i < layout.directions.size(); ++i) {
      double values[3];
      brdf(layout.directions.wi[i], layout.directions.wo[i], values);
      sum += values[0];
    }
    return sum / static_cast<double>(layout.directions.size());
  };
  EXPECT_GT(mean("visible-normals"), 2 * mean("goniometer"));
}

TEST(Layouts, DirectionsOfAFileAreTakenInOrder) {
  const MeasurementLayout grid = MakeLayout(Request("in-plane"), test::BrushedMetal());
  const Measurement measurement =
      Synthesise(grid.directions, {{"R", "G", "B"}, {}}, BrdfOf(test::BrushedMetal()), {}, 1);
  const TemporaryFile file;
  WriteCsv(measurement, {}, file.path());
  const MeasurementLayout again = MakeLayout(Request(file.path().string()), test::BrushedMetal());
  ASSERT_EQ(again.directions.size(), measurement.samples.size());
  for (std::size_t i = 0; i < again.directions.size(); ++i)
    EXPECT_NEAR(Norm(again.directions.wo[i] - measurement.samples.wo(i)), 0, 1e-12);
  EXPECT_NEAR(again.step, grid.step, 1e-3);
}

TEST(Layouts, UnknownNameAndLostAzimuthAreUsageErrors) {
  const auto message = [](const std::string& name) -> std::string {
    try {
      MakeLayout(Request(name), test::BrushedMetal());
    } catch (const UsageError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message("klemz"), testing::HasSubstr("did you mean 'klems'?"));
  EXPECT_THAT(message("spiral"), testing::HasSubstr("allowed: goniometer, in-plane, visible-normals"));
  EXPECT_THAT(message("merl"), testing::HasSubstr("has no place for a dependence on azimuth"));
}

}  // namespace
}  // namespace lobefit

// A comparison is drawn for every kind of measurement, and refused where it makes no sense.
#include "lobefit/report/comparison/comparison.h"

#include <fstream>
#include <iterator>

#include "tests/report/synthetic.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/report/comparison/panels.h"

namespace lobefit {
namespace {

Compared MakeCompared(const std::vector<Material>& materials, const Measurement& measurement) {
  Compared compared;
  for (const Material& material : materials)
    compared.models.push_back({std::make_unique<ReportData>(material, measurement, 1), "model", "", {}});
  return compared;
}

// A second model: the same with wider lobes.
std::vector<Material> TwoMaterials(std::size_t channels, bool isotropic) {
  std::vector<Material> materials(2, test::MakeMaterial(channels, isotropic));
  materials[1].parameters[0].values = {0.4};
  materials[1].parameters[1].values = {0.4};
  return materials;
}

TEST(Comparison, IsotropicTableFillsEveryPanel) {
  const std::vector<Material> materials = TwoMaterials(3, true);
  const Measurement measurement = test::Measure(materials[0], test::TablePairs(), 0.02, true);
  const Compared compared = MakeCompared(materials, measurement);
  EXPECT_TRUE(ComparedErrorsPanel(compared));
  EXPECT_TRUE(ComparedCurvesPanel(compared));
  EXPECT_TRUE(ComparedRatiosPanel(compared));
  EXPECT_TRUE(ComparedSpheresPanel(compared));
}

TEST(Comparison, InPlaneScanHasNoMaps) {
  const std::vector<Material> materials = TwoMaterials(1, false);
  const Measurement measurement = test::Measure(materials[0], test::GoniometerPairs(false), 0.02, false);
  const Compared compared = MakeCompared(materials, measurement);
  EXPECT_TRUE(ComparedCurvesPanel(compared));
  EXPECT_FALSE(ComparedRatiosPanel(compared));
}

TEST(Comparison, SamePictureWithAnyNumberOfThreads) {
  const std::vector<Material> materials = TwoMaterials(1, false);
  const Measurement measurement = test::Measure(materials[0], test::GoniometerPairs(true), 0.02, false);
  const auto draw = [&](int threads) {
    const TemporaryFile file;
    WriteComparisonPng({{&materials[0], "narrow", "best"}, {&materials[1], "wide", ""}}, measurement, file.path(),
                       {.threads = threads, .scale = 0.5, .font_folders = {}});
    std::ifstream in(file.path(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string one = draw(1);
  EXPECT_GT(one.size(), 10000U);
  EXPECT_EQ(one, draw(3));
}

TEST(Comparison, RefusesOtherChannelsAndNothing) {
  const std::vector<Material> materials = TwoMaterials(3, true);
  const Measurement measurement = test::Measure(test::MakeMaterial(1, true), test::TablePairs(), 0, true);
  const TemporaryFile file;
  EXPECT_THROW(WriteComparisonPng({{&materials[0], "rgb", ""}}, measurement, file.path()), InputError);
  EXPECT_THROW(WriteComparisonPng({}, measurement, file.path()), InputError);
}

}  // namespace
}  // namespace lobefit

// The exported files in the programs they are for, where a machine has them: MaterialX' own library (the npm package
// that LOBEFIT_MATERIALX names, run by node) and OSL's compiler. Else the tests are skipped; tests/export/real/run has
// more programs.
#include <cstdlib>
#include <filesystem>

#include "tests/export/browser.h"
#include "tests/export/materials.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/export/export.h"
#include "lobefit/export/targets.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

class RealLoaders : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("real_loaders_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Names of the files, in the folder.
  std::vector<std::string> Export(const std::vector<const char*>& targets) const {
    std::vector<std::string> files;
    const std::vector<std::pair<const char*, SyntheticCase>> materials = {{"tilted", test::Tilted()},
                                                                          {"blue-turned", test::Turned()},
                                                                          {"plastic", test::Plastic()},
                                                                          {"two lobes", test::TwoLobes()}};
    for (const auto& [name, synthetic] : materials) {
      ExportOptions options;
      for (const char* target : targets) options.targets.push_back(&FindTarget(target));
      options.folder = folder_;
      options.name = name;
      options.numbers = Numbers::kCopied;
      for (const ExportResult& result : ExportMaterial(test::MaterialOf(synthetic), options).results) {
        files.push_back(result.files[0].filename().string());
      }
    }
    return files;
  }

  std::filesystem::path folder_;
};

TEST_F(RealLoaders, MaterialXValidatesAndGeneratesShaders) {
  const char* package = std::getenv("LOBEFIT_MATERIALX");
  if (package == nullptr || !test::Installed("node")) GTEST_SKIP() << "LOBEFIT_MATERIALX names no package, or no node";
  const std::filesystem::path script = std::filesystem::path(__FILE__).parent_path() / "real" / "materialx.mjs";
  std::string command = "node '" + script.string() + "' '" + package + "' '" + folder_.string() + "'";
  const std::vector<std::string> files = Export({"materialx", "openpbr"});
  for (const std::string& file : files) command += " '" + (folder_ / file).string() + "'";
  const std::string output = test::OutputOf(command + " 2>&1");
  for (const std::string& file : files) {
    EXPECT_THAT(output, HasSubstr(file + " valid ")) << output.substr(0, 500);
    if (!test::Installed("glslangValidator")) continue;
    EXPECT_THAT(
        test::OutputOf("glslangValidator -S frag '" + (folder_ / (file + ".frag")).string() + "' 2>&1; echo ended $?"),
        HasSubstr("ended 0"));
  }
}

TEST_F(RealLoaders, OslCompilerTakesTheText) {
  if (!test::Installed("oslc")) GTEST_SKIP() << "oslc is not installed";
  for (const std::string& file : Export({"osl"})) {
    const std::filesystem::path path = folder_ / file;
    EXPECT_THAT(test::OutputOf("oslc -o '" + path.string() + ".oso' '" + path.string() + "' 2>&1; echo ended $?"),
                HasSubstr("ended 0"))
        << file;
  }
}

}  // namespace
}  // namespace lobefit

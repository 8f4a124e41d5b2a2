// Files whose names end a string, a comment or a line in some language: what is made from them is read by the strictest
// parser that is to take it, and nothing that they say is done.
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

// As a word of any shell, whatever stands in it.
std::string Quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

class HostileNames : public ProgramTest, public testing::WithParamInterface<const char*> {};

TEST_P(HostileNames, AreTextEverywhere) {
  const std::string name = GetParam(), file = Quoted(std::string("./") + name + ".csv");
  WriteWholeFile(folder_ / (name + ".csv"), ReadWholeFile(test::SourceDir() / "samples/satin_plastic.csv"));
  std::string shown;
  const std::vector<std::string> commands = {
      "lobefit info " + file,
      "lobefit info " + file + " --json > info.json",
      "lobefit fit " + file + " --recipe ggx --format html --threads 2 --name m",
      "lobefit fit " + file + " --recipe ggx --no-report --threads 2",
      "lobefit report m.material.json " + file + " --out page.html --threads 2",
      "lobefit convert " + file + " x.alta",
      "lobefit convert " + file + " x.csv",
      "lobefit info x.csv && lobefit info x.alta",
      "lobefit export " + Quoted(std::string("./") + name + ".material.json") +
          " --to pbrt,mitsuba,materialx,openpbr,gltf,osl,glsl,brdf-explorer,rgl --threads 2",
      std::string("lobefit compare ") + file + " --recipes beckmann,ggx --folds 0 --no-report --name c --threads 2",
      std::string("lobefit fit ./no") + Quoted(name) + "such.csv 2>&1; test $? = 3"};
  for (const std::string& command : commands) {
    const ProgramResult result = Shell(command);
    EXPECT_EQ(result.exit_code, 0) << command << result.out << result.err;
    shown += result.out + result.err;
  }
  EXPECT_EQ(PrintableLines(shown), shown);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ran"));
  if (std::system("command -v python3 >/dev/null 2>&1") != 0) GTEST_SKIP() << "python3 is not installed";
  const ProgramResult parsed = Shell("$SOURCE/tests/cli/parse_strictly.py .");
  EXPECT_EQ(parsed.exit_code, 0) << parsed.out << parsed.err;
  EXPECT_THAT(parsed.out, testing::HasSubstr("17 files"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostileNames,
                         testing::Values("R&D \"x\" <b>it's", "'+str(__import__('os').system('touch ran'))+'",
                                         "$(touch ran);`touch ran`", "new\nline --> ]]> *\\ \n #",
                                         "\x1b[31mred\x1b]0;titl\x07", "\xff\xfe not UTF-8",
                                         "\xe2\x80\xae turned\xe2\x80\xac, {{title}} %s%n \\"));

}  // namespace
}  // namespace lobefit

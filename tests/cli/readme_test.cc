#include <sstream>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using Readme = ProgramTest;

// Lines of the ```sh blocks of a Markdown file that call the program.
std::vector<std::string> Commands(const std::string& markdown) {
  std::vector<std::string> commands;
  std::stringstream lines(markdown);
  bool in_block = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      in_block = line == "```sh";
    } else if (in_block && line.find("lobefit ") != std::string::npos) {
      commands.push_back(line);
    }
  }
  return commands;
}

// The commands run one after the other in a folder that has samples/ and fits/, as they would in a checkout.
TEST_F(Readme, EveryCommandOfTheProgramWorks) {
  const std::vector<std::string> commands = Commands(ReadWholeFile(test::SourceDir() / "README.md"));
  EXPECT_GE(commands.size(), 6U);
  ASSERT_EQ(Shell("cp -r $SOURCE/samples $SOURCE/fits .").exit_code, 0);
  for (const std::string& command : commands) {
    const ProgramResult result = Shell(command);
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.out << result.err;
  }
}

}  // namespace
}  // namespace lobefit

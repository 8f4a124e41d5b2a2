// What the program says of itself: verbs, options, formats.
#include <sstream>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/io/formats.h"
#include "lobefit/io/text/options.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using Help = ProgramTest;

TEST_F(Help, OfEveryVerbFitsATerminalAndEndsWithExampleAndExitCodes) {
  const std::string verbs = Shell("lobefit --help").out;
  std::istringstream lines(verbs.substr(verbs.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  int count = 0;
  while (std::getline(lines, line) && !line.empty()) {
    const std::string verb = line.substr(2, line.find(' ', 2) - 2), help = Shell("lobefit " + verb + " --help").out;
    EXPECT_THAT(help, HasSubstr("Usage: lobefit " + verb)) << verb;
    EXPECT_THAT(help, HasSubstr("Example:\n  lobefit " + verb)) << verb;
    EXPECT_THAT(help, HasSubstr("Exit codes: 0 done")) << verb;
    std::istringstream text(help);
    for (std::string row; std::getline(text, row);) EXPECT_LE(row.size(), 100U) << verb << ": " << row;
    ++count;
  }
  EXPECT_GE(count, 12);
}

// An option of one format stands with the format; together the lists hold every option.
TEST_F(Help, OfEveryFormatListsItsOptions) {
  const std::string fit = Shell("lobefit fit --help").out, list = Shell("lobefit formats").out;
  for (const Format& format : Formats()) {
    EXPECT_THAT(list, HasSubstr(format.description));
    const std::string help = Shell(std::string("lobefit formats ") + format.name).out;
    for (const ReadOptionEntry& option : ReadOptionTable()) {
      const bool looks = option.formats.empty() ||
                         std::find(option.formats.begin(), option.formats.end(), format.name) != option.formats.end();
      EXPECT_EQ(help.find(std::string("--") + option.name + " ") != std::string::npos, looks)
          << format.name << " " << option.name;
    }
  }
  EXPECT_THAT(fit, testing::Not(HasSubstr("--mit-stride")));
  EXPECT_THAT(fit, HasSubstr("lobefit formats NAME"));
  EXPECT_THAT(Shell("lobefit formats mer").err, HasSubstr("did you mean 'merl'?"));
}

TEST_F(Help, AMisspeltOptionIsSuggested) {
  const ProgramResult result = Shell("lobefit fit a.csv --recip=ggx");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("option '--recip' is not known (did you mean '--recipe'?)"));
  EXPECT_THAT(Shell("lobefit info a.csv --zzzzz").err, HasSubstr("option '--zzzzz' is not known; see"));
}

}  // namespace
}  // namespace lobefit

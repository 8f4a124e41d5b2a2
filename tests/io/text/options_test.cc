// Options of another format are errors, not ignored.
#include "lobefit/io/text/options.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/formats.h"

namespace lobefit {
namespace {

const ReadOptionEntry& Option(const std::string& name) {
  const std::vector<ReadOptionEntry>& table = ReadOptionTable();
  return *std::find_if(table.begin(), table.end(), [&](const ReadOptionEntry& entry) { return name == entry.name; });
}

TEST(ReadOptions, AnOptionOfAnotherFormatIsAnError) {
  EXPECT_NO_THROW(CheckOptionOf(Option("merl-cell"), "merl", "a.binary"));
  EXPECT_NO_THROW(CheckOptionOf(Option("noise-floor"), "cornell", "a.txt"));
  try {
    CheckOptionOf(Option("merl-cell"), "mit", "a.dat");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_EQ(std::string(error.what()),
              "--merl-cell is an option of merl, and a.dat is mit; leave it out (mit has --mit-cell, --mit-scale, "
              "--mit-stride)");
  }
}

TEST(ReadOptions, NameFormatsThatThereAre) {
  for (const ReadOptionEntry& entry : ReadOptionTable()) {
    for (const std::string& format : entry.formats) {
      const std::vector<Format>& formats = Formats();
      EXPECT_TRUE(std::any_of(formats.begin(), formats.end(), [&](const Format& one) { return format == one.name; }))
          << entry.name << ": " << format;
    }
  }
}

}  // namespace
}  // namespace lobefit

// Options of another format are errors, not ignored.
#include "lobefit/io/text/options.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/formats.h"
#include "lobefit/math/vec.h"

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

// The words that help lists are those that are taken, in any case; any other is refused with the list.
TEST(ReadOptions, WordsAreThoseOfTheirHelp) {
  std::size_t lists = 0;
  for (const ReadOptionEntry& entry : ReadOptionTable()) {
    const std::string allowed = entry.allowed;
    if (allowed.find('|') == std::string::npos) continue;
    ++lists;
    ReadOptions options;
    for (const std::string_view word : Split(allowed, '|')) {
      EXPECT_NO_THROW(entry.set(&options, std::string(word))) << entry.name << " " << word;
    }
    for (const char* junk : {"", "no-such-word", "|", "0.5.5"}) {
      try {
        entry.set(&options, junk);
        ADD_FAILURE() << entry.name << " takes '" << junk << "'";
      } catch (const UsageError& error) {
        const std::string words = error.what();
        EXPECT_TRUE(words.starts_with(std::string("--") + entry.name)) << words;
        for (const std::string_view word : Split(allowed, '|'))
          EXPECT_NE(words.find(word), std::string::npos) << words << " without " << word;
      }
    }
  }
  EXPECT_GE(lists, 8U);
}

// Names are read back as what they name: files echo them.
template <class Enum>
void ExpectReadBack(int count, std::optional<Enum> (*parse)(std::string_view)) {
  for (int k = 0; k < count; ++k) {
    const auto value = static_cast<Enum>(k);
    EXPECT_EQ(parse(Name(value)), value) << Name(value);
    std::string capitals = Name(value);
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(parse(capitals), value) << capitals;
  }
}

TEST(ReadOptions, NamesAreReadBack) {
  ExpectReadBack(7, ParseValueKind);
  ExpectReadBack(2, ParseIncidentSense);
  ExpectReadBack(2, ParseRepeatedRows);
  ExpectReadBack(2, ParseCellPosition);
  ExpectReadBack(2, ParseUtiaEncoding);
  ExpectReadBack(4, ParseExrAxes);
  ExpectReadBack(3, ParseExrProjection);
  ExpectReadBack(2, ParseExrRows);
  EXPECT_EQ(ParseCellPosition("center"), CellPosition::kCentre);
}

// A white diffuser, f_r = 1 / pi, as each kind of number has it.
TEST(BrdfFactor, TakesEveryKindOfNumberToTheBrdf) {
  const double ci = 0.5, co = 0.2, f = 1 / kPi;
  EXPECT_DOUBLE_EQ(f, f * BrdfFactor(ValueKind::kBrdf, ci, co));
  EXPECT_DOUBLE_EQ(f, f * co * BrdfFactor(ValueKind::kBrdfCosO, ci, co));
  EXPECT_DOUBLE_EQ(f, f * ci * BrdfFactor(ValueKind::kBrdfCosI, ci, co));
  EXPECT_DOUBLE_EQ(f, 1 * BrdfFactor(ValueKind::kReflectanceFactor, ci, co));
  EXPECT_DOUBLE_EQ(f, f * co * BrdfFactor(ValueKind::kIntensity, ci, co));
  EXPECT_DOUBLE_EQ(f, co * BrdfFactor(ValueKind::kReading, ci, co)) << "of a standard that faces the detector";
  EXPECT_DOUBLE_EQ(f, ci * BrdfFactor(ValueKind::kReflectanceCosI, ci, co)) << "I/F is the cosine";
  for (int kind = 0; kind < 7; ++kind) {
    for (const double cosine : {0.0, -0.3}) {
      const double factor = BrdfFactor(static_cast<ValueKind>(kind), cosine, cosine);
      EXPECT_TRUE(factor == 1 || factor == 1 / kPi) << kind << " at the horizon";
    }
  }
}

}  // namespace
}  // namespace lobefit

#include "lobefit/batch/list/csv_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::vector<std::string>> All(std::string_view text) {
  CsvRecords records(text, "list.csv");
  std::vector<std::vector<std::string>> all;
  for (std::vector<std::string> fields; records.Next(&fields);) all.push_back(fields);
  return all;
}

TEST(CsvText, ReadsQuotesAndLineEnds) {
  EXPECT_THAT(All("\xEF\xBB\xBF"
                  "a, b ,c\r\n\r\n1,\"x, \"\"y\"\"\n z\",\r\n,,"),
              ElementsAre(ElementsAre("a", "b", "c"), ElementsAre("1", "x, \"y\"\n z", ""), ElementsAre("", "", "")));
  EXPECT_THAT(All(""), testing::IsEmpty());
  EXPECT_THAT(All("\"a\""), ElementsAre(ElementsAre("a")));
}

TEST(CsvText, CountsLinesWithinQuotes) {
  CsvRecords records("a\n\"1\n2\"\nb\n", "list.csv");
  std::vector<std::string> fields;
  std::vector<std::size_t> lines;
  while (records.Next(&fields)) lines.push_back(records.line_number());
  EXPECT_THAT(lines, ElementsAre(1U, 2U, 4U));
}

TEST(CsvText, RefusesBrokenQuotesWithTheirLine) {
  EXPECT_THAT([] { All("a\n\"b"); }, ThrowsMessage<InputError>(HasSubstr("list.csv, line 2: the quote")));
  EXPECT_THAT([] { All("\"a\"b,c"); }, ThrowsMessage<InputError>(HasSubstr("line 1: 'b' follows")));
}

TEST(CsvText, WritesWhatItReads) {
  const std::vector<std::string> texts = {"plain", "a,b", "say \"x\"", "two\nlines", " blank ", ""};
  std::string line;
  for (const std::string& text : texts) {
    if (!line.empty()) line += ',';
    AppendCsvField(text, &line);
  }
  EXPECT_THAT(All(line + "\n"), ElementsAre(testing::ElementsAreArray(texts)));
}

}  // namespace
}  // namespace lobefit

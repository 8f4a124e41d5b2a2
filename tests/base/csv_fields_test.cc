#include "lobefit/base/text/csv_fields.h"

#include <gtest/gtest.h>

namespace lobefit {
namespace {

std::vector<std::string> Fields(std::string_view line, char separator = ',') {
  std::vector<std::string_view> fields;
  SplitQuoted(line, separator, &fields);
  std::vector<std::string> plain;
  std::string storage;
  for (const std::string_view field : fields) plain.emplace_back(Unquoted(field, &storage));
  return plain;
}

TEST(CsvFields, QuotesHoldSeparatorsAndQuotes) {
  using Strings = std::vector<std::string>;
  EXPECT_EQ(Fields("a,b,,c"), (Strings{"a", "b", "", "c"}));
  EXPECT_EQ(Fields(""), (Strings{""}));
  EXPECT_EQ(Fields("a,"), (Strings{"a", ""}));
  EXPECT_EQ(Fields("\"a,b\",c"), (Strings{"a,b", "c"}));
  EXPECT_EQ(Fields("\"say \"\"no\"\"\",\"\""), (Strings{"say \"no\"", ""}));
  EXPECT_EQ(Fields(" \"a\" , b "), (Strings{"a", "b"}));
  EXPECT_EQ(Fields("\"a;b\";\"c\"", ';'), (Strings{"a;b", "c"}));
  EXPECT_EQ(Fields("5\" disc,b"), (Strings{"5\" disc", "b"}));  // a quote within a field is a character
  EXPECT_TRUE(EndsWithinQuotes("a,\"b", ','));
  EXPECT_FALSE(EndsWithinQuotes("a,\"b\"", ','));
  EXPECT_FALSE(EndsWithinQuotes("a,\"b\"\"\"", ','));
}

}  // namespace
}  // namespace lobefit

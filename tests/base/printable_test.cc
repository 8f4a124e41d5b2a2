#include "lobefit/base/text/printable.h"

#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(Printable, KeepsTextAndTakesWhatATerminalWouldObey) {
  EXPECT_EQ(Printable("µm \"it's\" θ 中 😀"), "µm \"it's\" θ 中 😀");
  EXPECT_EQ(Printable("a\x1b[31mb\r\n\t\x7f"), "a?[31mb????");
  EXPECT_EQ(Printable("\xc2\x9b"
                      "2J"),
            "?2J");  // CSI as one character of C1
  EXPECT_EQ(Printable("x\xe2\x80\xae"
                      "gnp"),
            "x?gnp");  // turns the direction of writing
  EXPECT_EQ(PrintableLines("a\nb\tc\x1b"), "a\nb\tc?");
  EXPECT_EQ(PrintableName("d/\x1b]0;title\x07.csv"), "d/?]0;title?.csv");
}

TEST(MarkupText, IsTextInElementsAndAttributes) {
  EXPECT_EQ(MarkupText("<b> & \"c\" 'd'"), "&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(MarkupText("\xff\x01 \xef\xbf\xbf θ\t\n"), "\xEF\xBF\xBD\xEF\xBF\xBD \xEF\xBF\xBD θ\t\n");
}

TEST(JoinSome, NamesTwentyAndCountsTheRest) {
  EXPECT_EQ(JoinSome({"a", "b\n"}), "a, b?");
  EXPECT_THAT(JoinSome(std::vector<std::string>(40000, "x")), testing::EndsWith("x and 39980 more"));
}

TEST(Utf8Length, RefusesWhatIsNotWellFormed) {
  EXPECT_EQ(Utf8Length(""), 0U);
  EXPECT_EQ(Utf8Length("a"), 1U);
  EXPECT_EQ(Utf8Length("\xc3\xa9x"), 2U);
  EXPECT_EQ(Utf8Length("\xf0\x9f\x98\x80"), 4U);
  for (const char* bad :
       {"\x80", "\xc0\xaf", "\xc3", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xff"})
    EXPECT_EQ(Utf8Length(bad), 0U) << bad;
}

TEST(ShellWord, IsReadAsTheArgument) {
  EXPECT_EQ(ShellWord("samples/a_1.csv"), "samples/a_1.csv");
  EXPECT_EQ(ShellWord("it's"), "'it'\\''s'");
  for (const std::string& argument :
       {std::string(), std::string("it's.csv"), std::string("a b;c&d|e(f)<g>h`i`$j\\k\"l*?~#!{}[]="),
        std::string("two\nlines\tand\x1b'\\"), std::string("~"), std::string("µ\xff")}) {
    const std::string word = ShellWord(argument);
    EXPECT_EQ(word.find('\n'), std::string::npos);
    std::FILE* pipe =
        popen(("exec bash -c \"$(cat <<'END_OF_LINE'\nprintf %s " + word + "\nEND_OF_LINE\n)\"").c_str(), "r");
    std::string out;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
    EXPECT_EQ(pclose(pipe), 0);
    EXPECT_EQ(out, argument);
  }
}

}  // namespace
}  // namespace lobefit

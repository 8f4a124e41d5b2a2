// lobefit eval as a user runs it.
#include <charconv>
#include <string>
#include <vector>

#include "tests/support/run_program.h"
#include <gtest/gtest.h>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

std::vector<std::vector<std::string>> Rows(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  LineReader lines(csv);
  std::string_view line;
  while (lines.Next(&line)) {
    rows.emplace_back();
    for (const std::string_view field : Split(line, ',')) rows.back().emplace_back(field);
  }
  return rows;
}

class EvalVerb : public ProgramTest {
 protected:
  ProgramResult Eval(const std::string& arguments, const std::string& input) const {
    WriteWholeFile(folder_ / "in.csv", input);
    return Shell("lobefit eval " + arguments + " < in.csv");
  }
  // The exit code is 3, nothing is said on stdout but whole rows, and stderr has all of `parts`.
  void ExpectRefused(const std::string& quantity, const std::string& input, const std::vector<std::string>& parts) {
    const ProgramResult result = Eval(quantity, input);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    for (const std::string& part : parts) EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  }
};

TEST_F(EvalVerb, AppendsResultsAndPassesOtherColumnsThrough) {
  const ProgramResult result = Eval("ssl", "name,theta,alpha,note\nfirst,0,0.5,\"a, b\"\nsecond,3.1,0.5, x\n");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with(
      "name,theta,alpha,note,K,dK_dalpha,dK_dtheta\nfirst,0,0.5,\"a, b\",1.0000000000000000e+00,"))
      << result.out;
  EXPECT_NE(result.out.find("\nsecond,3.1,0.5, x,"), std::string::npos) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(EvalVerb, ReplacesAColumnThatIsThereInItsPlace) {
  const ProgramResult result = Eval("ssl", "K,alpha,theta\n99,0.5,0\n");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("K,alpha,theta,dK_dalpha,dK_dtheta\n1.0000000000000000e+00,0.5,0,")) << result.out;
}

TEST_F(EvalVerb, WritesNumbersThatReadBack) {
  const ProgramResult result = Eval("ssl", "alpha,theta\n0.3,0.1\n");
  const std::vector<std::vector<std::string>> rows = Rows(result.out);
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[1].size(), 5U);
  for (std::size_t k = 2; k < 5; ++k) {
    // d.dddddddddddddddde+-xx
    EXPECT_TRUE(rows[1][k].size() == 22 || rows[1][k].size() == 23) << rows[1][k];
    EXPECT_TRUE(ParseDouble(rows[1][k]).has_value());
  }
}

TEST_F(EvalVerb, TakesAnyLineEndsByteOrderMarkAndNoFinalLineEnd) {
  const std::string plain = Eval("ssl", "alpha,theta\n0.3,0.1\n0.3,0.2\n").out;
  EXPECT_EQ(Eval("ssl", "alpha,theta\r\n0.3,0.1\r\n0.3,0.2").out, plain);
  EXPECT_EQ(Eval("ssl",
                 "\xEF\xBB\xBF"
                 "alpha,theta\n0.3,0.1\n0.3,0.2\n\n\n")
                .out,
            plain);
  EXPECT_EQ(Eval("ssl", "alpha,theta\n").out, "alpha,theta,K,dK_dalpha,dK_dtheta\n");
}

TEST_F(EvalVerb, EvaluatesAWholeReferenceTable) {
  const ProgramResult result = Shell("lobefit eval smith_lambda < $SOURCE/tests/data/reference/smith_lambda.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::vector<std::string>> rows = Rows(result.out);
  EXPECT_EQ(rows.size(), 201U);
  EXPECT_EQ(rows[0].back(), "cond_Lambda");  // all results were there and are replaced
  EXPECT_EQ(rows[0][15], "clamped");
  EXPECT_TRUE(rows[1][15] == "0" || rows[1][15] == "1") << rows[1][15];
}

TEST_F(EvalVerb, WritesNanAtTheKink) {
  const ProgramResult result = Eval("sel_integral", "alpha_x,alpha_y\n0.3,0.3\n");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.ends_with(",nan,nan\n")) << result.out;
}

TEST_F(EvalVerb, SaysRowAndColumnOfWhatItRefuses) {
  const std::string good = "alpha,theta\n0.3,0.1\n";
  ExpectRefused("ssl", good + "0.3,nan\n", {"line 3", "row 2", "'theta'", "not finite"});
  ExpectRefused("ssl", good + "inf,0.1\n", {"line 3", "row 2", "'alpha'", "not finite"});
  ExpectRefused("ssl", good + "0,0.1\n", {"line 3", "row 2", "'alpha'", "in (0, 1]"});
  ExpectRefused("ssl", good + "0.3,3.2\n", {"line 3", "'theta'", "in [0, 3.14"});
  ExpectRefused("ssl", good + "0.3,x1\n", {"line 3", "row 2", "'theta'", "'x1' is not a number"});
  ExpectRefused("ssl", good + "0.3,\n", {"line 3", "'theta'", "not a number"});
  ExpectRefused("ssl", good + "0.3\n", {"line 3", "row 2", "1 fields", "2 columns"});
  ExpectRefused("ssl", good + "\n0.3,0.1\n", {"line 3", "blank"});
  ExpectRefused("ssl", "", {"empty"});
  ExpectRefused("ssl", "alpha,Theta\n0.3,0.1\n", {"column 'theta' is missing", "did you mean 'Theta'"});
  ExpectRefused("ssl", "alpha,theta,theta\n0.3,0.1,0.1\n", {"'theta'", "twice"});
  ExpectRefused("ellipsoid_d", good, {"'ellipsoid_d' is not a quantity", "did you mean 'ellipsoid_D'"});
  ExpectRefused("offcenter_D", "kind,alpha_x,alpha_y,r,slope_x,slope_y,mx,my,mz\nGGX,1,1,0,0,0,0,0,1\n",
                {"'kind'", "beckmann, ggx"});
  ExpectRefused("ellipsoid_D", "alpha_x,alpha_y,theta_x,theta_y,theta_z,mx,my,mz\n1,1,0,0,0,0,0,0\n",
                {"row 1", "'mx'", "no length"});
}

TEST_F(EvalVerb, WritesTheRowsBeforeTheOneItRefuses) {
  EXPECT_EQ(Rows(Eval("ssl", "alpha,theta\n0.3,0.1\n0,0\n").out).size(), 2U);
}

TEST_F(EvalVerb, ListsEveryQuantity) {
  const ProgramResult all = Shell("lobefit eval --list");
  EXPECT_EQ(all.exit_code, 0) << all.err;
  for (const char* part : {"ellipsoid_D\n", "white_furnace\n", "source: [Walter] eq 1-3", "dD_dtheta_x", "1/sr/rad",
                           "in (0, 1]", "one of beckmann, ggx"}) {
    EXPECT_NE(all.out.find(part), std::string::npos) << part;
  }
  const ProgramResult one = Shell("lobefit eval ssl --list");
  EXPECT_TRUE(one.out.starts_with("ssl\n")) << one.out;
  EXPECT_EQ(one.out.find("ellipsoid_D"), std::string::npos);
  EXPECT_TRUE(Shell("lobefit eval --list --json").out.starts_with("{\n  \"quantities\""));
}

TEST_F(EvalVerb, WrongUsage) {
  EXPECT_EQ(Shell("lobefit eval").exit_code, 2);
  EXPECT_EQ(Shell("lobefit eval ssl --json").exit_code, 2);
  EXPECT_EQ(Eval("ssl > /dev/full", "alpha,theta\n0.3,0.1\n").exit_code, 3);
}

}  // namespace
}  // namespace lobefit

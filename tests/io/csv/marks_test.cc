// Marks for no value, rows that are chosen, columns that tell rows apart, channels chosen before rows are judged.
#include <algorithm>

#include "tests/io/csv/read_csv.h"

#include "lobefit/io/csv/head/lines.h"

namespace lobefit {
namespace {

TEST(CsvMarks, WordsForNoValueSetTheSampleAside) {
  for (const char* word : {"OVER",
                           "SAT",
                           "saturated",
                           "-",
                           "--",
                           "N/A",
                           "#N/A",
                           "#DIV/0!",
                           "1.#QNAN",
                           "-1.#IND",
                           "1.#INF",
                           "nan(ind)",
                           "-nan(ind)",
                           "<0.001",
                           "> 10",
                           "***",
                           "null",
                           "None",
                           "",
                           "\"\"",
                           "overflow",
                           "n.d.",
                           "####",
                           "\xe2\x80\x94",
                           "#WERT!",
                           "#NV",
                           "#N/D",
                           "#\u00a1VALOR!",
                           "#\u00a1DIV/0!",
                           "#NOMBRE!",
                           "#CALC!",
                           "#N/A N/A",
                           "Err:502",
                           "k.A.",
                           "clipped",
                           "not measured",
                           "nicht gemessen",
                           "non mesur\u00e9",
                           "\u00dcberlauf",
                           "satur\u00e9",
                           "fuera de rango",
                           "\u221e",
                           "-\u221e",
                           "\\N",
                           "no data",
                           "below noise"}) {
    const Measurement m = ReadText("theta_i,theta_o,f\n10,20,1\n10,30," + std::string(word) + "\n10,40,2\n");
    EXPECT_EQ(m.samples.size(), 2U) << word;
    EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U) << word;
    EXPECT_TRUE(HasRemark(m, "1 field without a number")) << word;
    EXPECT_TRUE(HasRemark(m, "line 3")) << word;
  }
  EXPECT_EQ(ReadText("theta_i,theta_o,f\n10,20,1\n10,30,nan\n10,30,inf\n").set_aside[SetAsideReason::kNotFinite], 2U);
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,1\n10,30,twelve\n").find("which is not a number"), std::string::npos);
}

TEST(CsvMarks, AMarkWithADecimalCommaIsNoNumberWithOne) {
  const Measurement m = ReadText("theta_i;theta_o;f\n10;20;1.5\n10;30;1,#QNAN\n10;40;2.5\n");
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{1.5, 2.5}));
}

TEST(CsvMarks, NumbersAndWordsOfTheUser) {
  ReadOptions options;
  options.no_value = "0,-999,shade";
  const Measurement m = ReadText("theta_i,theta_o,f\n10,20,1\n10,30,0\n10,40,-999.0\n10,50,Shade\n10,60,-1\n", options);
  EXPECT_EQ(m.samples.size(), 2U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 3U);
  options.no_value = "0,,1";
  EXPECT_NE(MessageOf("theta_i,theta_o,f\n10,20,1\n", options).find("an item is empty"), std::string::npos);
}

TEST(CsvMarks, RowsAreChosenByAColumn) {
  const std::string text = "theta_i,theta_o,pol,run,f\n10,20,s,1,1\n10,20,p,1,3\n10,30,s,2,5\n10,30,p,2,7\n";
  ReadOptions options;
  options.where = "pol=S";
  const Measurement s = ReadText(text, options);
  ASSERT_EQ(s.samples.size(), 2U);
  EXPECT_EQ(s.samples.values[0][1], 5);
  EXPECT_EQ(s.set_aside[SetAsideReason::kOutsideSelection], 2U);
  options.where = "pol=p,run=2.0";
  EXPECT_EQ(ReadText(text, options).samples.values[0][0], 7);
  EXPECT_EQ(ReadText("# where: pol=p, run=1\n" + text).samples.values[0][0], 3);
  options.where = "polarisation=s";
  EXPECT_NE(MessageOf(text, options).find("no column is named 'polarisation', which --where asks for"),
            std::string::npos);
  // A known column too.
  options.where = "wavelength=550";
  EXPECT_EQ(ReadText("wavelength,theta_i,theta_o,f\n450,10,20,1\n550,10,20,2\n", options).channels.names,
            (std::vector<std::string>{"550nm"}));
}

TEST(CsvMarks, PolarisationsAreAveragedToUnpolarisedLight) {
  const Measurement m = ReadText("theta_i,theta_o,pol,f\n10,20,s,1\n10,20,p,3\n10,20,p,5\n10,30,s,5\n");
  ASSERT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(m.samples.values[0][0], 2.5);             // (1 + (3 + 5) / 2) / 2
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);  // 30 degrees lacks p
  EXPECT_TRUE(HasRemark(m, "averaged to f_r of unpolarised light"));
  const Measurement given = ReadText("theta_i,theta_o,pol,f\n10,20,s,1\n10,20,p,3\n10,20,unpolarised,2.1\n");
  EXPECT_EQ(given.samples.values[0][0], 2.1);
}

TEST(CsvMarks, AColumnThatTellsRowsApartIsNamed) {
  const Measurement m = ReadText("theta_i,theta_o,side,f\n10,20,left,1\n10,20,right,3\n10,30,left,2\n");
  EXPECT_TRUE(HasRemark(m, "rows of the same directions differ in 'side' (left, right)"));
  EXPECT_TRUE(HasRemark(m, "--where \"side=left\""));
  EXPECT_FALSE(HasRemark(ReadText("theta_i,theta_o,side,f\n10,20,left,1\n10,20,left,3\n"), "differ in"));
}

TEST(CsvMarks, ChannelsAreChosenBeforeRowsAreJudged) {
  ReadOptions options;
  options.channels = "450,550";
  const std::string columns = "theta_i,theta_o,450nm,550nm,1050nm\n10,20,1,2,nan\n10,30,3,4,\n10,40,5,6,7\n";
  EXPECT_EQ(ReadText(columns, options).samples.size(), 3U);
  EXPECT_EQ(ReadText(columns).samples.size(), 1U);
  EXPECT_EQ(ReadText(columns).set_aside[SetAsideReason::kHole], 2U);
  const std::string rows =
      "wavelength,theta_i,theta_o,f\n450,10,20,1\n550,10,20,2\n450,10,30,3\n550,10,30,4\n1050,10,30,5\n";
  EXPECT_EQ(ReadText(rows, options).samples.size(), 2U);
  EXPECT_EQ(ReadText(rows).samples.size(), 1U);
  EXPECT_NE(MessageOf("theta_i,theta_o,450nm,1050nm\n10,20,1,nan\n")
                .find("choose channels that were measured with --channels"),
            std::string::npos);
}

TEST(CsvMarks, AWavelengthThatWandersIsOneChannel) {
  const Measurement one = ReadText("wavelength,theta_i,theta_o,f\n632.81,10,20,1\n632.79,10,30,2\n632.8,10,40,3\n");
  EXPECT_EQ(one.channels.names, (std::vector<std::string>{"632.8nm"}));
  EXPECT_EQ(one.samples.size(), 3U);
  EXPECT_TRUE(HasRemark(one, "3 wavelengths that wander"));
  const Measurement two =
      ReadText("wavelength,theta_i,theta_o,f\n450.1,10,20,1\n550.2,10,20,2\n449.9,10,30,3\n549.8,10,30,4\n");
  EXPECT_EQ(two.channels.wavelengths_nm, (std::vector<double>{450, 550}));
  EXPECT_EQ(two.samples.size(), 2U);
  // Two lasers that are close are two channels where both were used.
  const Measurement lasers =
      ReadText("wavelength,theta_i,theta_o,f\n632.8,10,20,1\n635,10,20,2\n632.8,10,30,3\n635,10,30,4\n");
  EXPECT_EQ(lasers.channels.wavelengths_nm, (std::vector<double>{632.8, 635}));
}

TEST(CsvMarks, AnglesThatNamesOrUnitsBelie) {
  std::string radians = "theta_i,phi_i,theta_o,phi_o,f\n", exchanged = radians, mixed = radians;
  std::string viewer = "theta_i,theta_o,f\n", light = viewer, narrow = viewer, surface = viewer;
  for (int k = 0; k < 12; ++k) {
    radians += "0.5,0," + std::to_string(0.1 * k) + "," + std::to_string(0.5 * k) + ",1\n";
    exchanged += "30,0," + std::to_string(30 * k) + "," + std::to_string(5 * k) + ",1\n";
    mixed += "30,0," + std::to_string(5 * k) + "," + std::to_string(0.5 * k) + ",1\n";
    viewer += "30," + std::to_string(0.1 * k) + ",1\n";
    light += std::to_string(0.1 * k) + ",30,1\n";
    surface += "60," + std::to_string(15 * k) + ",1\n";
    narrow += "30," + std::to_string(0.05 * k) + ",1\n";
  }
  EXPECT_TRUE(HasRemark(ReadText(radians), "are they radians? --angle-unit rad"));
  EXPECT_TRUE(HasRemark(ReadText(exchanged), "are the names of polar angle and azimuth exchanged?"));
  EXPECT_TRUE(HasRemark(ReadText(mixed), "are the azimuths radians?"));
  EXPECT_TRUE(HasRemark(ReadText(viewer), "theta_o only to 1.1: is it in radians?"));
  EXPECT_TRUE(HasRemark(ReadText(light), "theta_i only to 1.1: is it in radians?"));
  EXPECT_TRUE(HasRemark(ReadText(surface), "are angles counted from the surface?"));
  EXPECT_FALSE(HasRemark(ReadText(narrow), "radians"));  // about the normal
}

TEST(CsvMarks, LimitsOfDetectionAndBrackets) {
  const Measurement m = ReadText("theta_i,theta_o,dphi,brdf\n10,20,0,1\n10,30,0,<LOD\n10,40,0,(null)\n10,50,0,> 100\n");
  EXPECT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 3U);
}

TEST(CsvMarks, AColumnOfFlagsIsNamed) {
  constexpr char kFlagged[] = "theta_i,theta_o,dphi,brdf,valid\n10,20,0,1,1\n10,30,0,9,0\n";
  EXPECT_TRUE(HasRemark(ReadText(kFlagged), "the column 'valid' may say which rows are good"));
  ReadOptions options;
  options.where = "valid=1";
  EXPECT_EQ(ReadText(kFlagged, options).samples.size(), 1U);
}

TEST(CsvMarks, WavelengthsWithinAToleranceAreOneChannel) {
  constexpr char kJitter[] =
      "theta_i,theta_o,wavelength_nm,brdf\n10,20,549.99,1\n10,30,550.01,2\n10,20,650.02,3\n10,30,650,4\n"
      "10,20,550.02,9\n";
  // 549.99 and 550.02 of one pair: without the option they are channels of their own, of which no pair has all.
  EXPECT_NE(MessageOf(kJitter).find("5 different wavelengths, and none of the 2 pairs of directions has all of them"),
            std::string::npos);
  ReadOptions options;
  options.wavelength_tolerance_nm = 0.03;
  const Measurement m = ReadText(kJitter, options);
  ASSERT_EQ(m.samples.size(), 2U);
  ASSERT_EQ(m.channels.size(), 2U);
  EXPECT_NEAR(m.channels.wavelengths_nm[0], 550.0067, 1e-4);
  EXPECT_EQ(m.samples.values[1][1], 4);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 1U);
}

// Memory for the rows is asked for by it, and what is too little is copied.
TEST(CsvLines, EstimateOfRowsWhoseLengthVaries) {
  EXPECT_EQ(EstimateLines("a\nb\nc"), 3U);
  std::string text;
  for (int i = 0; i < 200000; ++i)
    text += (i < 100000 ? "10.00000000,20.00000000,1.00000000" : "10,20,1.5") +
            std::string(1 + static_cast<std::size_t>(i % 7), '0') + "\n";
  const std::size_t estimate = EstimateLines(text);
  EXPECT_GE(estimate, 200000U);
  EXPECT_LE(estimate, 206000U);
}

// Each is refused before any of it is looked at.
TEST(CsvLimits, ColumnsWavelengthsAndLines) {
  std::string names = "theta_i,theta_o,dphi", row = "10,20,0";
  for (int i = 0; i < 5000; ++i) {
    names += "," + std::to_string(400 + i) + "nm";
    row += ",1";
  }
  EXPECT_NE(MessageOf(names + "\n" + row + "\n").find("5000 columns hold wavelengths; at most 4096 are read"),
            std::string::npos);
  std::string many = "theta_i,theta_o,brdf";
  for (int i = 0; i < 70000; ++i) many += ",x";
  EXPECT_NE(MessageOf(many + "\n").find("line 1: has 70003 fields; at most 65536 columns are read"), std::string::npos);
  EXPECT_NE(MessageOf("theta_i,theta_o,brdf\n10,20,1\n" + std::string(std::size_t{5} << 20, '1'))
                .find("line 3: has 5242880 bytes; at most 4194304 are read"),
            std::string::npos);
  std::string deep = "theta_i,theta_o,brdf\n";
  while (deep.size() < (std::size_t{9} << 20)) deep += "10,20,1\n";
  const std::size_t lines = static_cast<std::size_t>(std::count(deep.begin(), deep.end(), '\n'));
  EXPECT_NE(MessageOf(deep + std::string(std::size_t{5} << 20, '1') + "\n10,20,1\n")
                .find("line " + std::to_string(lines + 1) + ": has 5242880 bytes; at most 4194304 are read"),
            std::string::npos);
  std::string wander = "theta_i,theta_o,wavelength_nm,brdf\n";
  for (int i = 0; i < 5000; ++i)
    wander += "10," + std::to_string(i % 80) + "," + std::to_string(400 + 0.1 * i) + ",1\n";
  EXPECT_NE(MessageOf(wander).find("5000 different wavelengths at 80 pairs of directions; at most 4096"),
            std::string::npos);
  std::string scattered = "theta_i,theta_o,wavelength_nm,brdf\n";
  for (int i = 0; i < 8000; ++i) {
    scattered += "10," + std::to_string(0.01 * (i + 1)) + "," +
                 std::to_string(i % 4000 + 400 + (i % 4000) * (i % 4000) * 1e-4) + ",1\n";
  }
  EXPECT_NE(
      MessageOf(scattered).find("4000 wavelengths at 8000 pairs of directions, but only 8000 rows: most pairs lack"),
      std::string::npos);
}

}  // namespace
}  // namespace lobefit

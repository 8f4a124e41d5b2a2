// Cells that hold more than a number: units and uncertainties.
#include "lobefit/io/csv/head/cells.h"

#include <cmath>

#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

TEST(CsvCells, NumberUnitAndUncertainty) {
  struct Case {
    const char* text;
    double number, uncertainty;  // -1: none
    const char* unit;
  };
  for (const Case& c :
       {Case{"12.5 deg", 12.5, -1, "deg"}, Case{"12.5°", 12.5, -1, "deg"}, Case{"-3e-2rad", -0.03, -1, "rad"},
        Case{"0.31 1/sr", 0.31, -1, "1/sr"}, Case{"31%", 31, -1, "%"}, Case{"633 nm", 633, -1, "nm"},
        Case{"0.31 ± 0.02", 0.31, 0.02, ""}, Case{"0.31+/-0.02", 0.31, 0.02, ""},
        Case{"3.1e-1 +- 2e-2 1/sr", 0.31, 0.02, "1/sr"}, Case{"(31 ± 2) %", 31, 2, "%"}, Case{"31 % ± 2 %", 31, 2, "%"},
        Case{"0.310(12)", 0.31, 0.012, ""}, Case{"3.10(12)e-1", 0.31, 0.012, ""}, Case{"310(12)", 310, 12, ""}}) {
    const std::optional<Cell> cell = ParseCell(c.text, '.');
    ASSERT_TRUE(cell) << c.text;
    EXPECT_NEAR(cell->number, c.number, 1e-15 * std::fabs(c.number)) << c.text;
    EXPECT_EQ(cell->uncertainty.has_value(), c.uncertainty >= 0) << c.text;
    EXPECT_NEAR(cell->uncertainty.value_or(-1), c.uncertainty, 1e-15) << c.text;
    EXPECT_EQ(cell->unit, c.unit) << c.text;
  }
  for (const char* text : {"", "deg", "12 furlongs", "12:30", "2024-03-01", "01.03.2024", "31 ± 2 %", "0.3 ± x",
                           "0.3(x)", "(0.3)", "1 deg ± 0.1 rad", "10°75'", "10.5°30'"}) {
    EXPECT_FALSE(ParseCell(text, '.')) << text;
  }
  EXPECT_EQ(ParseCell("12,5 deg", ',')->number, 12.5);
  EXPECT_EQ(ParseCell("0,310(12)", ',')->uncertainty, 0.012);
}

TEST(CsvCells, UnitsAreThoseOfTheColumn) {
  for (const char* text :
       {"theta_i,theta_o,dphi,brdf\n10 deg,20 deg,180 deg,0.5 1/sr\n30 deg,40 deg,170 deg,0.25 1/sr\n",
        "theta_i;theta_o;dphi;brdf\n10°;20°;180°;0,5\n30°;40°;170°;0,25\n",
        "# angle-unit: rad\ntheta_i;theta_o;dphi;brdf\n10°;20°;180°;0,5\n30°;40°;170°;0,25\n",
        "theta_i,theta_o,dphi,BRF\n10,20,180,157.07963267948966%\n30,40,170,78.53981633974483%\n",
        "theta_i\ttheta_o\tdphi\tbrdf\n10 deg\t20 deg\t180 deg\t0.5\n30 deg\t40 deg\t170 deg\t0.25\n",
        "Report 7 deg, 8 deg\ntheta_i;theta_o;dphi;brdf\n10 deg;20 deg;180 deg;0,5 1/sr\n30 deg;40 deg;"
        "170 deg;0,25 1/sr\n"}) {
    SCOPED_TRACE(text);
    const Measurement m = ReadText(text);
    ASSERT_EQ(m.samples.size(), 2U);
    ExpectSample(m, 0, 10, 0, 20, 180, 0.5);
    ExpectSample(m, 1, 30, 0, 40, 170, 0.25);
  }
  const Measurement radians = ReadText("theta_i,theta_o,dphi,brdf\n0.5 rad,0,0,1\n0.25 rad,0,0,2\n");
  EXPECT_NEAR(std::acos(radians.samples.wi_z[0]), 0.5, 1e-12);
}

TEST(CsvCells, TwoUnitsAreAsked) {
  const std::string names = "theta_i,theta_o,dphi,brdf\n";
  EXPECT_NE(MessageOf(names + "10 deg,20,0,1\n0.5 rad,20,0,1\n").find("are in 'deg' and in 'rad'"), std::string::npos);
  EXPECT_NE(MessageOf("theta_i (rad),theta_o,dphi,brdf\n10 deg,20,0,1\n").find("in 'deg' by its cells"),
            std::string::npos);
  std::string late = names;
  for (int i = 0; i < 100; ++i) late += "10,20,0,1\n";
  EXPECT_NE(MessageOf(late + "0.5 rad,20,0,1\n").find("write the unit into the name of the column"), std::string::npos);
  EXPECT_NE(MessageOf(names + "10,20,0,0.3 ± 5 %\n").find("in the unit of the value"), std::string::npos);
  EXPECT_NE(MessageOf(names + "10°75',20,0,0.3\n").find("write degrees with decimals"), std::string::npos);
  EXPECT_NE(MessageOf("theta_i;theta_o;dphi;brdf\n10;20;0;0,5\n10;30;0;5 530,6\n").find("between thousands"),
            std::string::npos);
}

TEST(CsvCells, UncertaintiesWithinThem) {
  for (const char* cells : {"0.5 ± 0.02,0.25 ± 0.01", "0.5 +/- 0.02,0.25 +/- 0.01", "0.50(2),0.25(1)"}) {
    const std::string text(cells);
    const std::size_t comma = text.find(',');
    const Measurement m = ReadText("theta_i,theta_o,dphi,brdf\n10,20,180," + text.substr(0, comma) + "\n10,30,180," +
                                   text.substr(comma + 1) + "\n");
    ASSERT_EQ(m.samples.size(), 2U) << cells;
    EXPECT_EQ(m.samples.values[0][1], 0.25) << cells;
    ASSERT_EQ(m.samples.sigma.size(), 2U) << cells;
    EXPECT_NEAR(m.samples.sigma[0], 0.02, 1e-15) << cells;
    EXPECT_NEAR(m.samples.sigma[1], 0.01, 1e-15) << cells;
  }
  const Measurement wide = ReadText("theta_o,AOI 10,AOI 30\n20,0.5 ± 0.02,0.25 ± 0.01\n40,0.4 ± 0.03,0.2\n");
  ASSERT_EQ(wide.samples.size(), 4U);
  EXPECT_EQ(wide.samples.sigma[1], 0.01);
  EXPECT_TRUE(HasRemark(wide, "1 samples have no uncertainty"));
  const Measurement percent = ReadText("theta_i,theta_o,dphi,BRF\n10,20,180,(50 ± 2) %\n10,30,180,(40 ± 1) %\n");
  EXPECT_NEAR(percent.samples.sigma[0], 0.02 / kPi, 1e-15);
}

TEST(CsvCells, RowsWithoutBareNumbersAreNoTitles) {
  const Measurement m = ReadText("theta_i,theta_o=-20,theta_o=0,theta_o=20\n10,OVER,-,0.5\n20,0.1,0.2,0.3\n");
  EXPECT_EQ(m.samples.size(), 4U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 2U);
}

TEST(CsvCells, DegreesAndMinutes) {
  for (const auto& [in, out] : {std::pair{"10\u00b030'", "-40\u00b015'"},
                                {"10d30m", "-40d15m"},
                                {"10 deg 30 min", "-40 deg 15 min"},
                                {"10\u00b030\u2032", "\u221240\u00b015\u203200\u2033"}}) {
    const Measurement m =
        ReadText(std::string("theta_i,theta_o,brdf\n") + in + "," + out + ",1\n10\u00b000',20\u00b000',2\n");
    ASSERT_EQ(m.samples.size(), 2U) << in;
    ExpectSample(m, 0, 10.5, 0, 40.25, 0, 1);
    ExpectSample(m, 1, 10, 0, 20, 180, 2);
  }
  // The minutes of the first row are no unit of the others.
  const Measurement m = ReadText("theta_i,theta_o,brdf\n10\u00b000',20\u00b000',1\n10\u00b000',20\u00b030',2\n");
  ExpectSample(m, 1, 10, 0, 20.5, 180, 2);
  EXPECT_NE(MessageOf("theta_i,theta_o,brdf\n10\u00b075',20\u00b000',1\n"), "(was read)");
}

}  // namespace
}  // namespace lobefit

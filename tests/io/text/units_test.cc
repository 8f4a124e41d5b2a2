// Units as people write them.
#include "lobefit/io/text/units.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

TEST(AngleUnits, HaveTheirSize) {
  struct Spelling {
    const char* unit;
    double per_turn;
  };
  for (const auto& [unit, per_turn] : {Spelling{"deg", 360},
                                       {"°", 360},
                                       {"degrees", 360},
                                       {"º", 360},
                                       {" Deg ", 360},
                                       {"rad", 2 * kPi},
                                       {"radians", 2 * kPi},
                                       {"gon", 400},
                                       {"mrad", 2000 * kPi},
                                       {"arcmin", 360. * 60},
                                       {"arcsec", 360. * 3600}}) {
    const std::optional<AngleUnit> parsed = ParseAngleUnit(unit);
    ASSERT_TRUE(parsed.has_value()) << unit;
    EXPECT_NEAR(per_turn * RadiansPerUnit(*parsed), 2 * kPi, 1e-12) << unit;
  }
  for (const char* unit : {"grad", "", "m", "turns", "deg/s"}) EXPECT_FALSE(ParseAngleUnit(unit).has_value()) << unit;
}

// Every form is the inverse of how the number came to be, and the slope is its derivative.
TEST(ValueScales, UndoWhatWasDone) {
  struct Written {
    const char* unit;
    double number, value;
  };
  for (const auto& [unit, number, value] : {Written{"1/sr", 0.3, 0.3},
                                            {"sr^-1", 0.3, 0.3},
                                            {"sr⁻¹", 0.3, 0.3},
                                            {"1", 0.3, 0.3},
                                            {"%", 30, 0.3},
                                            {"dB", -20, 0.01},
                                            {"log10", -2, 0.01},
                                            {"ln", std::log(0.25), 0.25},
                                            {"1e-3/sr", 7, 0.007},
                                            {"10^-3/sr", 7, 0.007}}) {
    const std::optional<ValueScale> scale = ParseValueScale(unit);
    ASSERT_TRUE(scale.has_value()) << unit;
    EXPECT_NEAR(scale->Apply(number), value, 1e-14) << unit;
    EXPECT_FALSE(scale->arbitrary) << unit;
    const double h = 1e-5;
    EXPECT_NEAR(scale->Slope(number), (scale->Apply(number + h) - scale->Apply(number - h)) / (2 * h),
                1e-8 * std::fabs(scale->Slope(number)))
        << unit;
    EXPECT_EQ(scale->IsIdentity(), scale->Apply(0.37) == 0.37) << unit;
  }
  for (const char* unit : {"a.u.", "counts"}) {
    ASSERT_TRUE(ParseValueScale(unit).has_value()) << unit;
    EXPECT_TRUE(ParseValueScale(unit)->arbitrary) << unit;
  }
  for (const char* unit : {"W", "1/m", "sr", "dBm", "log2", "%%", "1e999/sr", "0/sr", "nan", "inf", "-1/sr"})
    EXPECT_FALSE(ParseValueScale(unit).has_value()) << unit;
}

// 500 nm in every unit of length, of wavenumber, of energy and of frequency (CODATA: exact).
TEST(WavelengthUnits, GiveNanometres) {
  constexpr double kPlanck = 6.62607015e-34, kLight = 299792458, kCharge = 1.602176634e-19, kMetres = 500e-9;
  struct Written {
    const char* unit;
    double number;
  };
  for (const auto& [unit, number] : {Written{"nm", 500},
                                     {"um", 0.5},
                                     {"µm", 0.5},
                                     {"mm", 5e-4},
                                     {"m", 5e-7},
                                     {"A", 5000},
                                     {"cm^-1", 20000},
                                     {"m^-1", 2e6},
                                     {"um^-1", 2},
                                     {"eV", kPlanck * kLight / kMetres / kCharge},
                                     {"THz", kLight / kMetres / 1e12},
                                     {"GHz", kLight / kMetres / 1e9},
                                     {"Hz", kLight / kMetres}}) {
    const std::optional<WavelengthUnit> parsed = ParseWavelengthUnit(unit);
    ASSERT_TRUE(parsed.has_value()) << unit;
    EXPECT_NEAR(parsed->ToNm(number), 500, 1e-9) << unit;
  }
  for (const char* unit : {"", "s", "deg", "kg", "nmm"}) EXPECT_FALSE(ParseWavelengthUnit(unit).has_value()) << unit;
}

TEST(PlainUnit, IsAscii) {
  EXPECT_EQ(PlainUnit("sr⁻¹"), "sr^-1");
  EXPECT_EQ(PlainUnit(" µm "), "um");
  EXPECT_EQ(PlainUnit("μm"), "um") << "the Greek letter too";
  EXPECT_EQ(PlainUnit("1E-3 1/SR"), "1e-3*1/sr");
  EXPECT_EQ(PlainUnit(""), "");
  for (const char* unit : {"1/sr", "sr^-1", "sr-1", "per sr"})
    EXPECT_TRUE(IsPerSteradian(PlainUnit(unit))) << unit << " is " << PlainUnit(unit);
  EXPECT_FALSE(IsPerSteradian("sr") || IsPerSteradian("") || IsPerSteradian("1"));
}

}  // namespace
}  // namespace lobefit

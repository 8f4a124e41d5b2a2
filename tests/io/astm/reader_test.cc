#include "lobefit/io/astm/reader.h"

#include <cmath>

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

TEST(Astm, ColumnsAreTakenByName) {
  constexpr char kFile[] =
      "LAB_NAME \"Somewhere\"\r\nMEAS_NAME BRDF\r\nNUM_POINTS 4\r\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\r\n"
      "0.5,0,0.25,-3,0.1,0.2,0.3\r\n0.5,0.1,-0.25,0.5,1,2,3\r\n0.5,0.1,1.6,0.5,1,2,3\r\n0.5,0,0.25,-3,9,9,9\r\n";
  ASSERT_TRUE(IsAstm(kFile));
  const Measurement m = ReadBytes(ReadAstm, kFile);
  ASSERT_EQ(m.samples.size(), 2U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 1U);
  const double degrees = 180 / kPi;
  ExpectAngles(m.samples.wi(1), 0.5 * degrees, 0.1 * degrees);
  ExpectAngles(m.samples.wo(0), 0.25 * degrees, -3 * degrees);
  ExpectAngles(m.samples.wo(1), 0.25 * degrees, (0.5 + kPi) * degrees);
  EXPECT_EQ(m.samples.values[1], (std::vector<double>{0.2, 2}));
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{5, 6}));
  EXPECT_FALSE(m.isotropic);
  EXPECT_EQ(m.conventions.at("angle-unit"), "rad (default)");
  EXPECT_EQ(m.conventions.at("value-kind"), "f (header)");
}

TEST(Astm, WithoutIncidentAzimuthItIsIsotropic) {
  const Measurement m = ReadBytes(ReadAstm, "VARS theta_i, theta_s, phi_s, 465nm, 525.5nm\n0.5,0.25,1,3,4\n");
  EXPECT_TRUE(m.isotropic);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{465, 525.5}));
  ExpectAngles(m.samples.wi(0), 0.5 * 180 / kPi, 0);
  EXPECT_EQ(m.samples.values[1][0], 4);
}

TEST(Astm, OptionsAndMeasuredQuantityDecide) {
  const std::string rows = "VARS theta_i,phi_i,theta_s,phi_s,Integrated 400-700\n60,10,30,20,0.5\n";
  ReadOptions options;
  options.angle_unit = AngleUnit::kDegrees;
  options.incident_sense = IncidentSense::kPropagation;
  const Measurement dsf = ReadBytes(ReadAstm, "MEAS_NAME DSF\n" + rows, options);
  ExpectAngles(dsf.samples.wi(0), 60, 190);
  ExpectAngles(dsf.samples.wo(0), 30, 20);
  EXPECT_NEAR(dsf.samples.values[0][0], 0.5 / std::cos(kPi / 6), 1e-15);
  EXPECT_EQ(dsf.channels.names, std::vector<std::string>{"Y"});
  options.value_kind = ValueKind::kBrdfCosI;
  EXPECT_NEAR(ReadBytes(ReadAstm, "MEAS_NAME DSF\n" + rows, options).samples.values[0][0], 1, 1e-15);
}

TEST(Astm, SaysWhatIsWrongAndWhere) {
  const std::string head = "VARS theta_i,phi_i,theta_s,phi_s,R\n";
  EXPECT_EQ(ErrorOf(ReadAstm, head + "45,0,0.1,0,1\n"),
            "line 2: theta_i is 45, beyond a half turn in radians; for degrees use --angle-unit deg");
  EXPECT_EQ(ErrorOf(ReadAstm, head + "0.5,0,0.1,0\n"),
            "line 2: has 4 fields; VARS in line 1 names 5 columns, separated by commas");
  EXPECT_EQ(ErrorOf(ReadAstm, head + "0.5,0,,0,1\n"),
            "line 2: theta_s is '', which is not a number; write it as in 0.25 or 2.5e-1");
  EXPECT_EQ(
      ErrorOf(ReadAstm, "NUM_POINTS 3\n" + head + "0.5,0,0.1,0,1\n"),
      "line 3: the file ends after 1 rows, but NUM_POINTS in line 1 announces 3; it is cut off: fetch it again or "
      "correct the count");
  EXPECT_EQ(ErrorOf(ReadAstm, "NUM_POINTS 3\n"),
            "line 1: the file ends without the line VARS that names the columns, as in 'VARS "
            "theta_i,phi_i,theta_s,phi_s,R,G,B'");
  EXPECT_EQ(ErrorOf(ReadAstm, "VARS theta_i,phi_i,R\n"),
            "line 1: VARS is 'theta_i,phi_i,R'; it needs theta_i, theta_s, phi_s (phi_i may be missing) and a value");
  EXPECT_EQ(ErrorOf(ReadAstm, "VARS theta_i,theta_s,theta_r,phi_s,R\n"),
            "line 1: VARS names the column 'theta_r' twice");
}

}  // namespace
}  // namespace lobefit

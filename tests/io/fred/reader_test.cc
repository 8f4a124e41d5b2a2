#include "lobefit/io/fred/reader.h"

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

constexpr char kTwoIncidences[] =
    "!! made by hand\ntype bsdf_data\nformat angles=deg bsdf=value "
    "scale=2\n10\t0\n0\t0\t0.5\n20\t30\t0.25\n-20\t30\t0.75\n"
    "40 90\n91 0 1\n15 0 nan\n15 0 -0.5";

TEST(Fred, RowsBelongToTheIncidenceAboveThem) {
  ASSERT_TRUE(IsFred(kTwoIncidences));
  const Measurement m = ReadBytes(ReadFred, kTwoIncidences);
  ASSERT_EQ(m.samples.size(), 4U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kNotFinite], 1U);
  // The incident azimuth is that of the propagation: the light stands opposite.
  ExpectAngles(m.samples.wi(0), 10, 180);
  ExpectAngles(m.samples.wi(3), 40, 270);
  ExpectAngles(m.samples.wo(1), 20, 30);
  ExpectAngles(m.samples.wo(2), 20, 210);
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{1, 0.5, 1.5, -1}));
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{5, 6, 7, 11}));
  EXPECT_EQ(m.conventions.at("incident"), "propagation (default)");

  ReadOptions options;
  options.incident_sense = IncidentSense::kTowardsSource;
  ExpectAngles(ReadBytes(ReadFred, kTwoIncidences, options).samples.wi(0), 10, 0);
}

TEST(Fred, RadiansAreRead) {
  const Measurement m = ReadBytes(ReadFred, "type bsdf_data\nformat angles=rad bsdf=value\n0.5 0\n0.25 1 1\n");
  ExpectAngles(m.samples.wo(0), 0.25 * 180 / kPi, 180 / kPi);
}

TEST(Fred, SaysWhatIsWrongAndWhere) {
  const std::string head = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n";
  EXPECT_EQ(ErrorOf(ReadFred, head + "1 2 3\n"),
            "line 3: a row theta_s phi_s value stands before the first line theta_i phi_i; add the incidence");
  EXPECT_EQ(ErrorOf(ReadFred, head + "10 0\n1 2 3 4\n"),
            "line 4: has 4 fields; allowed are 2 (theta_i phi_i, a new incidence) or 3 (theta_s phi_s value)");
  EXPECT_EQ(ErrorOf(ReadFred, head + "10 0\n1 2 3,5\n"),
            "line 4: value is '3,5', which is not a number; write a decimal point instead of a comma");
  EXPECT_EQ(
      ErrorOf(ReadFred, "type bsdf_data\nformat angles=deg bsdf=sqrt\n"),
      "line 2: the format line has 'bsdf=sqrt', which is not known; allowed are angles=deg, angles=rad, angles=sin, "
      "bsdf=value, bsdf=log and scale=NUMBER");
  EXPECT_EQ(ErrorOf(ReadFred, "type bsdf_data\n"),
            "line 1: the file ends before its format line ('format angles=deg bsdf=value scale=1'); it may be cut off");
}

}  // namespace
}  // namespace lobefit

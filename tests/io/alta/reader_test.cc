#include "lobefit/io/alta/reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "tests/support/read_bytes.h"

#include "lobefit/base/text/text.h"
#include "lobefit/io/alta/directions.h"

namespace lobefit {
namespace {

std::string Text(const std::string& in, const std::string& dim, const std::string& rows,
                 const std::string& more = "#PARAM_OUT INV_STERADIAN\n") {
  return "#SAMPLE made by hand\n# a comment\n#DIM " + dim + "\n#PARAM_IN " + in + "\n" + more + rows;
}

// Found by fuzzing: the ratio of the squares was 0.
TEST(Alta, WidestIntervalStillHasAWeight) {
  const Measurement m =
      ReadBytes(ReadAlta, Text("COS_TH", "1 1", "0.5 1 1e-100\n0.6 1 1e100\n", "#PARAM_OUT INV_STERADIAN\n#VS 1\n"));
  ASSERT_EQ(m.samples.weight.size(), 2U);
  EXPECT_NEAR(m.samples.weight[1] / m.samples.weight[0], 1e-12, 1e-20);
}

TEST(Alta, CosineFactorIsTheOutgoingOne) {
  // Light at 60, view at 30 degrees; the view's coordinates are theta cos, theta sin of the azimuth difference.
  const std::string rows =
      "1.0471975511965976 -0.52359877559829882 0 2\n\n# between\n1.0471975511965976 0 0.52359877559829882 3\n";
  const std::string bytes =
      Text("ISOTROPIC_TL_TV_PROJ_DPHI", "3 1", rows, "#VS 0\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n");
  ASSERT_TRUE(IsAlta(bytes));
  const Measurement m = ReadBytes(ReadAlta, bytes);
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectAngles(m.samples.wi(0), 60, 0);
  ExpectAngles(m.samples.wo(0), 30, 180);
  ExpectAngles(m.samples.wo(1), 30, 90);
  EXPECT_NEAR(m.samples.values[0][0], 2 / std::sqrt(0.75), 1e-14);
  EXPECT_NEAR(m.samples.values[0][1], 3 / std::sqrt(0.75), 1e-14);
  EXPECT_EQ(m.samples.origin, (std::vector<std::uint32_t>{7, 10}));
  EXPECT_TRUE(m.isotropic);
  EXPECT_TRUE(m.samples.weight.empty());

  ReadOptions options;
  options.value_kind = ValueKind::kReflectanceFactor;
  EXPECT_NEAR(ReadBytes(ReadAlta, bytes, options).samples.values[0][0], 2 / kPi, 1e-15);
}

TEST(Alta, AllEndMarksEndTheHeader) {
  for (const char* mark : {"#ALTA HEADER END\n", "#ALTA END HEADER\n", "#ALTA_END_HEADER\n"}) {
    // After the mark a line '#...' is a comment, whatever it looks like.
    const Measurement m =
        ReadBytes(ReadAlta, "#ALTA HEADER BEGIN\n" +
                                Text("CARTESIAN", "6 1", std::string(mark) + "#DIM 9 9\n0 0.6 0.8 0.8 0 0.6 0.5\n"));
    ASSERT_EQ(m.samples.size(), 1U) << mark;
    // The view comes first.
    ExpectVector(m.samples.wo(0), {0, 0.6, 0.8});
    ExpectVector(m.samples.wi(0), {0.8, 0, 0.6});
    EXPECT_FALSE(m.isotropic);
  }
}

TEST(Alta, ChannelsFollowTheOutput) {
  const auto names = [](const std::string& out, const std::string& count, const std::string& values) {
    return ReadBytes(ReadAlta, Text("COS_TH", "1 " + count, "0.5 " + values + "\n", "#PARAM_OUT " + out + "\n"))
        .channels.names;
  };
  EXPECT_EQ(names("RGB_COLOR", "3", "1 2 3"), (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(names("XYZ_COLOR", "3", "1 2 3"), (std::vector<std::string>{"X", "Y", "Z"}));
  EXPECT_EQ(names("INV_STERADIAN", "1", "1"), std::vector<std::string>{"Y"});
  EXPECT_EQ(names("INV_STERADIAN", "2", "1 2"), (std::vector<std::string>{"y1", "y2"}));
}

// The coordinates of a pair of directions, straight from the definitions: H = (L + V) / 2, B = (L - V) / 2, K = the
// half vector of L and the mirrored V, D = the view in the frame of H, dphi as named.
struct Definition {
  const char* name;
  int dimension;
  std::function<std::array<double, 6>(const Vec3& l, const Vec3& v)> coordinates;
};

double Angle(double sine, double cosine) { return std::atan2(sine, cosine); }
Vec3 BackVector(const Vec3& l, const Vec3& v) { return Normalized(Vec3{l.x - v.x, l.y - v.y, l.z + v.z}); }
double HalfAzimuth(const Vec3& l, const Vec3& v) { return Angle(l.y + v.y, l.x + v.x); }
double BackAzimuth(const Vec3& l, const Vec3& v) { return Angle(l.y - v.y, l.x - v.x); }
double Theta(const Vec3& w) { return std::acos(w.z); }
double Phi(const Vec3& w) { return Angle(w.y, w.x); }
Vec3 DifferenceVector(const Vec3& l, const Vec3& v) {
  const Vec3 h = Normalized(l + v);
  // Rows of the rotation that takes h to z by way of its own azimuth.
  const double sine = std::hypot(h.x, h.y), c = h.x / sine, s = h.y / sine;
  return {h.z * (c * v.x + s * v.y) - sine * v.z, -s * v.x + c * v.y, Dot(h, v)};
}

const std::vector<Definition>& Definitions() {
  static const std::vector<Definition> definitions = {
      {"COS_TH", 1, [](const Vec3& l, const Vec3& v) -> std::array<double, 6> { return {Normalized(l + v).z}; }},
      {"COS_TK", 1, [](const Vec3& l, const Vec3& v) -> std::array<double, 6> { return {BackVector(l, v).z}; }},
      {"COS_TLV", 1, [](const Vec3& l, const Vec3& v) -> std::array<double, 6> { return {Dot(l, v)}; }},
      {"COS_TLR", 1,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {Dot(l, {-v.x, -v.y, v.z})};
       }},
      {"RUSIN_TH_TD", 2,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {Theta(Normalized(l + v)), std::acos(DifferenceVector(l, v).z)};
       }},
      {"COS_TH_TD", 2,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {Normalized(l + v).z, DifferenceVector(l, v).z};
       }},
      {"STARK_2D", 2,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {std::hypot(l.x + v.x, l.y + v.y) / 2, Norm(l - v) / 2};
       }},
      {"NEUMANN_2D", 2,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {std::hypot(l.x + v.x, l.y + v.y) / 2, std::hypot(l.x - v.x, l.y - v.y) / 2};
       }},
      {"RUSIN_TH_TD_PD", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         const Vec3 d = DifferenceVector(l, v);
         return {Theta(Normalized(l + v)), std::acos(d.z), Phi(d)};
       }},
      {"ISOTROPIC_TV_TL_DPHI", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {Theta(v), Theta(l), Phi(l) - Phi(v)};
       }},
      {"ISOTROPIC_TL_TV_PROJ_DPHI", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         const double phi = Phi(v) - Phi(l);
         return {Theta(l), Theta(v) * std::cos(phi), Theta(v) * std::sin(phi)};
       }},
      {"SCHLICK_TL_TK_PROJ_DPHI", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         // Half vector of V and of the light's mirror image R.
         const Vec3 k = Normalized(Vec3{v.x - l.x, v.y - l.y, v.z + l.z});
         const double phi = Phi(k) - Phi(l);
         return {Theta(l), Theta(k) * std::cos(phi), Theta(k) * std::sin(phi)};
       }},
      {"RETRO_TL_TVL_PROJ_DPHI", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         const double between = std::acos(Dot(l, v)), dphi = Phi(v) - Phi(l);
         // Spherical triangle of L, V and the normal: cosine rule for the side opposite L, sine rule for V's angle.
         const double cosine = (v.z - l.z * Dot(l, v)) / (std::sin(Theta(l)) * std::sin(between));
         const double sine = std::sin(dphi) * std::sin(Theta(v)) / std::sin(between);
         return {Theta(l), between * cosine, between * sine};
       }},
      {"STARK_3D", 3,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> {
         return {std::hypot(l.x + v.x, l.y + v.y) / 2, Norm(l - v) / 2, BackAzimuth(l, v) - HalfAzimuth(l, v)};
       }},
      {"NEUMANN_3D", 3,
       [](const Vec3& l, const Vec3& v) -> std::
                                            array<double, 6> {
                                              return {std::hypot(l.x + v.x, l.y + v.y) / 2,
                                                      std::hypot(l.x - v.x, l.y - v.y) / 2,
                                                      BackAzimuth(l, v) - HalfAzimuth(l, v)};
                                            }},
      {"RUSIN_VH", 3,
       [](const Vec3& l, const Vec3& v) -> std::
                                            array<double, 6> {
                                              const Vec3 h = Normalized(l + v);
                                              return {h.x, h.y, h.z};
                                            }},
      {"SCHLICK_VH", 3,
       [](const Vec3& l, const Vec3& v) -> std::
                                            array<double, 6> {
                                              const Vec3 k = BackVector(l, v);
                                              return {k.x, k.y, k.z};
                                            }},
      {"RUSIN_TH_PH_TD_PD", 4,
       [](const Vec3& l, const Vec3& v) -> std::
                                            array<double, 6> {
                                              const Vec3 h = Normalized(l + v), d = DifferenceVector(l, v);
                                              return {Theta(h), Phi(h), std::acos(d.z), Phi(d)};
                                            }},
      {"SPHERICAL_TL_PL_TV_PV", 4,
       [](const Vec3& l, const Vec3& v) -> std::
                                            array<double, 6> {
                                              return {Theta(l), Phi(l), Theta(v), Phi(v)};
                                            }},
      {"STEREOGRAPHIC", 4,
       [](const Vec3& l,
          const Vec3& v) -> std::
                             array<double, 6> {
                               return {v.x / (1 + v.z), v.y / (1 + v.z), l.x / (1 + l.z), l.y / (1 + l.z)};
                             }},
      {"CARTESIAN", 6,
       [](const Vec3& l, const Vec3& v) -> std::array<double, 6> { return {v.x, v.y, v.z, l.x, l.y, l.z}; }},
  };
  return definitions;
}

Vec3 RandomDirection(std::mt19937_64* random) {
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  return FromSpherical(unit(*random) * kPi / 2, (2 * unit(*random) - 1) * kPi);
}

// The directions that are read have the coordinates that were written; with 4 and 6 coordinates they are the
// directions, with 3 isotropic ones they are the directions up to the azimuth of the pair.
TEST(Alta, EveryParametrisationGivesItsOwnCoordinatesBack) {
  std::mt19937_64 random(7);
  for (const Definition& definition : Definitions()) {
    SCOPED_TRACE(definition.name);
    const AltaInput* input = nullptr;
    for (const AltaInput& candidate : AltaInputs()) {
      if (candidate.name == definition.name) input = &candidate;
    }
    ASSERT_NE(input, nullptr);
    ASSERT_EQ(input->dimension, static_cast<std::size_t>(definition.dimension));
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 l = RandomDirection(&random), v = RandomDirection(&random);
      const std::array<double, 6> x = definition.coordinates(l, v);
      Vec3 wi = {}, wo = {};
      input->convert(x.data(), &wi, &wo);
      if (wi.z <= 0 || wo.z <= 0) {
        // One or two coordinates do not fix the pair, and the pair chosen for them may lie below the horizon.
        EXPECT_LT(definition.dimension, 3);
        continue;
      }
      EXPECT_NEAR(Norm(wi), 1, 1e-13);
      EXPECT_NEAR(Norm(wo), 1, 1e-13);
      const std::array<double, 6> back = definition.coordinates(wi, wo);
      const bool angle_last = definition.dimension == 3;  // azimuths: modulo a full turn
      for (int i = 0; i < definition.dimension; ++i) {
        const double difference = angle_last && i == 2 ? std::remainder(back[2] - x[2], 2 * kPi) : back[i] - x[i];
        EXPECT_NEAR(difference, 0, 1e-7) << i;  // acos near 1 loses half of the digits
      }
      if (definition.dimension >= 4) {
        ExpectVector(wi, l, 1e-10);
        ExpectVector(wo, v, 1e-10);
      } else if (definition.dimension == 3 && input->isotropic) {
        EXPECT_NEAR(wi.z, l.z, 1e-9);
        EXPECT_NEAR(wo.z, v.z, 1e-9);
        EXPECT_NEAR(Dot(wi, wo), Dot(l, v), 1e-9);
        // The pair is turned, not mirrored.
        EXPECT_NEAR(Cross(wi, wo).z, Cross(l, v).z, 1e-7);
      }
    }
  }
}

TEST(Alta, ViewAloneLiesRoundTheNormalLight) {
  const Measurement m = ReadBytes(ReadAlta, Text("ISOTROPIC_TV_PROJ_DPHI", "2 1", "0 0.5 1\n0 0 2\n"));
  ExpectVector(m.samples.wi(0), {0, 0, 1});
  ExpectVector(m.samples.wo(0), {0, std::sin(0.5), std::cos(0.5)});
  ExpectVector(m.samples.wo(1), {0, 0, 1});
}

TEST(Alta, BothSpellingsOfTheBackVector) {
  for (const char* name : {"SCHLICK_VK", "SCHLICK_VH"}) {
    const Measurement m = ReadBytes(ReadAlta, Text(name, "3 1", "0 0.6 0.8 1\n"));
    ExpectVector(m.samples.wi(0), {0, 0.6, 0.8});
    ExpectVector(m.samples.wo(0), {0, -0.6, 0.8});
  }
}

TEST(Alta, ImpossibleCoordinatesAreBelowTheHorizon) {
  const Measurement m = ReadBytes(ReadAlta, Text("STARK_2D", "2 1", "0.9 0.9 1\n0.5 0.5 1\n"));
  EXPECT_EQ(m.samples.size(), 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 1U);
  EXPECT_EQ(ReadBytes(ReadAlta, Text("COS_TH", "1 1", "1.5 1\n1.0000000001 1\n")).set_aside[SetAsideReason::kNotFinite],
            1U);
}

TEST(Alta, IntervalsBecomeWeights) {
  // Half-widths 0.1 and 0.2: weights 1 : 1/4, scaled to mean 1.
  const Measurement one =
      ReadBytes(ReadAlta, Text("COS_TH", "1 1", "0.5 1 0.1\n0.6 1 0.2\n", "#PARAM_OUT INV_STERADIAN\n#VS 1\n"));
  ASSERT_EQ(one.samples.weight.size(), 2U);
  EXPECT_NEAR(one.samples.weight[0], 1.6, 1e-14);
  EXPECT_NEAR(one.samples.weight[1], 0.4, 1e-14);
  EXPECT_EQ(one.conventions.at("alta-interval"), "half-width");

  // Bounds 0.9 .. 1.1 and 0.8 .. 1.2: every value lies between them.
  const std::string bounds =
      Text("COS_TH", "1 1", "0.5 1 0.9 1.1\n0.6 1 0.8 1.2\n", "#PARAM_OUT INV_STERADIAN\n#VS 2\n");
  const Measurement two = ReadBytes(ReadAlta, bounds);
  EXPECT_NEAR(two.samples.weight[0], 1.6, 1e-13);
  EXPECT_EQ(two.conventions.at("alta-interval"), "bounds (every value lies between)");
  ReadOptions options;
  options.alta_interval = IntervalKind::kOffsets;
  EXPECT_NEAR(ReadBytes(ReadAlta, bounds, options).samples.weight[0], 1, 1e-13);  // (0.9 + 1.1) and (0.8 + 1.2)

  const std::string offsets =
      Text("COS_TH", "1 1", "0.5 1 0.05 0.15\n0.6 1 0.1 0.3\n", "#PARAM_OUT INV_STERADIAN\n#VS 2\n");
  EXPECT_NEAR(ReadBytes(ReadAlta, offsets).samples.weight[0], 1.6, 1e-13);
  options.alta_interval = IntervalKind::kBounds;
  EXPECT_EQ(
      ErrorOf(ReadAlta, offsets, options),
      "line 7: the value does not lie between the two columns of its interval; --alta-interval offsets reads them as "
      "distances from the value");
}

TEST(Alta, IntervalsAreConvertedWithTheirValue) {
  // f cos at cos 0.5 and 1 with the same half-width: the standard deviation of f is twice as large at cos 0.5.
  const Measurement m =
      ReadBytes(ReadAlta, Text("ISOTROPIC_TV_TL_DPHI", "3 1", "1.0471975511965976 0.2 0 1 0.1\n0 0.2 0 1 0.1\n",
                               "#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n#VS 1\n"));
  EXPECT_NEAR(m.samples.weight[1] / m.samples.weight[0], 4, 1e-12);
}

TEST(Alta, WeightsStayWithTheirSamples) {
  // The first row lies below the horizon and the third repeats the second.
  const Measurement m = ReadBytes(ReadAlta, Text("ISOTROPIC_TV_TL_DPHI", "3 1",
                                                 "1.6 0.2 0 1 5\n0.1 0.2 0 1 0.1\n0.1 0.2 0 1 0.7\n0.3 0.2 0 1 0.2\n",
                                                 "#PARAM_OUT INV_STERADIAN\n#VS 1\n"));
  ASSERT_EQ(m.samples.weight.size(), 2U);
  EXPECT_NEAR(m.samples.weight[0], 1.6, 1e-13);
  EXPECT_NEAR(m.samples.weight[1], 0.4, 1e-13);
}

std::string Doubles(const std::vector<double>& values, bool big_endian) {
  std::string bytes;
  for (const double value : values) {
    std::string one(sizeof(value), '\0');
    std::memcpy(one.data(), &value, sizeof(value));
    bytes += big_endian ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

std::string Binary(const std::string& count, const std::string& endian, const std::string& data,
                   const std::string& more = "", const std::string& dim = "3 1") {
  return "#DIM " + dim +
         "\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n#PARAM_OUT INV_STERADIAN\n#FORMAT binary\n#VERSION 0\n" +
         "#PRECISION ieee754-double\n#SAMPLE_COUNT " + count + "\n" + more + "#ENDIAN " + endian + "\n#BEGIN_STREAM\n" +
         data + "\n#END_STREAM\n";
}

TEST(Alta, BinaryOfBothByteOrders) {
  const std::vector<double> rows = {0.5, -0.25, 0, 7, 0.25, 0, 0.125, 8};
  for (const bool big : {false, true}) {
    const std::string bytes = Binary("2", big ? "big" : "little", Doubles(rows, big));
    ASSERT_TRUE(IsAlta(bytes));
    const Measurement m = ReadBytes(ReadAlta, bytes);
    ASSERT_EQ(m.samples.size(), 2U);
    ExpectVector(m.samples.wi(0), {std::sin(0.5), 0, std::cos(0.5)});
    ExpectVector(m.samples.wo(0), {-std::sin(0.25), 0, std::cos(0.25)});
    EXPECT_EQ(m.samples.values[0], (std::vector<double>{7, 8}));
  }
}

// As older versions wrote it: an end mark in place of #BEGIN_STREAM, nothing behind the data.
TEST(Alta, BinaryMayBeEndedByTheMarkAndTheFile) {
  std::string bytes = Binary("1", "little", Doubles({0.5, -0.25, 0, 7}, false));
  bytes.erase(bytes.rfind("\n#END_STREAM"));
  const std::string begin = "#BEGIN_STREAM\n";
  std::string both = bytes;
  both.insert(both.find(begin), "#ALTA HEADER END\n");
  EXPECT_EQ(ReadBytes(ReadAlta, both).samples.values[0][0], 7);
  bytes.replace(bytes.find(begin), begin.size(), "#ALTA_END_HEADER\n");
  EXPECT_EQ(ReadBytes(ReadAlta, bytes).samples.values[0][0], 7);
  EXPECT_EQ(
      ErrorOf(ReadAlta, bytes + "x"),
      "byte 202: found 'x' where #END_STREAM should end the data; #SAMPLE_COUNT, #DIM or #VS does not fit the file");
}

TEST(Alta, BinaryIntervalsFollowTheValuesEndByEnd) {
  // Two outputs: low ends of both, then high ends of both.
  const std::vector<double> rows = {0.5, -0.25, 0, 1, 10, 0.9, 9, 1.1, 11, 0.25, 0, 0.125, 1, 10, 0.8, 8, 1.2, 12};
  const Measurement m = ReadBytes(ReadAlta, Binary("2", "little", Doubles(rows, false), "#VS 2\n", "3 2"));
  EXPECT_NEAR(m.samples.weight[0], 1.6, 1e-13);
  EXPECT_EQ(m.conventions.at("alta-interval"), "bounds (every value lies between)");
}

TEST(Alta, SaysWhatIsWrongInBinaryAndWhere) {
  const std::string data = Doubles({0.5, -0.25, 0, 7}, false);
  EXPECT_EQ(ErrorOf(ReadAlta, Binary("2", "little", data)),
            "byte 167: 2 rows of 4 numbers should follow, but the file has only 45 more bytes; it is cut off");
  EXPECT_EQ(
      ErrorOf(ReadAlta, Binary("1", "little", data + "\nmore")),
      "byte 199: found 'more?#END_STREAM' where #END_STREAM should end the data; #SAMPLE_COUNT, #DIM or #VS does not "
      "fit the file");
  EXPECT_EQ(ErrorOf(ReadAlta, Binary("1000", "little", data)),
            "byte 170: 1000 rows of 4 numbers should follow, but the file has only 45 more bytes; it is cut off");
  EXPECT_EQ(ErrorOf(ReadAlta, Binary("4611686018427387904", "little", data)),
            "byte 185: 4611686018427387904 rows of 4 numbers should follow, but the file has only 45 more bytes; it is "
            "cut off");
  EXPECT_EQ(ErrorOf(ReadAlta, Binary("1", "middle", data)), "line 8: #ENDIAN is 'middle'; allowed are little and big");
}

TEST(Alta, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(ErrorOf(ReadAlta, "#PARAM_IN COS_TH\n0.5 1\n"),
            "line 1: the header ends without #DIM; add it, as in '#DIM 3 1'");
  EXPECT_EQ(ErrorOf(ReadAlta, Text("COS_TH", "2 1", "0.5 1\n")),
            "line 4: #PARAM_IN COS_TH has 1 coordinates, but #DIM states 2");
  const std::string unknown = ErrorOf(ReadAlta, Text("RUSIN_TH_DT", "2 1", "0.5 1 1\n"));
  EXPECT_TRUE(
      unknown.starts_with("line 4: #PARAM_IN is 'RUSIN_TH_DT' (did you mean 'RUSIN_TH_TD'?); directions are known for "
                          "COS_TH, COS_TK, "))
      << unknown;
  EXPECT_EQ(ErrorOf(ReadAlta, Text("COS_TH", "1 1", "0.5 1 2\n")),
            "line 6: has 3 numbers; the header announces 2 (coordinates 1, values 1, columns of confidence 0)");
  EXPECT_EQ(ErrorOf(ReadAlta, Text("RUSIN_TH_TD", "2 1", "45 30 1\n")),
            "line 6: coordinate 1 is 45, beyond 2 pi; ALTA angles are in radians and vectors of length 1");
  EXPECT_EQ(ErrorOf(ReadAlta, Text("COS_TH", "1 1", "0.5 1\n", "#PARAM_OUT ENERGY\n")),
            "line 5: #PARAM_OUT is 'ENERGY', which does not say what the values are; known are INV_STERADIAN, "
            "INV_STERADIAN_COSINE_FACTOR, RGB_COLOR and XYZ_COLOR: state it with --value-kind, "
            "one of f, f-cos-o, f-cos-i, pi-f, intensity, pi-f-cos-o, pi-f-cos-i");
  EXPECT_EQ(ErrorOf(ReadAlta, Text("COS_TH", "1 1", "")), "line 5: the file ends without a row of data");
  EXPECT_EQ(ErrorOf(ReadAlta, Text("COS_TH", "1 1", "#DIM 1 1\n0.5 1\n")),
            "line 6: the key #DIM stands in line 3 already");
}

}  // namespace
}  // namespace lobefit

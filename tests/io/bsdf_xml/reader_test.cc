#include "lobefit/io/bsdf_xml/reader.h"

#include <chrono>
#include <cmath>
#include <random>

#include "tests/support/read_bytes.h"

#include "lobefit/base/text/text.h"
#include "lobefit/io/bsdf_xml/angle_basis.h"
#include "lobefit/io/bsdf_xml/lookup.h"
#include "lobefit/io/bsdf_xml/tensor_tree.h"

namespace lobefit {
namespace {

std::string File(const std::string& structure, const std::string& data, const std::string& bases = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- by hand -->\n<WindowElement "
         "xmlns=\"http://windows.lbl.gov\">\n"
         "<Optical>\n<Layer>\n<DataDefinition>\n<IncidentDataStructure>" +
         structure + "</IncidentDataStructure>\n" + bases + "</DataDefinition>\n" + data +
         "</Layer>\n</Optical>\n</WindowElement>\n";
}

std::string Data(const std::string& wavelength, const std::string& direction, const std::string& bases,
                 const std::string& values, const std::string& unit = "Integral") {
  return "<WavelengthData>\n<Wavelength unit=\"" + unit + "\">" + wavelength +
         "</Wavelength>\n<WavelengthDataBlock>\n" + "<WavelengthDataDirection>" + direction +
         "</WavelengthDataDirection>\n" + bases + "\n<ScatteringData>" + values +
         "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n";
}

std::string Bases(const std::string& incident, const std::string& exit) {
  return "<ColumnAngleBasis>" + incident + "</ColumnAngleBasis><RowAngleBasis>" + exit + "</RowAngleBasis>";
}
const std::string kQuarter = Bases("LBNL/Klems Quarter", "LBNL/Klems Quarter");
const std::string kTree = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";

// "0 1 2 ... count - 1"
std::string Counting(std::size_t count) {
  std::string values;
  for (std::size_t i = 0; i < count; ++i) values += std::to_string(i) + (i % 10 == 9 ? ",\n" : " ");
  return values;
}

TEST(KlemsBases, HaveTheirPatchesAndCoverTheHemisphere) {
  const std::vector<AngleBasis>& bases = KlemsBases();
  ASSERT_EQ(bases.size(), 3U);
  EXPECT_EQ(bases[0].size(), 145U);
  EXPECT_EQ(bases[1].size(), 73U);
  EXPECT_EQ(bases[2].size(), 41U);
  for (const AngleBasis& basis : bases) {
    double solid = 0, projected = 0;
    for (const AngleBasis::Patch& patch : basis.Patches()) {
      solid += patch.solid_angle;
      projected += patch.projected_solid_angle;
    }
    EXPECT_NEAR(solid, 2 * kPi, 1e-12) << basis.name;
    EXPECT_NEAR(projected, kPi, 1e-12) << basis.name;
  }
  // Half: WINDOW's rings end at 6.5, 19.5, 32.5, 46.5, 61.5, 76.5 and 90 degrees.
  const std::vector<double> ends = {6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90};
  ASSERT_EQ(bases[1].rings.size(), ends.size());
  for (std::size_t k = 0; k < ends.size(); ++k) EXPECT_EQ(bases[1].rings[k].upper_deg, ends[k]);
  // Full: ring 2 begins at patch 9 and has 16 patches of 22.5 degrees; the last ring's centre is 82.5 degrees.
  const std::vector<AngleBasis::Patch> full = bases[0].Patches();
  ExpectAngles(full[0].direction, 0, 0);
  ExpectAngles(full[1].direction, 10, 0);
  ExpectAngles(full[12].direction, 20, 67.5);
  ExpectAngles(full[144].direction, 82.5, 330);
}

TEST(BsdfXml, ColumnsAreIncidentPatches) {
  const std::string bytes = File("Columns", Data("Visible", "Reflection Back", kQuarter, Counting(41 * 41)));
  ASSERT_TRUE(IsBsdfXml(bytes));
  const Measurement m = ReadBytes(ReadBsdfXml, bytes);
  ASSERT_EQ(m.samples.size(), 41U * 41U);
  EXPECT_FALSE(m.isotropic);
  EXPECT_EQ(m.channels.names, std::vector<std::string>{"Y"});
  // Exit patch 10 (ring 2, azimuth 30), incident patch 3 (ring 1, azimuth 90 along the propagation: light at 270).
  const std::size_t at = 10 * 41 + 3;
  EXPECT_EQ(m.samples.values[0][at], 413);
  EXPECT_EQ(m.samples.origin[at], 413U);
  ExpectAngles(m.samples.wi(at), 18, 270);
  ExpectAngles(m.samples.wo(at), 36.5, 30);
  // Solid angles: 1/8 of 9..27 degrees times 1/12 of 27..46 degrees, against the square of the cap.
  const double degree = kPi / 180, cap = 1 - std::cos(9 * degree);
  const double ring1 = (std::cos(9 * degree) - std::cos(27 * degree)) / 8,
               ring2 = (std::cos(27 * degree) - std::cos(46 * degree)) / 12;
  EXPECT_NEAR(m.samples.solid_angle[at] / m.samples.solid_angle[0], ring1 * ring2 / (cap * cap), 1e-12);
  EXPECT_EQ(m.conventions.at("side"), "front (block 'Reflection Back', default)");
}

// Bases are found by their names and lines are counted once: 20 000 of them took 21 s.
TEST(BsdfXml, ManyBasesTakeNoTime) {
  std::string bases;
  for (int k = 0; k < 20000; ++k) {
    bases += "<AngleBasis><AngleBasisName>B" + std::to_string(k) +
             "</AngleBasisName>\n<AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>0</LowerTheta>"
             "<UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock>\n</AngleBasis>\n";
  }
  const auto start = std::chrono::steady_clock::now();
  const Measurement m =
      ReadBytes(ReadBsdfXml, File("Columns", Data("Visible", "Reflection Back", Bases("b19999", "B7"), "0.25"), bases));
  EXPECT_EQ(m.samples.values[0], std::vector<double>{0.25});
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 3);
  EXPECT_EQ(ErrorOf(ReadBsdfXml, File("Columns", Data("Visible", "Reflection Back", Bases("B", "B7"), "0.25"), bases)),
            "line 60013: ColumnAngleBasis is 'B'; known are B0, B1, B10, B100, B1000, B10000, B10001, B10002, B10003, "
            "B10004, B10005, B10006, B10007, B10008, B10009, B1001, B10010, B10011, B10012, B10013 and 19983 more");
}

TEST(BsdfXml, RowsAreTransposed) {
  const Measurement m =
      ReadBytes(ReadBsdfXml, File("Rows", Data("Visible", "Reflection Back",
                                               Bases("LBNL/Klems Half", "LBNL/Klems Quarter"), Counting(73 * 41))));
  // Incident patch 72 of the half basis (ring 7 of 4: azimuth 270, light at 90), exit patch 40 (ring 5 of 8: 315).
  const std::size_t last = 73 * 41 - 1;
  ExpectAngles(m.samples.wi(last), 83.25, 90);
  ExpectAngles(m.samples.wo(last), 78, 315);
  ExpectAngles(m.samples.wi(40), 0, 0);
  ExpectAngles(m.samples.wo(40), 78, 315);
}

TEST(BsdfXml, AMirrorFillsTheDiagonalOnBothSides) {
  const std::string data = Data("Visible", "Reflection Back", kQuarter, Counting(41 * 41)) +
                           Data("Visible", "Reflection Front", kQuarter, Counting(41 * 41)) +
                           Data("Visible", "Transmission Front", kQuarter, "not even numbers");
  for (const Side side : {Side::kFront, Side::kBack}) {
    ReadOptions options;
    options.side = side;
    const Measurement m = ReadBytes(ReadBsdfXml, File("Columns", data), options);
    for (std::size_t patch = 0; patch < 41; ++patch) {
      const Vec3 wi = m.samples.wi(patch * 42), wo = m.samples.wo(patch * 42);
      ExpectVector(wo, {-wi.x, -wi.y, wi.z}, 1e-14);
    }
    // The back is turned about y: its light stands at 180 - 270 = -90 degrees for incident patch 3 in ring 1, and exit
    // patch 10 at 180 - 30 degrees.
    const bool front = side == Side::kFront;
    ExpectAngles(m.samples.wi(413), 18, front ? 270 : -90);
    ExpectAngles(m.samples.wi(412), 18, front ? 225 : -45);
    ExpectAngles(m.samples.wo(413), 36.5, front ? 30 : 150);
  }
}

TEST(BsdfXml, SideIsNamedByWindowOrPlainly) {
  const auto values = [](const char* value) {
    std::string text;
    for (int i = 0; i < 41 * 41; ++i) text += std::string(value) + " ";
    return text;
  };
  const std::string bytes = File("Columns", Data("Visible", "Reflection Front", kQuarter, values("1")) +
                                                Data("Visible", "Reflection Back", kQuarter, values("2")));
  ReadOptions options;
  EXPECT_EQ(ReadBytes(ReadBsdfXml, bytes, options).samples.values[0][0], 2);
  options.side = Side::kBack;
  EXPECT_EQ(ReadBytes(ReadBsdfXml, bytes, options).samples.values[0][0], 1);
  options.xml_naming = XmlNaming::kPlain;
  EXPECT_EQ(ReadBytes(ReadBsdfXml, bytes, options).samples.values[0][0], 2);
  options.side.reset();
  EXPECT_EQ(ReadBytes(ReadBsdfXml, bytes, options).samples.values[0][0], 1);
  // Only one side is there: it is taken.
  const Measurement back =
      ReadBytes(ReadBsdfXml, File("Columns", Data("Visible", "Reflection Front", kQuarter, values("1"))));
  EXPECT_EQ(back.conventions.at("side"), "back (block 'Reflection Front', default)");
}

TEST(BsdfXml, WavelengthsBecomeChannels) {
  const auto block = [](const std::string& wavelength, std::size_t first, const std::string& unit = "Integral") {
    std::string values;
    for (std::size_t i = 0; i < 41 * 41; ++i) values += std::to_string(first + i) + " ";
    return Data(wavelength, "Reflection Back", kQuarter, values, unit);
  };
  const std::string xyz =
      File("Columns", block("CIE-Z", 30) + block("Visible", 20) + block("Solar", 0) + block("CIE-X", 10));
  const Measurement m = ReadBytes(ReadBsdfXml, xyz);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"X", "Y", "Z"}));
  EXPECT_EQ(m.samples.values[0][0], 10);
  EXPECT_EQ(m.samples.values[1][0], 20);
  EXPECT_EQ(m.samples.values[2][0], 30);
  ReadOptions options;
  options.xml_wavelength = "solar";
  const Measurement solar = ReadBytes(ReadBsdfXml, xyz, options);
  EXPECT_EQ(solar.channels.names, std::vector<std::string>{"Solar"});
  EXPECT_EQ(solar.samples.values[0][0], 0);

  const Measurement spectral =
      ReadBytes(ReadBsdfXml, File("Columns", block("0.55", 2, "Micron") + block("450", 1, "Nanometer")));
  EXPECT_EQ(spectral.channels.names, (std::vector<std::string>{"450nm", "550nm"}));
  EXPECT_NEAR(spectral.channels.wavelengths_nm[1], 550, 1e-9);
  EXPECT_EQ(spectral.samples.values[1][0], 2);
  EXPECT_EQ(
      ErrorOf(ReadBsdfXml, File("Columns", block("NIR", 2) + block("Solar", 1))),
      "line 11: the blocks 'Reflection Back' have the wavelengths NIR, Solar, none of them Visible; choose one with "
      "--xml-wavelength");
}

TEST(BsdfXml, AFileMayDefineItsOwnBasis) {
  const std::string basis =
      "<AngleBasis><AngleBasisName>Two rings</AngleBasisName>"
      "<AngleBasisBlock><Theta>0</Theta><nPhis>1</nPhis><ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>30</"
      "UpperTheta>"
      "</ThetaBounds></AngleBasisBlock>"
      "<AngleBasisBlock><Theta>60</Theta><nPhis>2</nPhis><ThetaBounds><LowerTheta>30</LowerTheta><UpperTheta>90</"
      "UpperTheta>"
      "</ThetaBounds></AngleBasisBlock></AngleBasis>";
  const Measurement m = ReadBytes(
      ReadBsdfXml,
      File("Columns", Data("Visible", "Reflection Back", Bases("Two rings", "two rings"), Counting(9)), basis));
  ASSERT_EQ(m.samples.size(), 9U);
  ExpectAngles(m.samples.wi(1), 60, 180);
  ExpectAngles(m.samples.wo(6), 60, 180);
}

TEST(ShirleyChiu, KeepsAreasAndInverts) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 square = {unit(random), unit(random)};
    const Vec2 disk = SquareToDisk(square);
    const Vec2 back = DiskToSquare(disk);
    EXPECT_NEAR(back.x, square.x, 1e-14);
    EXPECT_NEAR(back.y, square.y, 1e-14);
    // Central differences; across the diagonals, where the map has a kink, they are not taken.
    const double a = 2 * square.x - 1, b = 2 * square.y - 1, h = 1e-6;
    if (std::fabs(std::fabs(a) - std::fabs(b)) < 1e-4 || std::fmax(std::fabs(a), std::fabs(b)) < 1e-2) continue;
    const Vec2 right = SquareToDisk({square.x + h, square.y}), left = SquareToDisk({square.x - h, square.y});
    const Vec2 up = SquareToDisk({square.x, square.y + h}), down = SquareToDisk({square.x, square.y - h});
    const double determinant =
        ((right.x - left.x) * (up.y - down.y) - (right.y - left.y) * (up.x - down.x)) / (4 * h * h);
    EXPECT_NEAR(determinant, kPi, 1e-6);
  }
  // The middle of each edge of the square is on an axis.
  EXPECT_NEAR(SquareToDisk({1, 0.5}).x, 1, 1e-15);
  EXPECT_NEAR(SquareToDisk({0.5, 1}).y, 1, 1e-15);
  EXPECT_NEAR(SquareToDisk({0, 0.5}).x, -1, 1e-15);
  EXPECT_NEAR(SquareToDisk({0.5, 0}).y, -1, 1e-15);
  EXPECT_EQ(SquareToDisk({0.5, 0.5}).x, 0);
}

TensorTree Tree(const std::string& text, int rank) {
  return TensorTree(text, rank, [](std::string_view, const std::string& message) { throw InputError(message); });
}

TEST(TensorTree, ChildrenCountAxesByBitsAndGridsRunLastAxisFastest) {
  // Rank 3: child 1 is the upper half of axis 0, child 4 of axis 2; child 1 is a grid of 2 x 2 x 2.
  const TensorTree tree = Tree("{ {10} {1 2 3 4, 5 6,7 8} {12} {13} {14} {15} {16} {17} }", 3);
  EXPECT_EQ(tree.At({0.1, 0.1, 0.1}), 10);
  EXPECT_EQ(tree.At({0.1, 0.1, 0.9}), 14);
  EXPECT_EQ(tree.At({0.9, 0.9, 0.9}), 17);
  EXPECT_EQ(tree.At({0.6, 0.1, 0.1}), 1);
  EXPECT_EQ(tree.At({0.6, 0.1, 0.4}), 2);
  EXPECT_EQ(tree.At({0.6, 0.4, 0.1}), 3);
  EXPECT_EQ(tree.At({0.9, 0.1, 0.1}), 5);
  double volume = 0;
  std::size_t cells = 0;
  tree.ForEachCell([&](const TensorTree::Cell& cell) {
    volume += std::pow(cell.edge, 3);
    EXPECT_EQ(cell.index, cells++);
    // Looking a cell's centre up gives its value.
    EXPECT_EQ(tree.At({cell.corner[0] + cell.edge / 2, cell.corner[1] + cell.edge / 2, cell.corner[2] + cell.edge / 2}),
              cell.value);
  });
  EXPECT_EQ(cells, 15U);
  EXPECT_NEAR(volume, 1, 1e-15);
}

TEST(BsdfXml, TreeOfRankFourLiesOnTwoDisks) {
  // One grid of 2^4 values n = 0 .. 15; bits of n from the highest: axes 0, 1 (incident), 2, 3 (exit).
  const std::string bytes =
      File("TensorTree4", Data("Visible", "Reflection Back", kTree, "\n{ " + Counting(16) + "}\n"));
  const Measurement m = ReadBytes(ReadBsdfXml, bytes);
  ASSERT_EQ(m.samples.size(), 16U);
  EXPECT_FALSE(m.isotropic);
  // The centre (1/4, 1/4) of the lower quarter is on the diagonal of the square at half of the radius; n = 2 has exit
  // (3/4, 1/4), azimuth -45, and incident (1/4, 1/4), azimuth 225 along the propagation: light at 45 degrees.
  EXPECT_EQ(m.samples.values[0][2], 2);
  ExpectAngles(m.samples.wi(2), 30, 45);
  ExpectAngles(m.samples.wo(2), 30, -45);
  ExpectAngles(m.samples.wi(8), 30, 135);
  for (const double measure : m.samples.solid_angle) EXPECT_NEAR(measure, 1, 1e-14);  // all cells are alike
}

// Looking directions up gives the value of their cell, over the whole of it, in either rank: what a reading has at the
// centre of the cell.
TEST(BsdfXml, LookUpGivesTheCellWithoutInterpolation) {
  const std::string four = File("TensorTree4", Data("Visible", "Reflection Back", kTree, "{ " + Counting(16) + "}"));
  const std::string three = File(
      "TensorTree3",
      Data("Visible", "Reflection Back", kTree, "{ {0} {100} {2} {100} {4} {100} { 10 11 12 13 14 15 16 17 } {100} }"));
  for (const std::string* bytes : {&four, &three}) {
    const Measurement read = ReadBytes(ReadBsdfXml, *bytes);
    const TreeLookup table = LookUpTensorTrees({"a.xml", *bytes});
    ASSERT_EQ(table.channels.size(), 1U);
    for (std::size_t k = 0; k < read.samples.size(); ++k) {
      double value = -1;
      table.brdf(read.samples.wi(k), read.samples.wo(k), &value);
      EXPECT_EQ(value, read.samples.values[0][k]) << k;
    }
  }
  // Both are 30 degrees at the cells' centres: half the way to the next centre is the same cell still.
  const TreeLookup table = LookUpTensorTrees({"a.xml", four});
  double value = -1;
  table.brdf(FromSpherical(DegreesToRadians(50), DegreesToRadians(20)), FromSpherical(DegreesToRadians(10), -0.1),
             &value);
  EXPECT_EQ(value, 2);
  // An isotropic tree turns with the light.
  const TreeLookup round = LookUpTensorTrees({"a.xml", three});
  double turned = -1;
  round.brdf(FromSpherical(0.9, 0.3), FromSpherical(0.5, 1.4), &value);
  round.brdf(FromSpherical(0.9, 2.3), FromSpherical(0.5, 3.4), &turned);
  EXPECT_EQ(value, turned);
}

TEST(BsdfXml, TreeOfRankThreeIsIsotropicAndUsesHalfOfItsFirstAxis) {
  const std::string bytes = File(
      "TensorTree3",
      Data("Visible", "Reflection Back", kTree, "{ {0} {100} {2} {100} {4} {100} { 10 11 12 13 14 15 16 17 } {100} }"));
  const Measurement m = ReadBytes(ReadBsdfXml, bytes);
  EXPECT_TRUE(m.isotropic);
  ASSERT_EQ(m.samples.size(), 3U + 8U);  // children 1, 3, 5, 7 are the unused half
  for (const double value : m.samples.values[0]) EXPECT_NE(value, 100);
  // Child 4 has the upper half of axis 2 and axis 0 in [0, 1/2]: sin(theta_i) = 1/2, light at azimuth 180.
  EXPECT_EQ(m.samples.values[0][2], 4);
  ExpectAngles(m.samples.wi(2), 30, 180);
  ExpectAngles(m.samples.wo(2), 30, 135);
  // Child 6 is a grid: value 13 has axis 0 in [0, 1/4] (sin(theta_i) = 3/4), axes 1 and 2 in [3/4, 1].
  EXPECT_EQ(m.samples.values[0][6], 13);
  ExpectVector(m.samples.wi(6), {-0.75, 0, std::sqrt(1 - 0.75 * 0.75)});
  const double c = 0.75 * std::sqrt(0.5);
  ExpectVector(m.samples.wo(6), {c, c, std::sqrt(1 - 0.75 * 0.75)});
  // Projected: cell 4 has (1 - 0) sin^2 times 1/4, cell 13 (1 - 1/4) times 1/16; both are divided by the cosines.
  const double cell4 = 0.25 / 0.75, cell13 = 0.75 / 16 / (1 - 0.5625);
  EXPECT_NEAR(m.samples.solid_angle[6] / m.samples.solid_angle[2], cell13 / cell4, 1e-13);
}

TEST(BsdfXml, ProjectedSolidAnglesOfATreeAddUpToAHemisphereSquared) {
  // Value 1 everywhere: sum of measure cos cos over cells = constant, whatever the cells are.
  const std::string coarse = File("TensorTree4", Data("Visible", "Reflection Back", kTree, "{ " + Counting(256) + "}"));
  const Measurement m = ReadBytes(ReadBsdfXml, coarse);
  ASSERT_EQ(m.samples.size(), 256U);
  double sum = 0;
  for (std::size_t i = 0; i < 256; ++i) sum += m.samples.solid_angle[i] * m.samples.wi_z[i] * m.samples.wo_z[i];
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(m.samples.solid_angle[i] * m.samples.wi_z[i] * m.samples.wo_z[i] / sum, 1.0 / 256, 1e-14);
  }
}

// As Radiance reads them: equal energy is white, the primaries are its own.
TEST(BsdfXml, ChromaticityTreesBecomeRgb) {
  const auto read = [](double u, double v) {
    const std::string bytes =
        File("TensorTree4", Data("CIE-u", "Reflection Back", kTree, "{" + std::to_string(u) + "}") +
                                Data("Visible", "Reflection Back", kTree, "{2}") +
                                Data("CIE-v", "Reflection Back", kTree, "{" + std::to_string(v) + "}"));
    return ReadBytes(ReadBsdfXml, bytes);
  };
  const Measurement grey = read(4.0 / 19, 9.0 / 19);
  EXPECT_EQ(grey.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  for (const std::vector<double>& values : grey.samples.values) EXPECT_NEAR(values[0], 2, 1e-4);
  // The chromaticity (0.290, 0.600) is green: u' = 4 x / (-2 x + 12 y + 3), v' = 9 y / (-2 x + 12 y + 3).
  const Measurement green = read(4 * 0.290 / (-2 * 0.290 + 7.2 + 3), 9 * 0.600 / (-2 * 0.290 + 7.2 + 3));
  EXPECT_NEAR(green.samples.values[0][0], 0, 1e-4);
  EXPECT_NEAR(green.samples.values[1][0], 2 / 0.6701, 1e-3);
  EXPECT_NEAR(green.samples.values[2][0], 0, 1e-4);
}

TEST(BsdfXml, SaysWhatIsWrongAndWhere) {
  const auto matrix = [](const std::string& values) {
    return File("Columns", Data("Visible", "Reflection Back", kQuarter, values));
  };
  EXPECT_EQ(ErrorOf(ReadBsdfXml, matrix(Counting(1680))),
            "line 181: <ScatteringData> ends after 1680 numbers; the angle bases need 1681");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, matrix(Counting(1682))), "line 182: more than the 1681 numbers of the angle bases");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, matrix("1 2 3")),
            "line 14: <ScatteringData> has 5 bytes, too few for 1681 numbers of the angle bases; it may be cut off");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, matrix("1\nx" + Counting(1681))),
            "line 15: a value of <ScatteringData> is 'x0', which is not a number; write it as in 0.25 or 2.5e-1");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, matrix("1<b/>2")),
            "line 14: <ScatteringData> holds elements or comments where only text is allowed");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, File("Diagonal", "")),
            "line 7: the IncidentDataStructure is 'Diagonal'; allowed are Columns, Rows, TensorTree3 and TensorTree4");
  EXPECT_EQ(
      ErrorOf(ReadBsdfXml, File("Columns", Data("Visible", "Transmission Back", kQuarter, "1"))),
      "line 5: <Layer> has no data block 'Reflection Back'; only reflection can be fitted. It has 'transmission back'");
  EXPECT_EQ(
      ErrorOf(ReadBsdfXml, File("Columns", Data("Visible", "Reflection Back", Bases("LBNL/Klems Fool", ""), "1"))),
      "line 13: ColumnAngleBasis is 'LBNL/Klems Fool'; known are LBNL/Klems Full, LBNL/Klems Half, LBNL/Klems Quarter");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, "<WindowElement><Optical></WindowElement>"),
            "line 1: is not well-formed XML here: Start-end tags mismatch; export or fetch the file again");
  const auto tree = [](const std::string& values) {
    return File("TensorTree3", Data("Visible", "Reflection Back", kTree, values));
  };
  EXPECT_EQ(ErrorOf(ReadBsdfXml, tree("\n{ {1}\n {2 3} }")),
            "line 16: a leaf of the tensor tree has 2 values; allowed are 1, 8, 64 and further powers; found '} }'");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, tree("{ {1} {2} }")), "line 14: the tensor tree should have '{' here; found '}'");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, tree("{1} 2")),
            "line 14: text stands after the closing brace of the tensor tree; nothing is allowed there; found '2'");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, tree(std::string(100, '{'))),
            "line 14: the tensor tree halves its axes more than 16 times; found '{{{{{{{{{{{{{{{{{{{{{{{{...'");
}

TEST(BsdfXml, HostileXmlIsRefusedOrHarmless) {
  std::string deep = "<WindowElement>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 100000; ++i) deep += "</a>";
  EXPECT_EQ(ErrorOf(ReadBsdfXml, deep + "</WindowElement>"),
            "line 1: elements are nested deeper than 32; a BSDF file has 8 levels");
  std::string wide = "<WindowElement>";
  for (int i = 0; i < 1000001; ++i) wide += "<a/>";
  EXPECT_EQ(ErrorOf(ReadBsdfXml, wide + "</WindowElement>"),
            "line 1: the file has more than 1000000 elements or 2000000 attributes; real files have a few hundred, "
            "their numbers "
            "are text");
  // Entities are never expanded, inner or external.
  const std::string doctype =
      "<!DOCTYPE a [<!ENTITY x SYSTEM \"file:///etc/passwd\"><!ENTITY y \"Columns\">]>\n<WindowElement><Optical><Layer>"
      "<DataDefinition><IncidentDataStructure>&y;</IncidentDataStructure></DataDefinition></Layer></Optical></"
      "WindowElement>";
  EXPECT_EQ(ErrorOf(ReadBsdfXml, doctype),
            "line 2: the IncidentDataStructure is '&y;'; allowed are Columns, Rows, TensorTree3 and TensorTree4");
  EXPECT_EQ(ErrorOf(ReadBsdfXml, std::string("<WindowElement>\0</WindowElement>", 32)),
            "byte 15: is 0, which XML in UTF-8 does not allow; save the file as UTF-8");
}

}  // namespace
}  // namespace lobefit

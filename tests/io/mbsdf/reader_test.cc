#include "lobefit/io/mbsdf/reader.h"

#include <cmath>
#include <cstring>

#include "tests/support/read_bytes.h"

namespace lobefit {
namespace {

template <class T>
std::string Bytes(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

// A block whose value at index n is first + n.
std::string Block(const std::string& marker, std::uint32_t type, std::uint32_t thetas, std::uint32_t phis,
                  float first) {
  std::string block = marker + "=\n" + Bytes(type) + Bytes(thetas) + Bytes(phis);
  const std::uint32_t count = thetas * thetas * phis * (type == 0 ? 1 : 3);
  for (std::uint32_t n = 0; n < count; ++n) block += Bytes(first + static_cast<float>(n));
  return block;
}
constexpr char kVersion[] = "NVIDIA ARC MBSDF V1\n";

TEST(Mbsdf, ValuesStandAtTheCentresOfUniformCells) {
  const std::string bytes = kVersion + std::string("name=\"by hand\"\n") + Block("MBSDF_DATA", 1, 2, 3, -1);
  ASSERT_TRUE(IsMbsdf(bytes));
  const Measurement m = ReadBytes(ReadMbsdf, bytes);
  ASSERT_EQ(m.samples.size(), 12U);
  EXPECT_TRUE(m.isotropic);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  // theta_i cell 1, theta_o cell 0, phi cell 2: cell 2 * 3 + 0 + 2 = 8.
  ExpectAngles(m.samples.wi(8), 67.5, 0);
  ExpectAngles(m.samples.wo(8), 22.5, 150);
  EXPECT_EQ(m.samples.origin[8], 8U);
  EXPECT_EQ(m.samples.values[0][8], 23);
  EXPECT_EQ(m.samples.values[2][8], 25);
  EXPECT_EQ(m.samples.values[0][0], -1);  // noise below zero is kept
  // Cells between 45 and 90 degrees have cos(45) of the hemisphere, those up to 45 have 1 - cos(45).
  const double ratio = std::sqrt(0.5) / (1 - std::sqrt(0.5));
  EXPECT_NEAR(m.samples.solid_angle[8] / m.samples.solid_angle[0], ratio, 1e-13);
  EXPECT_NEAR(m.samples.solid_angle[11] / m.samples.solid_angle[0], ratio * ratio, 1e-12);
  double sum = 0;
  for (const double measure : m.samples.solid_angle) sum += measure;
  EXPECT_NEAR(sum, 12, 1e-12);
}

TEST(Mbsdf, ScalarReflectionIsReadBesideTransmission) {
  const std::string bytes =
      kVersion + Block("MBSDF_DATA_TRANSMISSION", 1, 3, 1, 0) + Block("MBSDF_DATA_REFLECTION", 0, 2, 1, 5);
  const Measurement m = ReadBytes(ReadMbsdf, bytes);
  EXPECT_EQ(m.channels.names, std::vector<std::string>{"Y"});
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{5, 6, 7, 8}));
  EXPECT_EQ(m.remarks.size(), 1U);
}

TEST(Mbsdf, SaysWhatIsWrongAndWhere) {
  const std::string good = kVersion + Block("MBSDF_DATA", 0, 2, 3, 0);
  EXPECT_EQ(
      ErrorOf(ReadMbsdf, good.substr(0, good.size() - 1)),
      "byte 44: 2 x 2 x 3 cells x 1 channels should follow, but the file has only 47 more bytes; fetch the file again");
  EXPECT_EQ(
      ErrorOf(ReadMbsdf, good + "more\n"),
      "byte 92: 'more' stands after a block of data; allowed are another marker MBSDF_DATA_... or the end of the file");
  EXPECT_EQ(ErrorOf(ReadMbsdf, good + Block("MBSDF_DATA", 0, 1, 1, 0)),
            "byte 92: a second block of reflection begins; only one is allowed");
  const std::string head = std::string(kVersion) + "MBSDF_DATA=\n";
  EXPECT_EQ(ErrorOf(ReadMbsdf, head + Bytes(2) + Bytes(1) + Bytes(1)),
            "byte 32: the type of the values is 2; allowed are 0 (scalar) and 1 (RGB)");
  EXPECT_EQ(ErrorOf(ReadMbsdf, head + Bytes(1) + Bytes(0) + Bytes(1)),
            "byte 36: the resolution is 0 polar x 1 azimuthal cells; both must be at least 1");
  // 4 (2^32 - 1)^3 overflows.
  EXPECT_EQ(
      ErrorOf(ReadMbsdf, head + Bytes(0) + Bytes(-1) + Bytes(-1)),
      "byte 44: 4294967295 x 4294967295 x 4294967295 cells x 1 channels should follow, but the file has only 0 more "
      "bytes; fetch the file again");
  EXPECT_EQ(ErrorOf(ReadMbsdf, kVersion),
            "byte 20: the file ends without a marker 'MBSDF_DATA=' or 'MBSDF_DATA_REFLECTION='; it is cut off");
}

}  // namespace
}  // namespace lobefit

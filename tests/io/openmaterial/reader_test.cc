#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

std::string OpenMaterialDocument(const std::string& rows) {
  return R"({"metadata":{"name":"Red brick"},"brdf":{"wavelengths":[5.5e-7],"lookupTable":[)" + rows + "]}}";
}

TEST(OpenMaterial, ReadsRowsRelativeToTheLight) {
  const Measurement m = ReadText(OpenMaterialDocument(
      "[5.5e-7,0.5235987755982988,0.5235987755982988,3.141592653589793,2],[5.5e-7,0.5235987755982988,"
      "0.7853981633974483,0,0.5],"
      "[6.5e-7,0.5235987755982988,0.5235987755982988,3.141592653589793,3],[6.5e-7,0.5235987755982988,"
      "0.7853981633974483,0,null]"));
  EXPECT_EQ(m.format, "openmaterial");
  EXPECT_TRUE(m.isotropic);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{550, 650}));
  ASSERT_EQ(m.samples.size(), 1U);  // the second pair lacks 650 nm
  ExpectSample(m, 0, 30, 0, 30, 180, 2);
  EXPECT_EQ(m.samples.values[1][0], 3);
  ReadOptions options;
  options.channels = "550";
  EXPECT_EQ(ReadText(OpenMaterialDocument("[5.5e-7,0.5,0.5,3,2],[5.5e-7,0.5,0.7,0,0.5],[6.5e-7,0.5,0.5,3,3]"), options)
                .samples.size(),
            2U);
}

TEST(OpenMaterial, RefusesWhatItCannotUnderstand) {
  EXPECT_NE(MessageOf(OpenMaterialDocument("[5.5e-7,0.5,0.5,3]")).find("row 1 of lookupTable has not the 5 entries"),
            std::string::npos);
  EXPECT_NE(MessageOf(OpenMaterialDocument("[5.5e-7,30,45,0,1]")).find("angles are radians in this format"),
            std::string::npos);
  EXPECT_NE(MessageOf(OpenMaterialDocument("[5.5e-7,0.5,0.5,3,\"x\"]")).find("neither a number nor null"),
            std::string::npos);
}

}  // namespace
}  // namespace lobefit

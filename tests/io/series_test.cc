// One measurement in several files.
#include "lobefit/io/series.h"

#include <filesystem>

#include "tests/io/csv/read_csv.h"

#include "lobefit/base/files/file.h"

namespace lobefit {
namespace {

TEST(Series, FilesOfOneIncidenceEach) {
  const TemporaryFile a("# AOI: 10\ntheta_s,BSDF\n-20,1\n45,2\n"), b("# AOI: 30\ntheta_s,BSDF\n-20,3\n45,4\n");
  const Measurement m = ReadSeries({a.path().string(), b.path().string()}, {});
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectSample(m, 0, 10, 0, 20, 0, 1);
  ExpectSample(m, 3, 30, 0, 45, 180, 4);
  EXPECT_THROW(ReadSeries({a.path().string(), a.path().string()}, {}), UsageError);
}

TEST(Series, WhatAFileLacksIsStatedBehindItsName) {
  const TemporaryFile a("theta_s,BSDF\n-20,1\n45,2\n"), b("theta_s,BSDF\n-20,3\n45,4\n");
  const Measurement m =
      ReadSeries({a.path().string() + ":theta_i=10", b.path().string() + ":theta_i=30deg,sample-rotation=20"}, {});
  ExpectSample(m, 0, 10, 0, 20, 0, 1);
  ExpectSample(m, 3, 30, -20, 45, 160, 4);
  EXPECT_THROW(ReadSeries({a.path().string()}, {}), InputError);
  EXPECT_THROW(ReadSeries({a.path().string() + ":colour=red"}, {}), InputError);
  // Any format's sample may have been turned.
  const TemporaryFile fred("type bsdf_data\nformat angles=deg bsdf=value scale=1\n30 180\n30 180 5\n");
  const Measurement turned = ReadSeries({fred.path().string() + ":sample-rotation=20"}, {});
  ExpectSample(turned, 0, 30, -20, 30, 160, 5);
  EXPECT_THROW(ReadSeries({fred.path().string() + ":theta_i=20"}, {}), UsageError);
}

TEST(Series, AFolderIsItsFiles) {
  const std::filesystem::path folder = TemporaryFile().path();
  std::filesystem::create_directory(folder);
  WriteFileAtomically(folder / "b.csv", "# AOI: 30\ntheta_s,BSDF\n-20,3\n");
  WriteFileAtomically(folder / "a.csv", "# AOI: 10\ntheta_s,BSDF\n-20,1\n");
  WriteFileAtomically(folder / "a.material.json", "{}");
  const Measurement m = ReadSeries({folder.string()}, {});
  std::filesystem::remove_all(folder);
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 10, 0, 20, 0, 1);
  std::filesystem::create_directory(folder);
  EXPECT_THROW(ReadSeries({folder.string()}, {}), InputError);
  std::filesystem::remove_all(folder);
}

TEST(Series, WhatElseLiesInAFolderIsNamed) {
  const std::filesystem::path folder = TemporaryFile().path();
  std::filesystem::create_directories(folder / "more");
  WriteFileAtomically(folder / "README.txt", "Measured by N.N., in May.\n");
  try {
    ReadSeries({folder.string()}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("it holds 1 file that holds no measurement (README.txt); the folders in "
                        "it are not looked into"),
              std::string::npos)
        << error.what();
  }
  WriteFileAtomically(folder / "a.csv", "theta_i,theta_s,BSDF\n10,-20,1\n");
  const Measurement m = ReadSeries({folder.string()}, {});
  EXPECT_EQ(m.samples.size(), 1U);
  EXPECT_TRUE(HasRemark(m, "holds 1 file that holds no measurement (README.txt) too"));
  // Prose may hold a table that names an angle, and a list of what was measured has those of the light.
  WriteFileAtomically(folder / "README.txt", "Samples:\n\nincidence, receiver, note\n10, 20, 3\n30, 40, 5\n");
  WriteFileAtomically(folder / "files.txt", "incidence, samples\n10, 3\n30, 4\n");
  const Measurement again = ReadSeries({folder.string()}, {});
  EXPECT_EQ(again.samples.size(), 1U);
  EXPECT_TRUE(HasRemark(again, "holds 2 files that hold no measurement (README.txt, files.txt) too"));
  // What is one but cannot be read is no such file.
  WriteFileAtomically(folder / "b.csv", "theta_i,theta_s,BSDF\n10,-20,one\n");
  EXPECT_THROW(ReadSeries({folder.string()}, {}), InputError);
  std::filesystem::remove_all(folder);
}

TEST(Series, PathsWithColonsAndEqualsSigns) {
  const TemporaryFile plain("theta_i,theta_o,f\n10,20,1\n");
  const FileSpec whole = ParseFileSpec(plain.path().string());
  EXPECT_EQ(whole.path, plain.path());
  EXPECT_TRUE(whole.keys.empty());
  const FileSpec keys = ParseFileSpec(plain.path().string() + ":theta_i=30, wavelength=633nm");
  EXPECT_EQ(keys.path, plain.path());
  EXPECT_EQ(keys.keys, (std::vector<std::string>{"theta_i=30", "wavelength=633nm"}));
  EXPECT_EQ(ParseFileSpec("no/such:a=b").path, "no/such:a=b");
}

TEST(Series, APackedFileIsReadAndItsDigestIsThatOfTheFile) {
  // gzip of "theta_i,theta_o,f\n10,20,1\n", no name and no time.
  constexpr unsigned char kBytes[] = {0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0xff, 0x2b,
                                      0xc9, 0x48, 0x2d, 0x49, 0x8c, 0xcf, 0xd4, 0x29, 0x01, 0xd3, 0xf9,
                                      0x3a, 0x69, 0x5c, 0x86, 0x06, 0x3a, 0x46, 0x06, 0x3a, 0x86, 0x5c,
                                      0x00, 0xf1, 0x08, 0xd4, 0x57, 0x1a, 0x00, 0x00, 0x00};
  const TemporaryFile file(std::string_view(reinterpret_cast<const char*>(kBytes), sizeof(kBytes)));
  const Measurement m = ReadMeasurement(file.path());
  ExpectSample(m, 0, 10, 0, 20, 180, 1);
  EXPECT_TRUE(HasRemark(m, "unpacked from gzip"));
  EXPECT_EQ(m.sha256, Sha256Hex(std::string_view(reinterpret_cast<const char*>(kBytes), sizeof(kBytes))));
}

}  // namespace
}  // namespace lobefit

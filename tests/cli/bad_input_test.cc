#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using BadInput = ProgramTest;

struct Case {
  const char* command;
  int exit_code;
  const char* message;  // part of stderr
};

TEST_F(BadInput, EveryMistakeHasItsExitCodeAndOneMessage) {
  WriteWholeFile(folder_ / "empty.csv", "");
  WriteWholeFile(folder_ / "words.csv", "theta_i,phi_i,theta_o,phi_o,value\n1,2,three,4,5\n");
  WriteWholeFile(folder_ / "nan.csv", "theta_i,phi_i,theta_o,phi_o,value\n1,2,3,4,nan\n");
  WriteWholeFile(folder_ / "noise.bin", std::string(1000, '\x7f'));
  WriteWholeFile(folder_ / "key.toml", "[[lobe]]\nnfd = \"ggx\"\n");
  WriteWholeFile(folder_ / "not.material.json", "{}");
  WriteWholeFile(folder_ / "four.toml", "[sel]\nlobes = 4\n");
  WriteWholeFile(folder_ / "mixed.toml", "diffuse = \"none\"\n[sel]\nlobes = 1\n");
  WriteWholeFile(folder_ / "selkey.toml", "[sel]\nlobs = 1\n");
  WriteWholeFile(folder_ / "quantity.toml", "[sel]\nquantity = \"cos\"\n");
  WriteWholeFile(folder_ / "few.csv", "theta_i,phi_i,theta_o,phi_o,value\n10,0,20,0,1\n10,0,30,0,1\n20,0,30,0,1\n");
  std::filesystem::create_directories(folder_ / "folder");
  const std::string good = "$SOURCE/samples/satin_plastic.csv";
  const std::vector<std::string> before = Files();
  const Case cases[] = {
      {"lobefit", 2, "subcommand"},
      {"lobefit fiit x.csv", 2, "'fiit' is not a verb (did you mean 'fit'?)"},
      {"lobefit fit", 2, "FILE is required"},
      {"lobefit fit a.csv --bogus", 2, "--bogus"},
      {"lobefit fit a.csv --threads 0", 2, "--threads"},
      {"lobefit fit missing.csv", 3, "missing.csv: cannot be opened: No such file or directory"},
      {"lobefit fit folder", 3, "folder: is a folder"},
      {"lobefit fit empty.csv", 3, "empty.csv"},
      {"lobefit fit words.csv", 3, "words.csv"},
      {"lobefit fit nan.csv", 3, "nan.csv"},
      {"lobefit info noise.bin", 3, "noise.bin"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe key.toml", 3, "key.toml:2: unknown key 'nfd'"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe elipsoid", 3, "(did you mean 'ellipsoid'?)"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --metric lg", 2, "allowed: log, cube-root"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --theta-i 40:30", 2, "the first bound is above the second"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --theta-i x", 2, "is not a number"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --theta-i 1:2", 3, "none of its"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --value-kind candela", 2,
       "--value-kind candela: allowed are f, "},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --weighting solid-angle", 3, "lists directions without cells"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --out empty.csv/x", 3, "empty.csv/x"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx,elipsoid", 2, "(did you mean 'ellipsoid'?)"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx,ggx", 2, "names 'ggx' twice"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx,,ellipsoid", 2, "empty name"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --recipes missing.toml", 3, "missing.toml"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --recipes ggx,key.toml", 3, "key.toml:2: unknown key 'nfd'"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --with not.material.json", 3, "is not a material document"},
      {"lobefit compare $SOURCE/samples/satin_plastic.csv --folds -1", 2, "--folds"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe four.toml", 3,
       "four.toml:2: lobes = 4: allowed are 1, 2"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe mixed.toml", 3, "mixed.toml:1: unknown key 'diffuse'"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe selkey.toml", 3,
       "selkey.toml:2: unknown key 'lobs' of [sel] (did you mean 'lobes'?)"},
      {"lobefit fit $SOURCE/samples/satin_plastic.csv --recipe quantity.toml", 3,
       "quantity.toml:2: quantity = 'cos' is unknown; allowed: f, f-cos-o"},
      {"lobefit fit few.csv --recipe sel", 3, "take fewer lobes"},
      {"lobefit export few.csv --to pbrt", 3, "if it is a measurement, `lobefit fit` makes one of it"},
      {"lobefit report not.material.json $SOURCE/samples/satin_plastic.csv", 3,
       "not.material.json: is not a material document"},
      {"lobefit synth $SOURCE/fits/ggx.toml --out x.csv", 3, "parameter 'alpha_x' has 0 values"},
      {"lobefit synth $SOURCE/samples/satin_plastic.toml --out no/such/x.csv", 3, "no/such/x.csv: cannot be written"},
  };
  for (const Case& c : cases) {
    const ProgramResult result = Shell(c.command);
    EXPECT_EQ(result.exit_code, c.exit_code) << c.command << "\n" << result.out << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr(c.message)) << c.command;
    EXPECT_THAT(result.err, testing::StartsWith("lobefit: ")) << c.command;
  }
  // Nothing was written.
  EXPECT_EQ(Files(), before);
}

TEST_F(BadInput, AHugeClaimInASmallFileTakesNoMemory) {
  // A MERL header that claims 2^31 - 1 cells an axis, and a tensor file that claims 2^31 fields.
  WriteWholeFile(folder_ / "lying.binary",
                 std::string("\xff\xff\xff\x7f\xff\xff\xff\x7f\xff\xff\xff\x7f", 12) + std::string(100, '\0'));
  std::string tensor("tensor_file\0\x01\x00\x00\x00\x00\x80", 18);
  WriteWholeFile(folder_ / "lying.bsdf", tensor + std::string(50, 'x'));
  for (const char* file : {"lying.binary", "lying.bsdf"}) {
    // 1 GB of address space is the limit that the contract gives.
    const ProgramResult result = Shell(std::string("ulimit -v 1000000; lobefit info ") + file);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr(file));
  }
}

// A wavelength of its own in each of 20 000 rows: a table of rows times wavelengths took 1.6 GB before it was refused.
TEST_F(BadInput, WavelengthsThatAllDifferTakeNoMemory) {
  std::string rows = "theta_i,phi_i,theta_o,phi_o,wavelength,f\n";
  for (int i = 0; i < 20000; ++i) {
    rows += "20,0," + std::to_string(0.004 * (i % 19999)) + "," + std::to_string(i % 360) + "," +
            std::to_string(400 + 0.02 * i + 1e-4 * (i % 7)) + ",0.3\n";
  }
  WriteWholeFile(folder_ / "jitter.csv", rows);
  const ProgramResult result = Shell("ulimit -v 1000000; lobefit info jitter.csv");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, testing::HasSubstr("20000 different wavelengths at 19999 pairs of directions; at most 4096"));
}

}  // namespace
}  // namespace lobefit

// lobefit export as a user calls it.
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using testing::HasSubstr;

class ExportVerb : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/brushed_metal.csv --no-report").exit_code, 0);
  }
};

TEST_F(ExportVerb, WritesFilesTableAndRecord) {
  const ProgramResult run = Shell("lobefit export brushed_metal.material.json --to gltf,pbrt,glsl --out here/out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* words :
       {"gltf", "here/out/brushed_metal.gltf", "approximately: tilt", "exactly: shape", "texture coordinates"}) {
    EXPECT_THAT(run.out, HasSubstr(words));
  }
  const nlohmann::json record = nlohmann::json::parse(ReadWholeFile(folder_ / "here/out/brushed_metal.export.json"));
  ASSERT_EQ(record["targets"].size(), 3U);
  EXPECT_EQ(record["targets"][0]["target"], "gltf");
  EXPECT_GT(record["targets"][0]["relative_error"]["median"], 0);
  EXPECT_THAT(ReadWholeFile(folder_ / "here/out/brushed_metal.pbrt"), HasSubstr("# command: lobefit export"));
  // A second export keeps the rows of the first.
  ASSERT_EQ(Shell("lobefit export brushed_metal.material.json --to osl,glsl --out here/out").exit_code, 0);
  const nlohmann::json second = nlohmann::json::parse(ReadWholeFile(folder_ / "here/out/brushed_metal.export.json"));
  EXPECT_EQ(second["targets"].size(), 4U);
}

TEST_F(ExportVerb, JsonCopyAndRefit) {
  const ProgramResult copy = Shell("lobefit export brushed_metal.material.json --to gltf --copy --json --name part");
  ASSERT_EQ(copy.exit_code, 0) << copy.err;
  EXPECT_EQ(nlohmann::json::parse(copy.out)["targets"][0]["numbers"], "copied");
  const ProgramResult refit = Shell("lobefit export brushed_metal.material.json --to gltf --refit --json --name part");
  ASSERT_EQ(refit.exit_code, 0) << refit.err;
  const nlohmann::json row = nlohmann::json::parse(refit.out)["targets"][0];
  EXPECT_EQ(row["numbers"], "refitted");
  EXPECT_TRUE(row.contains("relative_error_of_the_other_numbers"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "part.gltf"));
}

TEST_F(ExportVerb, BadUse) {
  const struct {
    const char* arguments;
    int exit_code;
    const char* message;
  } cases[] = {
      {"", 2, "--to TARGET[,TARGET] are needed"},
      {"brushed_metal.material.json", 2, "lobefit export --list"},
      {"brushed_metal.material.json --to mitsubah", 2, "did you mean 'mitsuba'?"},
      {"brushed_metal.material.json --to merl", 3, "merl cannot hold this material"},
      {"nothing.material.json --to gltf", 3, "nothing.material.json"},
      {"broken.json --to gltf", 3, "broken.json"},
      {"brushed_metal.material.json --to gltf --copy --refit", 2, "excludes"},
      {"brushed_metal.material.json --to gltf --map-path maps", 2, "--map-path is an option of mitsuba, pbrt"},
      {"brushed_metal.material.json --to pbrt --mitsuba-version 3.6", 2, "--mitsuba-version is an option of mitsuba"},
      {"brushed_metal.material.json --to mitsuba --mitsuba-version 2.1", 2, "a version of Mitsuba 3 is allowed"},
      {"brushed_metal.material.json --to rgl,csv --refit", 2, "--refit is an option of gltf"},
      {"brushed_metal.material.json --to gltf --name a/b", 2, "is a path; the folder is given by --out"},
      {"brushed_metal.material.json --to gltf --out broken.json/x", 3, "cannot be made"},
  };
  ASSERT_EQ(Shell("echo '{\"model\": 3' > broken.json").exit_code, 0);
  for (const auto& bad : cases) {
    const ProgramResult run = Shell(std::string("lobefit export ") + bad.arguments);
    EXPECT_EQ(run.exit_code, bad.exit_code) << bad.arguments << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr(bad.message)) << bad.arguments;
  }
  EXPECT_EQ(Files(), (std::vector<std::string>{"broken.json", "brushed_metal.material.json"}))
      << "nothing is left behind";
}

// One target that refuses does not stop the others; the exit code says that not all was written.
TEST_F(ExportVerb, RefusalsDoNotStopTheOthers) {
  const ProgramResult run = Shell("lobefit export brushed_metal.material.json --to pbrt,merl,gltf --out here");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("merl cannot hold this material: its table has no azimuth"));
  EXPECT_THAT(run.err, HasSubstr("the other targets are written"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "here/brushed_metal.pbrt"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "here/brushed_metal.gltf"));
  const nlohmann::json record = nlohmann::json::parse(ReadWholeFile(folder_ / "here/brushed_metal.export.json"));
  EXPECT_EQ(record["refused"][0]["target"], "merl");
}

// Two of three channels are no colour: what takes colours or spectra refuses them.
TEST_F(ExportVerb, ChannelsWithoutColourAreRefused) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --channels R,B --recipe ggx --no-report --name rb")
                .exit_code,
            0);
  const ProgramResult run = Shell("lobefit export rb.material.json --to pbrt,mitsuba,gltf,osl");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("pbrt, mitsuba, gltf cannot hold this material: --channels rgb: needs R G B"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "rb.pbrt"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "rb.mitsuba.xml"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "rb.osl"));
}

// What is said of the numbers: asked only where asked, exactly only of what was not refitted.
TEST_F(ExportVerb, SaysHowTheNumbersCame) {
  const ProgramResult chosen = Shell("lobefit export brushed_metal.material.json --to pbrt --name chosen");
  EXPECT_THAT(chosen.out, testing::Not(HasSubstr("as asked")));
  EXPECT_THAT(chosen.out, HasSubstr("which is nearer"));
  EXPECT_THAT(Shell("lobefit export brushed_metal.material.json --to pbrt --copy --name copy").out,
              HasSubstr("numbers copied, as asked"));
  const ProgramResult refit = Shell("lobefit export brushed_metal.material.json --to gltf --refit --name refit");
  EXPECT_THAT(refit.out, HasSubstr("numbers refitted, "));
  EXPECT_THAT(refit.out, testing::Not(HasSubstr("exactly: shape")));
  EXPECT_THAT(refit.out, HasSubstr("(refitted)"));
}

// Names of the material where they stand, and the place of a normal map where a renderer looks for it.
TEST_F(ExportVerb, LoadLinesAndMapPath) {
  const ProgramResult run =
      Shell("lobefit export brushed_metal.material.json --to mitsuba,pbrt,glsl --name blue-acrylic --map-path maps");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("<include filename=\"blue-acrylic.mitsuba.xml\"/>, then <ref id=\"blue_acrylic\"/>"));
  EXPECT_THAT(run.out, HasSubstr("lobefit_blue_acrylic_f_r(wi, wo)"));
  const std::string xml = ReadWholeFile(folder_ / "blue-acrylic.mitsuba.xml");
  EXPECT_THAT(xml, HasSubstr("id=\"blue_acrylic\""));
  EXPECT_THAT(xml, HasSubstr("value=\"maps/blue-acrylic_normal1.png\""));
  EXPECT_THAT(xml, HasSubstr("needs Mitsuba 3.7.1"));
  EXPECT_THAT(xml, HasSubstr("spectral ones clamp eta and k to 1"));
  const std::string python = ReadWholeFile(folder_ / "blue-acrylic.mitsuba.py");
  EXPECT_THAT(python, HasSubstr("version >= (3, 7, 1)"));
  // Where the XML's map lies; that of the Python file lies in its own folder.
  EXPECT_THAT(xml, HasSubstr("beside the main scene file"));
  EXPECT_THAT(python, testing::Not(HasSubstr("beside the main scene file")));
  EXPECT_THAT(ReadWholeFile(folder_ / "blue-acrylic.pbrt"), HasSubstr("\"maps/blue-acrylic_normal1.png\""));
}

// A lobe that pbrt would make a mirror of, and a material that gains light.
TEST_F(ExportVerb, MitsubaBefore371) {
  // The name ends the string in Python, and the element in XML.
  const std::string name = R"("a'b<\"&c")";
  ASSERT_EQ(Shell("lobefit export brushed_metal.material.json --to mitsuba --name " + name).exit_code, 0);
  EXPECT_THAT(ReadWholeFile(folder_ / "a'b<\"&c.mitsuba.xml"), HasSubstr("use_shadowing_function"));
  const ProgramResult old =
      Shell("lobefit export brushed_metal.material.json --to mitsuba --mitsuba-version 3.7.0 --name " + name);
  ASSERT_EQ(old.exit_code, 0) << old.err;
  const std::string xml = ReadWholeFile(folder_ / "a'b<\"&c.mitsuba.xml");
  EXPECT_THAT(xml.substr(xml.find("<scene")), testing::Not(HasSubstr("use_shadowing_function")));
  EXPECT_THAT(xml, HasSubstr("value=\"a&#39;b&lt;&quot;&amp;c_normal1.png\""));
  const std::string python = ReadWholeFile(folder_ / "a'b<\"&c.mitsuba.py");
  EXPECT_THAT(python, HasSubstr(R"(os.path.join(folder, 'a\'b<"&c_normal1.png'))"));
  EXPECT_EQ(Shell("python3 -m py_compile " + name.substr(0, name.size() - 1) + ".mitsuba.py\"").exit_code, 0);
}

TEST_F(ExportVerb, NarrowLobesAndCreatedEnergyAreNamed) {
  ASSERT_EQ(Shell("cat > narrow.py <<'END'\n"
                  "import json\n"
                  "d = json.load(open('brushed_metal.material.json'))\n"
                  "p = d['parameters']\n"
                  "p['alpha_x']['value'], p['alpha_y']['value'] = 0.0008, 0.0005\n"
                  "p['theta_x_deg']['value'] = p['theta_y_deg']['value'] = 0\n"
                  "p['diffuse']['value'] = [0.9, 0.9, 0.9]\n"
                  "json.dump(d, open('narrow.material.json', 'w'))\nEND\npython3 narrow.py")
                .exit_code,
            0);
  const ProgramResult run = Shell("lobefit export narrow.material.json --to pbrt --copy");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("approximately: shape (a lobe is narrower than 0.001"));
  EXPECT_THAT(ReadWholeFile(folder_ / "narrow.pbrt"),
              HasSubstr("\"float uroughness\" 0.001 \"float vroughness\" 0.0005"));
  EXPECT_THAT(run.out, HasSubstr("reflects more than it receives: an albedo of 1."));
}

// A table of lobes in place of a model: the document and shader text hold it, all others refuse it.
TEST_F(ExportVerb, TablesOfLobes) {
  ASSERT_EQ(Shell("lobefit fit $SOURCE/samples/satin_plastic.csv --recipe sel --no-report").exit_code, 0);
  const ProgramResult run = Shell("lobefit export satin_plastic.material.json --to json,glsl --out here");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("exactly: lobes, interpolation, channels (the table itself)"));
  const nlohmann::json record = nlohmann::json::parse(ReadWholeFile(folder_ / "here/satin_plastic.export.json"));
  ASSERT_EQ(record["targets"].size(), 2U);
  EXPECT_LT(record["targets"][0]["relative_error"]["maximum"], 1e-12) << "angles in degrees";
  EXPECT_LT(record["targets"][1]["relative_error"]["maximum"], 1e-5);
  EXPECT_GT(record["targets"][1]["relative_error"]["maximum"], 0) << "single precision";
  const std::string glsl = ReadWholeFile(folder_ / "here/satin_plastic.glsl");
  EXPECT_THAT(glsl, testing::StartsWith("// satin_plastic: exported by lobefit"));
  EXPECT_THAT(glsl, HasSubstr("vec3 lobefit_satin_plastic_f_r_bound(vec3 wi, vec3 axis, float half_angle)"));
  for (const char* target :
       {"osl", "brdf-explorer", "pbrt", "mitsuba", "materialx", "openpbr", "gltf", "rgl", "merl", "bsdf-xml", "csv"}) {
    const ProgramResult refused =
        Shell(std::string("lobefit export satin_plastic.material.json --out there --to ") + target);
    EXPECT_EQ(refused.exit_code, 3) << target;
    EXPECT_THAT(refused.err, HasSubstr(std::string(target) + " cannot hold this material")) << target;
    EXPECT_THAT(refused.err, HasSubstr("table of squared ellipsoidal lobes")) << target;
    EXPECT_THAT(refused.err, HasSubstr("targets that can: json, glsl")) << target;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "there"));
}

// The exported material beside recipes: its error on the measurement is near that of the fit it came from.
TEST_F(ExportVerb, CompareTakesMaterialsOfRenderers) {
  ASSERT_EQ(Shell("lobefit export brushed_metal.material.json --to gltf,mitsuba").exit_code, 0);
  const ProgramResult run = Shell(
      "lobefit compare $SOURCE/samples/brushed_metal.csv --recipes ggx --with brushed_metal.gltf --with "
      "brushed_metal.mitsuba.xml --with brushed_metal.material.json --name out --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json models = nlohmann::json::parse(run.out)["models"];
  ASSERT_EQ(models.size(), 4U);
  const double ggx = models[0]["errors"]["cube-root"], fit = models[3]["errors"]["cube-root"];
  for (const int k : {1, 2}) {
    const double error = models[static_cast<std::size_t>(k)]["errors"]["cube-root"];
    EXPECT_LT(error, 0.5 * ggx) << k;
    EXPECT_GT(error, fit) << k;
  }
  EXPECT_EQ(Shell("lobefit compare $SOURCE/samples/brushed_metal.csv --recipes ggx --with nothing.mtlx").exit_code, 3);
}

TEST_F(ExportVerb, ListNamesEveryTarget) {
  const ProgramResult run = Shell("lobefit export --list");
  EXPECT_EQ(run.exit_code, 0);
  for (const char* name : {"pbrt", "mitsuba", "materialx", "openpbr", "gltf", "osl", "glsl", "brdf-explorer", "rgl",
                           "merl", "bsdf-xml", "csv", "json"}) {
    EXPECT_THAT(run.out, HasSubstr(name));
  }
}

}  // namespace
}  // namespace lobefit

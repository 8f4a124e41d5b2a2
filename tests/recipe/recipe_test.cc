#include "lobefit/recipe/recipe.h"

#include <cmath>
#include <filesystem>
#include <tuple>

#include "tests/support/paths.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"
#include "lobefit/recipe/free_scale.h"

namespace lobefit {
namespace {

constexpr char kGood[] = R"(name = "mine"
metric = "relative"
weighting = "solid-angle"
theta_max_deg = 70
diffuse = "none"
loss = { kind = "cauchy", scale = 0.2 }

[[lobe]]
ndf = "ellipsoid"
masking = "smith-height"
fresnel = "none"

[parameters]
alpha_x = { start = 0.2, bounds = [0.01, 0.5] }
theta_x_deg = { fixed = 2 }
scale = { start = [0.1, 0.2, 0.3] }
)";

TEST(Recipe, ReadsEveryKey) {
  const Recipe recipe = ParseRecipe(kGood, "r.toml");
  EXPECT_EQ(recipe.name, "mine");
  EXPECT_EQ(recipe.metric, Metric::kRelative);
  EXPECT_EQ(recipe.weighting, Weighting::kSolidAngle);
  EXPECT_EQ(recipe.loss, Loss::kCauchy);
  EXPECT_DOUBLE_EQ(recipe.loss_scale, 0.2);
  EXPECT_DOUBLE_EQ(recipe.theta_max, DegreesToRadians(70));
  EXPECT_EQ(recipe.model.diffuse, Diffuse::kNone);
  ASSERT_EQ(recipe.model.lobes.size(), 1U);
  EXPECT_EQ(recipe.model.lobes[0].masking, Masking::kSmithHeight);
  EXPECT_THAT(recipe.parameters[0].start, testing::ElementsAre(0.2));
  EXPECT_EQ(recipe.parameters[0].high, 0.5);
  EXPECT_THAT(recipe.parameters[2].fixed, testing::ElementsAre(testing::DoubleNear(DegreesToRadians(2), 1e-16)));
  EXPECT_FALSE(recipe.IsFree(2));
  EXPECT_TRUE(recipe.IsFree(1));
  EXPECT_THAT(recipe.parameters[5].start, testing::ElementsAre(0.1, 0.2, 0.3));
}

TEST(Recipe, TomlRoundTrip) {
  const std::string once = ToToml(ParseRecipe(kGood, "r.toml"));
  EXPECT_EQ(ToToml(ParseRecipe(once, "r.toml")), once);
  const Recipe metal =
      ParseRecipe("wavelengths_nm = [450, 650.5]\n[[lobe]]\nfresnel = \"conductor\"\nmetal = \"Au\"\n", "m");
  EXPECT_THAT(metal.wavelengths_nm, testing::ElementsAre(450, 650.5));
  EXPECT_EQ(metal.model.lobes[0].metal, "Au");
  EXPECT_EQ(ToToml(ParseRecipe(ToToml(metal), "m")), ToToml(metal));
}

// What the table leaves at its start is fitted where the recipe says so.
TEST(Recipe, FreesWhatIsFixedByDefault) {
  const char* const text =
      "[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n[parameters]\ntau = { free = true, bounds = [0, 2] }\n";
  const Recipe recipe = ParseRecipe(text, "r.toml"),
               fixed = ParseRecipe("[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n", "r.toml");
  EXPECT_TRUE(recipe.IsFree(6));
  EXPECT_FALSE(fixed.IsFree(6));
  EXPECT_TRUE(fixed.IsFree(5));  // the index
  EXPECT_EQ(ToToml(ParseRecipe(ToToml(recipe), "r.toml")), ToToml(recipe));
  EXPECT_TRUE(ParseRecipe(ToToml(recipe), "r.toml").IsFree(6));
}

TEST(Recipe, ACoatNeedsCalibratedValues) {
  EXPECT_THROW(ParseRecipe("scale = \"free\"\n[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n", "r.toml"),
               InputError);
}

// Degrees become radians when they are read: what is written is the number that becomes the same radians again.
TEST(Recipe, AnglesComeBackFromTheTextToTheLastBit) {
  for (int i = 1; i < 600; ++i) {
    const double degrees = 0.1 * i;
    const Recipe recipe = ParseRecipe(
        "theta_max_deg = " + std::to_string(degrees) +
            "\n[[lobe]]\nndf = \"ellipsoid\"\n[parameters]\ntheta_x_deg = { start = " + std::to_string(degrees) +
            ", bounds = [" + std::to_string(-degrees) + ", " + std::to_string(degrees + 1) + "] }\n",
        "a.toml");
    const Recipe again = ParseRecipe(ToToml(recipe), "b.toml");
    EXPECT_EQ(again.theta_max, recipe.theta_max) << degrees;
    EXPECT_EQ(again.parameters[2].start, recipe.parameters[2].start) << degrees;
    EXPECT_EQ(again.parameters[2].low, recipe.parameters[2].low) << degrees;
    EXPECT_EQ(again.parameters[2].high, recipe.parameters[2].high) << degrees;
    EXPECT_THAT(ToToml(recipe),
                testing::HasSubstr("theta_max_deg = " + FormatDouble(std::round(10 * degrees) / 10) + "\n"));
  }
}

TEST(Recipe, NamesComeBackWithQuotesAndControlCharacters) {
  Recipe recipe = ParseRecipe("[[lobe]]\n", "a.toml");
  recipe.name = "a \"b\" \\ c\n\t\x7f d";
  EXPECT_EQ(ParseRecipe(ToToml(recipe), "b.toml").name, recipe.name);
}

TEST(Recipe, AKeyOfManyPartsIsRefusedWithItsLine) {
  const auto dotted = [](std::size_t parts) {
    std::string key = "a";
    for (std::size_t k = 0; k < parts; ++k) key += ".a";
    return key;
  };
  const auto message = [](const std::string& text) -> std::string {
    try {
      ParseRecipe(text, "r.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  constexpr std::size_t kMany = 400000;
  EXPECT_THAT(message("name = \"x\"\n" + dotted(kMany) + " = 1\n"), testing::StartsWith("r.toml:2: the line has more"));
  EXPECT_THAT(message("[" + dotted(kMany) + "]"), testing::StartsWith("r.toml:1: the line has more"));
  EXPECT_THAT(message("loss = { " + dotted(kMany) + " = 1 }"), testing::StartsWith("r.toml:1: the line has more"));
  // What is read goes as deep without a fault.
  EXPECT_THAT(message(dotted(9000) + " = 1"), testing::HasSubstr("unknown key 'a'"));
}

TEST(Recipe, AFreeScaleComesBackAndIsCheckedAgainstEnergy) {
  const Recipe recipe = ParseRecipe("name = \"x\"\nscale = \"free\"\n[[lobe]]\nfresnel = \"schlick\"\n", "a.toml");
  EXPECT_TRUE(recipe.free_scale);
  EXPECT_EQ(recipe.model.lobes[0].fresnel, Fresnel::kNone);
  EXPECT_EQ(recipe.name, "x-free-scale");
  const Recipe again = ParseRecipe(ToToml(recipe), "b.toml");
  EXPECT_EQ(ToToml(again), ToToml(recipe));
  EXPECT_TRUE(again.free_scale);
  EXPECT_FALSE(ParseRecipe("scale = \"calibrated\"\n[[lobe]]\n", "c.toml").free_scale);
  EXPECT_THROW(ParseRecipe("scale = \"loose\"\n[[lobe]]\n", "c.toml"), InputError);
  EXPECT_THROW(ParseRecipe("scale = \"free\"\nenergy = \"conserving\"\n[[lobe]]\n", "c.toml"), InputError);
}

// What the automatic choice found under a free scale is what is fitted: a curve stays one, however high.
TEST(Recipe, AFreeScaleKeepsCurvesAndMakesDiffusePartsLinear) {
  const Recipe recipe =
      ParseRecipe("scale = \"free\"\ndiffuse = \"interfaced\"\n[[lobe]]\nfresnel = \"curve\"\n", "a.toml");
  EXPECT_EQ(recipe.model.lobes[0].fresnel, Fresnel::kCurve);
  EXPECT_EQ(recipe.model.diffuse, Diffuse::kLambert);
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t i = FirstFresnel(recipe.model, 0); i < parameters.size(); ++i)
    EXPECT_GE(recipe.parameters[i].high.value_or(parameters[i].high), 1e6) << parameters[i].name;
  EXPECT_EQ(ToToml(ParseRecipe(ToToml(recipe), "b.toml")), ToToml(recipe));
  // In the plane of incidence lobes have a free factor, but the albedo below an interface stays an albedo.
  Recipe scaled = ParseRecipe("diffuse = \"interfaced\"\n[[lobe]]\nfresnel = \"none\"\n", "c.toml");
  LiftReflectanceBounds(&scaled);
  const std::vector<Parameter> of_scaled = Parameters(scaled.model);
  for (std::size_t i = 0; i < of_scaled.size(); ++i) {
    if (of_scaled[i].name != "diffuse") continue;
    EXPECT_LE(scaled.parameters[i].high.value_or(of_scaled[i].high), 1);
  }
}

TEST(Recipe, MetalsNeedAWavelengthAChannel) {
  const Recipe recipe = ParseRecipe("[[lobe]]\nfresnel = \"conductor\"\nmetal = \"Cu\"\n", "m");
  EXPECT_THROW(WithMetals(recipe, {}, 3), InputError);
  EXPECT_THROW(WithMetals(recipe, {450, 550, 1e6}, 3), InputError);
  const Recipe resolved = WithMetals(recipe, {450, 550, 650}, 3);
  ASSERT_EQ(resolved.parameters[5].fixed.size(), 3U);
  // Copper's real part falls from the blue to the red.
  EXPECT_GT(resolved.parameters[5].fixed[0], resolved.parameters[5].fixed[2]);
}

TEST(Recipe, RecipesOfTheLibraryAreValid) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::SourceDir() / "fits")) {
    if (entry.path().extension() != ".toml") continue;
    const Recipe recipe = ReadRecipe(entry.path());
    EXPECT_EQ(recipe.name, entry.path().stem().string());
    ++read;
  }
  EXPECT_GE(read, 3);
}

struct BadCase {
  const char* toml;
  const char* message;
};

class BadRecipe : public testing::TestWithParam<BadCase> {};

TEST_P(BadRecipe, IsRefusedWithFileLineAndWhatIsAllowed) {
  try {
    ParseRecipe(GetParam().toml, "r.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), GetParam().message);
    EXPECT_EQ(error.exit_code(), 3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRecipe,
    testing::Values(
        BadCase{"[[lobe]]\nnfd = \"ggx\"\n",
                "r.toml:2: unknown key 'nfd' of a lobe (did you mean 'ndf'?); allowed: ndf, masking, fresnel, metal, "
                "direction, knots"},
        BadCase{"[[lobe]]\nndf = \"ggxx\"\n",
                "r.toml:2: ndf = 'ggxx' is unknown (did you mean 'ggx'?); allowed: ggx, ggx-tilted, ggx-anisotropic, "
                "ellipsoid, beckmann, beckmann-anisotropic, beckmann-off-center, kagiwada-kalaba, spherical-gaussian, "
                "profile, profile-tilted, profile-anisotropic, profile-ellipsoid, student, student-tilted, "
                "student-anisotropic, student-ellipsoid, abg, abg-anisotropic"},
        BadCase{"[[lobe]]\nndf = \"abg\"\nmasking = \"smith-height\"\n",
                "r.toml:1: ndf abg is f_r itself: it goes with masking = 'none'"},
        BadCase{"[[lobe]]\nndf = \"abg\"\nfresnel = \"schlick\"\n",
                "r.toml:1: ndf abg is f_r itself: it goes with fresnel = 'none'"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\nmasking = \"none\"\n",
                "r.toml:1: masking none goes with ndf abg only, not with ggx"},
        BadCase{"[[lobe]]\nndf = \"abg\"\n[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n",
                "r.toml:1: ndf abg is the scatter of the whole surface: no coat lies over it"},
        BadCase{"[[lobe]]\nmasking = \"v-cavity\"\n",
                "r.toml:1: masking v-cavity needs a lobe about the normal, ellipsoid may tilt; use ndf ggx-anisotropic "
                "or beckmann-anisotropic, or a Smith masking"},
        BadCase{"[[lobe]]\nfresnel = \"conductor\"\nmetal = \"Unobtainium\"\n",
                "r.toml:3: metal = 'Unobtainium' is unknown; allowed: Ag, silver, Al, aluminium, Au, gold, Cr, "
                "chromium, Cu, "
                "copper, Fe, iron, Ni, nickel, Ti, titanium, W, tungsten, brass, Cu70Zn30"},
        BadCase{
            "metric = 3\n[[lobe]]\n",
            "r.toml:1: metric = '?' is unknown; allowed: log, cube-root, relative, cosine-l2, ngan, low-log, asinh"},
        BadCase{"[[lobe]]\n[parameters]\nalpha = { start = 1 }\n",
                "r.toml:3: unknown key 'alpha' of this model's parameters (did you mean 'alpha_x'?); allowed: alpha_x, "
                "alpha_y, "
                "theta_x_deg, theta_y_deg, theta_z_deg, f0, diffuse"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { start = 0.9, bounds = [0.1, 0.5] }\n",
                "r.toml:3: 'alpha_x' = 0.9 lies outside its bounds [0.1, 0.5]"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { bounds = [0.5, 0.1] }\n",
                "r.toml:3: bounds of 'alpha_x': the first must be below the second"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { fixed = nan }\n", "r.toml:3: 'fixed' must be a finite number"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\n[parameters]\nalpha_y = { start = 0.1 }\n",
                "r.toml:4: 'alpha_y' is not a free parameter of this ndf; it can only be fixed"},
        BadCase{"diffuse = \"none\"\n[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n",
                "r.toml:2: a coat lies over something: add a [[lobe]] or a diffuse part below it"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-layered\"\n[parameters]\ntau = { start = 0.1 }\n",
                "r.toml:5: 'tau' is not fitted unless it has free = true"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\nfresnel = \"coat-refracted\"\n[parameters]\nior = { shared = false }\n",
                "r.toml:5: 'ior' of a coat is one for all channels, which pass it on one way"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { fixed = 0.1, free = true }\n", "r.toml:3: 'f0' is both fixed and free"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\n[parameters]\nalpha_y = { free = true }\n",
                "r.toml:4: 'alpha_y' is not a free parameter of this ndf; it can only be fixed"},
        BadCase{"theta_max_deg = 95\n[[lobe]]\n", "r.toml:1: theta_max_deg must lie in (0, 90]"},
        BadCase{"name = \"x\"\n", "r.toml:1: a recipe needs at least one [[lobe]], or [sel]"}));

// Of parameters, knots, losses, tables of lobes and instruments.
INSTANTIATE_TEST_SUITE_P(
    Parts, BadRecipe,
    testing::Values(
        BadCase{
            "[[lobe]]\n[parameters]\nalpha_x = 0.2\n",
            "r.toml:3: 'alpha_x' must be a table such as { start = 0.2 }; keys: start, fixed, bounds, shared, free"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { bounds = [0.1] }\n",
                "r.toml:3: bounds of 'alpha_x' must be two numbers, [low, high]"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { bounds = [0.1, inf] }\n",
                "r.toml:3: bounds of 'alpha_x' must be finite numbers"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { bounds = [-1, 0.5] }\n",
                "r.toml:3: bounds of 'alpha_x' leave its range [0.0001, 1]"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { shared = true }\n",
                "r.toml:3: 'alpha_x' has one value for all channels anyway"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { shared = 1 }\n", "r.toml:3: 'shared' must be true or false"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { start = [] }\n", "r.toml:3: 'start' is an empty list"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { start = [0.1, \"x\"] }\n",
                "r.toml:3: 'start' must be a finite number or a list of them, one a channel"},
        BadCase{"[[lobe]]\n[parameters]\nalpha_x = { start = [0.1, 0.2] }\n",
                "r.toml:3: 'start' must be a finite number"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { fixed = 0.1, start = 0.2 }\n",
                "r.toml:3: 'f0' is fixed: start and bounds do not apply"},
        BadCase{"[[lobe]]\n[parameters]\nf0 = { free = false }\n",
                "r.toml:3: 'free' of 'f0' must be true; { fixed = ... } fixes it"},
        BadCase{"parameters = 3\n[[lobe]]\n", "r.toml:1: 'parameters' must be a table"},
        BadCase{"name = 3\n[[lobe]]\n", "r.toml:1: 'name' must be a string"},
        BadCase{"lobe = 3\n", "r.toml:1: lobes are written as [[lobe]], at most three"},
        BadCase{"[[lobe]]\n[[lobe]]\n[[lobe]]\n[[lobe]]\n", "r.toml:1: lobes are written as [[lobe]], at most three"},
        BadCase{"[[lobe]]\nndf = \"profile\"\nknots = [0, 2, 1]\n",
                "r.toml:3: the knots of a profile (0, 2, 1) must increase, begin with 0 and contain 1, at most 20, "
                "such as 0, 1, 2, 4, 8"},
        BadCase{"[[lobe]]\nndf = \"profile\"\nknots = 4\n",
                "r.toml:3: the knots of a profile (4) must increase, begin with 0 and contain 1, at most 20, such as "
                "0, 1, 2, 4, 8"},
        BadCase{"[[lobe]]\nndf = \"ggx\"\nknots = [0, 1, 2]\n",
                "r.toml:1: knots go with a profile only, not with ndf ggx"},
        BadCase{"[[lobe]]\nndf = \"profile\"\nknots=[0,1,2,4]\n[parameters]\nq3 = { start = -0.6 }\n",
                "r.toml:5: 'q3' = -0.6 lies outside its bounds [-0.45, 40]"},
        BadCase{"[[lobe]]\nndf = \"student\"\n[parameters]\ngamma = { start = 1.0 }\n",
                "r.toml:4: 'gamma' = 1 lies outside its bounds [1.55, 100]"},
        BadCase{"[loss]\nkind = \"cauchy\"\nscale = 0\n[[lobe]]\n", "r.toml:1: the scale of the loss must be above 0"},
        BadCase{"loss = \"cauchy\"\n[[lobe]]\n", "r.toml:1: 'loss' must be a table"},
        BadCase{"[sel]\nlobes = 4\n", "r.toml:2: lobes = 4: allowed are 1, 2 and 3"},
        BadCase{"[sel]\nlobes = 2\n[[lobe]]\n",
                "r.toml:3: unknown key 'lobe' of a recipe with [sel]; allowed: name, metric, weighting, theta_max_deg, "
                "sel"},
        BadCase{"[sel]\ndrift = -1\n", "r.toml:2: 'drift' must be above 0"},
        BadCase{"scale = \"loose\"\n[[lobe]]\n", "r.toml:1: scale = 'loose' is unknown; allowed: calibrated, free"},
        BadCase{"scale = \"free\"\nenergy = \"conserving\"\n[[lobe]]\n",
                "r.toml:1: values without a scale have no albedo that energy = \"conserving\" could limit"},
        BadCase{"wavelengths_nm = []\n[[lobe]]\n", "r.toml:1: 'wavelengths_nm' is an empty list"},
        BadCase{"wavelengths_nm = [550, -1, 3]\n[[lobe]]\n", "r.toml:1: a wavelength of -1 nm; it must be above 0"},
        BadCase{
            "[instrument]\nnoise = { floor = 0.1 }\n[[lobe]]\n",
            "r.toml:2: noise is written as { floor = 0.002, relative = 0.03, poisson = 0.0001 }: of f_r cos(theta_i) "
            "the floor and the value of one count, in 1/sr, one of them above 0, and the relative part in (0, 1]"},
        BadCase{"[instrument]\ndrift = 0\n[[lobe]]\n",
                "r.toml:2: drift is \"auto\" or the relative standard deviation of a gain, in (0, 1]"},
        BadCase{"[instrument]\ndetector = { value = 0, prior_deg = 0.1 }\n[[lobe]]\n",
                "r.toml:2: detector is a point (value = 0), which is neither fitted nor a rectangle; give a half angle "
                "above 0, or leave the rest out"},
        BadCase{"[instrument]\ndetector = 90\n[[lobe]]\n",
                "r.toml:2: detector = 90: the half angle of a disc, in degrees, must lie in [0, 30]"},
        BadCase{"[instrument]\noffset = 1\n[[lobe]]\n", "r.toml:2: 'offset' must be true or false"},
        BadCase{"[[lobe]]\ndirection = \"sideways\"\n",
                "r.toml:2: direction = 'sideways' is unknown; allowed: specular, retro"},
        BadCase{"[[lobe]]\ndirection = \"retro\"\nfresnel = \"coat-layered\"\n[[lobe]]\n",
                "r.toml:1: direction retro needs a lobe about the normal, ellipsoid may tilt, and would not be "
                "reciprocal; use ndf ggx, ggx-anisotropic or one of the others without a tilt"},
        BadCase{"[[lobe]]\nfresnel=\"coat-layered\"\n[[lobe]]\nfresnel=\"coat-layered\"\n",
                "r.toml:1: a model has one coat at most"},
        BadCase{"diffuse = \"microfacet\"\n[[lobe]]\nndf = \"profile\"\n",
                "r.toml:2: diffuse microfacet needs a first lobe of GGX or Beckmann facets, not profile"},
        BadCase{"", "r.toml:1: a recipe needs at least one [[lobe]], or [sel]"}));

TEST(AutomaticRecipe, TakesWhatTheMeasurementDetermines) {
  EXPECT_EQ(AutomaticRecipe({.isotropic = true}).model.lobes[0].ndf, Ndf::kGgx);
  const Recipe in_plane = AutomaticRecipe({.in_plane = true, .plane_azimuth = 0.5});
  EXPECT_EQ(in_plane.model.lobes[0].ndf, Ndf::kGgxTilted);
  EXPECT_EQ(in_plane.plane_azimuth, 0.5);
  EXPECT_EQ(AutomaticRecipe({}).model.lobes[0].ndf, Ndf::kEllipsoid);
  EXPECT_FALSE(AutomaticRecipe({}).reason.empty());
}

TEST(Recipe, ReadsTheInstrument) {
  const std::string lobe = "[[lobe]]\nndf = \"ggx\"\n";
  const Recipe recipe = ParseRecipe(lobe + "[instrument]\nsource = 2\ndetector = 1.5\nmean = \"plain\"\n", "r.toml");
  EXPECT_DOUBLE_EQ(*recipe.instrument.source, DegreesToRadians(2));
  EXPECT_DOUBLE_EQ(recipe.aperture().detector, DegreesToRadians(1.5));
  EXPECT_EQ(recipe.aperture().mean, ApertureMean::kPlain);
  const Recipe again = ParseRecipe(ToToml(recipe), "again.toml");
  EXPECT_DOUBLE_EQ(*again.instrument.detector, *recipe.instrument.detector);
  EXPECT_EQ(again.instrument.mean, recipe.instrument.mean);
  EXPECT_FALSE(ParseRecipe(lobe, "r.toml").aperture().any());
  for (const char* section :
       {"source = { value = 2, prior_deg = 0.1 }\ndetector = { prior_deg = 0.3 }\n",
        "detector = { value = 0.5, across = 4 }\n", "noise = { floor = 0.002, relative = 0.03, poisson = 0.0001 }\n",
        "noise = { poisson = 0.0001, relative = 0.03 }\n"}) {
    const Recipe read = ParseRecipe(lobe + "[instrument]\n" + section, "r.toml"),
                 back = ParseRecipe(ToToml(read), "again.toml");
    EXPECT_EQ(ToToml(back), ToToml(read));
    const InstrumentRecipe &a = read.instrument, &b = back.instrument;
    EXPECT_EQ(std::tie(a.source, a.source_prior, a.detector, a.detector_prior, a.detector_across),
              std::tie(b.source, b.source_prior, b.detector, b.detector_prior, b.detector_across));
    EXPECT_EQ(std::tie(read.noise.floor, read.noise.relative, read.noise.poisson),
              std::tie(back.noise.floor, back.noise.relative, back.noise.poisson));
    EXPECT_TRUE(a.source_prior || a.detector_across || read.noise.poisson > 0);
  }
  const auto message = [&](const std::string& section) -> std::string {
    try {
      ParseRecipe(lobe + section, "r.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message("[instrument]\nsource = 90\n"), testing::HasSubstr("r.toml:4: source = 90: the half angle"));
  EXPECT_THAT(message("[instrument]\ndetector = -1\n"), testing::HasSubstr("must lie in [0, 30]"));
  EXPECT_THAT(message("[instrument]\nmean = \"median\"\n"), testing::HasSubstr("allowed: flux, plain"));
  EXPECT_THAT(message("[instrument]\naperture = 2\n"), testing::HasSubstr("allowed: source, detector, mean"));
  EXPECT_THAT(message("[instrument]\ndrift = \"often\"\n"), testing::HasSubstr("drift is \"auto\" or the relative"));
  EXPECT_THAT(message("[instrument]\ndrift = 0\n"), testing::HasSubstr("in (0, 1]"));
  EXPECT_THAT(message("[instrument]\nalignment = { prior_deg = 9 }\n"), testing::HasSubstr("must lie in (0, 5]"));
  EXPECT_THAT(message("[instrument]\nnoise = { floor = 0.1 }\n"), testing::HasSubstr("noise is written as"));
  EXPECT_THAT(message("[instrument]\noffset = 1\n"), testing::HasSubstr("true or false"));
  EXPECT_THAT(message("[instrument]\ndetector = { value = 1, prior_deg = 0 }\n"),
              testing::HasSubstr("prior_deg of detector is 0: the standard deviation"));
  EXPECT_THAT(message("[instrument]\ndetector = { value = 0, prior_deg = 1 }\n"), testing::HasSubstr("is a point"));
  EXPECT_THAT(message("[instrument]\ndetector = { value = 1, prior_deg = 0.1, across = 2 }\n"),
              testing::HasSubstr("is a rectangle, whose half angles are not fitted"));
  EXPECT_THAT(message("[instrument]\nsource = { value = 1, across = 2 }\n"),
              testing::HasSubstr("allowed: value, prior_deg"));
  EXPECT_THAT(message("[instrument]\ndetector = { value = 1, width = 2 }\n"), testing::HasSubstr("across"));
  EXPECT_THAT(message("[instrument]\nnoise = { floor = -1, relative = 0.1, poisson = 0.1 }\n"),
              testing::HasSubstr("noise is written as"));
}

TEST(Recipe, ReadsWhatAnInstrumentDoesBesidesAveraging) {
  const Recipe read = ParseRecipe(
      "[[lobe]]\nndf = \"ggx\"\n[instrument]\ndrift = 0.03\nalignment = { prior_deg = 0.5 }\noffset = true\n"
      "noise = { floor = 0.002, relative = 0.04 }\n",
      "r.toml");
  for (const Recipe& recipe : {read, ParseRecipe(ToToml(read), "again.toml")}) {
    EXPECT_EQ(recipe.instrument.drift->sd, 0.03);
    EXPECT_DOUBLE_EQ(recipe.instrument.alignment->prior, DegreesToRadians(0.5));
    EXPECT_TRUE(recipe.instrument.offset);
    EXPECT_EQ(recipe.noise.floor, 0.002);
    EXPECT_EQ(recipe.noise.relative, 0.04);
  }
  const Recipe estimated = ParseRecipe("[[lobe]]\nndf = \"ggx\"\n[instrument]\ndrift = \"auto\"\n", "r.toml");
  ASSERT_TRUE(estimated.instrument.drift);
  EXPECT_FALSE(estimated.instrument.drift->sd);
}

}  // namespace
}  // namespace lobefit

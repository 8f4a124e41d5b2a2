#include "lobefit/material/json.h"

#include <chrono>
#include <string>

#include "tests/support/schema.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

Material FittedMaterial() {
  Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 1, 2, 20), StandardLayout(), 0.05, 3);
  measurement.conventions["value-kind"] = "f (header)";
  return Fit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
}

TEST(MaterialJson, FollowsTheSchemaAndReadsBackAsItself) {
  const Material material = FittedMaterial();
  const std::string text = ToJson(material);
  EXPECT_TRUE(FollowsSchema(text));
  const std::string again = ToJson(MaterialFromJson(text, "m.json"));
  EXPECT_EQ(again, text);
}

TEST(MaterialJson, HasTheContractsNamesAndDegrees) {
  const Material material = FittedMaterial();
  const nlohmann::json json = nlohmann::json::parse(ToJson(material));
  for (const char* name : {"alpha_x", "alpha_y", "theta_x_deg", "theta_y_deg", "theta_z_deg", "f0", "diffuse"}) {
    for (const char* member : {"value", "stderr", "unit", "free"})
      EXPECT_TRUE(json["parameters"][name].contains(member)) << name << " " << member;
  }
  EXPECT_NEAR(json["parameters"]["theta_z_deg"]["value"].get<double>(), 20, 0.5);
  EXPECT_EQ(json["parameters"]["theta_z_deg"]["unit"], "deg");
  EXPECT_EQ(json["parameters"]["f0"]["value"].size(), 3U);
  EXPECT_NEAR(json["parameters"]["theta_y_deg"]["stderr"].get<double>(),
              RadiansToDegrees(material.parameters[3].standard_error[0]), 1e-15);
  // The covariance is in the units of the parameters.
  const std::size_t row = 3;
  EXPECT_EQ(json["covariance"]["names"][row], "theta_y_deg");
  EXPECT_NEAR(std::sqrt(json["covariance"]["matrix"][row][row].get<double>()),
              json["parameters"]["theta_y_deg"]["stderr"].get<double>(), 1e-12);
}

TEST(MaterialJson, NotANumberBecomesNull) {
  Material material = FittedMaterial();
  material.parameters[0].standard_error[0] = std::nan("");
  const std::string text = ToJson(material);
  EXPECT_TRUE(nlohmann::json::parse(text)["parameters"]["alpha_x"]["stderr"].is_null());
  EXPECT_TRUE(FollowsSchema(text));
  EXPECT_TRUE(std::isnan(MaterialFromJson(text, "m.json").parameters[0].standard_error[0]));
}

// The numbers of a profile may be negative, down to their bounds.
TEST(MaterialJson, ReadsAProfileBack) {
  SyntheticCase profile = OneLobe(Ndf::kProfile, 0.3, 0.3, 0, 0, 0);
  profile.values.insert(profile.values.begin() + 5, {{-1.5}, {0.3}, {-2}, {0.1}, {-0.4}, {-0.45}});
  Material material = FittedMaterial();
  material.model = profile.model;
  material.parameters.clear();
  for (const std::vector<double>& values : profile.values) {
    material.parameters.push_back({values, values, values, values, {}, true, false});
  }
  material.covariance_names.clear();
  material.covariance = material.covariance_clustered = {};
  const std::string text = ToJson(material);
  EXPECT_EQ(ToJson(MaterialFromJson(text, "m.json")), text);
  for (const double beyond : {-0.46, 41.0}) {
    material.parameters[10].values = {beyond};
    EXPECT_THROW(MaterialFromJson(ToJson(material), "m.json"), InputError) << beyond;
  }
}

// Each member was compared with all before it: 100 000 took half a minute.
TEST(MaterialJson, RefusesACrowdOfMembers) {
  std::string text = R"({"format": "lobefit material")";
  for (int k = 0; k < 100000; ++k) text += ", \"k" + std::to_string(k) + "\": {\"a:\\\"b\": 0}";
  const auto start = std::chrono::steady_clock::now();
  try {
    MaterialFromJson(text + "}", "m.json");
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("more than 1000 members"), std::string::npos) << error.what();
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2);
  // Strings may hold anything, and many objects a few members each.
  Material material = FittedMaterial();
  material.source.file = std::string(5000, ':') + "\"\\{[";
  EXPECT_EQ(MaterialFromJson(ToJson(material), "m.json").source.file, material.source.file);
}

TEST(MaterialJson, RefusesWhatIsNotAMaterial) {
  const std::string good = ToJson(FittedMaterial());
  const auto without = [&](const char* member) {
    nlohmann::json json = nlohmann::json::parse(good);
    json.erase(member);
    return json.dump();
  };
  const auto with_value = [&](const nlohmann::json::json_pointer& where, const nlohmann::json& value) {
    nlohmann::json json = nlohmann::json::parse(good);
    json[where] = value;
    return json.dump();
  };
  using Pointer = nlohmann::json::json_pointer;
  for (const std::string& bad : {std::string(),
                                 std::string("{"),
                                 std::string("[]"),
                                 std::string("{\"format\": \"other\"}"),
                                 good.substr(0, good.size() / 2),
                                 without("model"),
                                 without("parameters"),
                                 without("channels"),
                                 with_value(Pointer("/format_version"), "2.0"),
                                 with_value(Pointer("/model/lobes/0/ndf"), "phong"),
                                 with_value(Pointer("/parameters/alpha_x/value"), "0.3"),
                                 with_value(Pointer("/parameters/f0/value"), {0.1, 0.2}),
                                 with_value(Pointer("/parameters/alpha_x/value"), nullptr),
                                 with_value(Pointer("/parameters/alpha_x/value"), 0),
                                 with_value(Pointer("/parameters/alpha_x/value"), -0.2),
                                 with_value(Pointer("/parameters/alpha_x/value"), 1e300),
                                 with_value(Pointer("/parameters/theta_z_deg/value"), 91),
                                 with_value(Pointer("/parameters/f0/value/1"), -0.1),
                                 with_value(Pointer("/covariance/matrix/0"), nlohmann::json::array()),
                                 with_value(Pointer("/channels"), nlohmann::json::array())}) {
    EXPECT_THROW(MaterialFromJson(bad, "m.json"), InputError) << bad.substr(0, 60);
  }
}

// A document of a model whose parameters have these values in one channel.
nlohmann::json DocumentOf(const Model& model, const ParameterValues& values) {
  Material material;
  material.model = model;
  material.channels = {"value"};
  for (const std::vector<double>& value : values)
    material.parameters.push_back({value, value, value, value, {}, true, false});
  return nlohmann::json::parse(ToJson(material));
}

// What no fit of the model can end with, and what one can.
TEST(MaterialJson, ChecksValuesAgainstTheTableOfParameters) {
  const Lobe ggx = {Ndf::kGgx};
  const auto lobe = [](Ndf ndf, Fresnel fresnel) { return Lobe{ndf, Masking::kSmithSeparable, fresnel}; };
  const ParameterValues round = {{0.2}, {0.2}, {0}, {0}, {0}};
  const auto with = [&](const ParameterValues& more) {
    ParameterValues values = round;
    values.insert(values.end(), more.begin(), more.end());
    return values;
  };
  const Model f82 = {{lobe(Ndf::kGgx, Fresnel::kSchlickF82)}, Diffuse::kLambert},
              conductor = {{lobe(Ndf::kGgx, Fresnel::kConductor)}, Diffuse::kLambert},
              dielectric = {{lobe(Ndf::kGgx, Fresnel::kDielectric)}, Diffuse::kLambert},
              curve = {{lobe(Ndf::kGgx, Fresnel::kCurve)}, Diffuse::kLambert},
              student = {{lobe(Ndf::kStudent, Fresnel::kSchlick)}, Diffuse::kLambert},
              oren_nayar = {{ggx}, Diffuse::kOrenNayar},
              coated = {{lobe(Ndf::kGgx, Fresnel::kCoatLayered)}, Diffuse::kLambert};
  const ParameterValues of_f82 = with({{0.5}, {0.9}, {0.1}}), of_conductor = with({{0.4}, {3}, {0.1}}),
                        of_dielectric = with({{1.5}, {0.1}}),
                        of_curve = with({{0.9}, {0.5}, {0.2}, {0.1}, {0.1}, {0.1}, {0.1}}),
                        of_student = with({{2.5}, {0.5}, {0.1}}), of_oren_nayar = with({{0.5}, {0.3}, {0.1}}),
                        of_coated = with({{1.5}, {0}, {0.1}});
  const struct {
    const Model& model;
    const ParameterValues& values;
    const char* name;
    std::vector<double> refused, read;
    const char* range;
  } cases[] = {
      {f82, of_f82, "alpha_x", {0, -0.2, 1e-11, 11}, {1e-9, 1.5}, "[1e-10, 10]"},
      {f82, of_f82, "theta_y_deg", {-91, 91}, {-90, 90}, "[-90, 90]"},
      {f82, of_f82, "f0", {-0.1, 2e12}, {0, 5}, "[0, 1e+12]"},
      {f82, of_f82, "tint", {-0.1, 1.3, 1e300}, {0, 1.2}, "[0, 1.2]"},
      {f82, of_f82, "diffuse", {-0.1, 1e300}, {0, 3}, "[0, 1e+12]"},
      {conductor, of_conductor, "eta", {0, 31}, {0.05}, "[0.01, 30]"},
      {conductor, of_conductor, "k", {0, 101}, {90}, "[0.001, 100]"},
      {dielectric, of_dielectric, "ior", {0.9, 6}, {1, 4}, "[1, 5]"},
      {curve, of_curve, "F_3", {-1e-3, 1e300}, {0, 2}, "[0, 1e+12]"},
      {student, of_student, "gamma", {1.5, 101}, {1.55, 100}, "[1.55, 100]"},
      {oren_nayar, of_oren_nayar, "diffuse_roughness", {-0.1, 1.1}, {0, 1}, "[0, 1]"},
      {oren_nayar, of_oren_nayar, "diffuse", {-0.1, 1.1}, {0, 1}, "[0, 1]"},
      {coated, of_coated, "ior", {0.9, 3.5}, {1, 3}, "[1, 3]"},
      {coated, of_coated, "tau", {-0.1, 11}, {2}, "[0, 10]"},
  };
  for (const auto& test : cases) {
    SCOPED_TRACE(test.name);
    nlohmann::json json = DocumentOf(test.model, test.values);
    ASSERT_TRUE(json["parameters"].contains(test.name));
    nlohmann::json& value = json["parameters"][test.name]["value"];
    const nlohmann::json good = value;
    const auto put = [&](double number) { value = good.is_array() ? nlohmann::json{number} : nlohmann::json(number); };
    for (const double number : test.refused) {
      put(number);
      try {
        MaterialFromJson(json.dump(), "m.json");
        ADD_FAILURE() << number << " was read";
      } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(std::string("m.json: parameter '") + test.name), what.npos) << what;
        EXPECT_NE(what.find(test.range), what.npos) << what;
      }
    }
    for (const double number : test.read) {
      put(number);
      EXPECT_NO_THROW(MaterialFromJson(json.dump(), "m.json")) << number;
    }
  }
}

// Lists without a number, of which the first was taken.
TEST(MaterialJson, RefusesEmptyLists) {
  Material material = FittedMaterial();
  material.tried = {{"ggx", 7, 0.1, 1, true}};
  const nlohmann::json good = nlohmann::json::parse(ToJson(material));
  for (const char* where :
       {"/quality/typical_error", "/quality/noise", "/quality/explained", "/quality/energy/largest_albedo",
        "/quality/tried/0/held_out_error", "/quality/tried/0/ratio", "/parameters/alpha_x/stderr",
        "/parameters/f0/stderr_clustered"}) {
    SCOPED_TRACE(where);
    nlohmann::json json = good;
    ASSERT_TRUE(json.contains(nlohmann::json::json_pointer(where)));
    json[nlohmann::json::json_pointer(where)] = nlohmann::json::array();
    EXPECT_THROW(MaterialFromJson(json.dump(), "m.json"), InputError);
  }
}

TEST(MaterialJson, ReadsTheInstrumentBackAndChecksIt) {
  Material material = FittedMaterial();
  InstrumentUsed instrument;
  instrument.source = 0.01;
  instrument.mean = "flux";
  instrument.drift = {0.02, true};
  instrument.half_angles = {{"source", 0.01, 0.001, 0.012, 0.003, true}};
  instrument.across = 0.03;
  instrument.gains = {{0.5, 0.1, 1.02, 0.01}};
  instrument.alignment = {
      {"e_x", 0.002, 0.001, 0.003, 0.9}, {"e_y", 0.001, 0.001, 0.003, 0.1}, {"e_z[2]", 0, 0.1, 1, 0}};
  instrument.alignment_correlation = 0.25;
  instrument.azimuths = {0, kPi};
  material.instrument = instrument;
  const std::string good = ToJson(material);
  const Material read = MaterialFromJson(good, "m.json");
  EXPECT_EQ(ToJson(read), good);
  EXPECT_NEAR(read.instrument->azimuths.at(1), kPi, 1e-12);
  using Pointer = nlohmann::json::json_pointer;
  const std::pair<const char*, nlohmann::json> bad[] = {{"/instrument/source_deg", -1},
                                                        {"/instrument/detector_deg", 40},
                                                        {"/instrument/mean", "median"},
                                                        {"/instrument/half_angles/0/name", "lamp"},
                                                        {"/instrument/half_angles/0/prior_deg", 0},
                                                        {"/instrument/detector_across_deg", 50},
                                                        {"/instrument/gains/0/gain", 0},
                                                        {"/instrument/alignment/0/value_deg", 12},
                                                        {"/instrument/sample_azimuths_deg", {0}},
                                                        {"/instrument/offset", {{{"value", 0.1}, {"stderr", 0}}}}};
  for (const auto& [where, value] : bad) {
    nlohmann::json json = nlohmann::json::parse(good);
    json[Pointer(where)] = value;
    EXPECT_THROW(MaterialFromJson(json.dump(), "m.json"), InputError) << where;
  }
}

}  // namespace
}  // namespace lobefit

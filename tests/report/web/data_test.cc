// What a page computes with: read as a browser reads it, and compared with the fit.
#include "lobefit/report/web/data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/text/base64.h"
#include "lobefit/plot/color.h"
#include "lobefit/report/figures/report_data.h"
#include "lobefit/report/web/template.h"

namespace lobefit {
namespace {

using PageJson = nlohmann::json;

PageJson DataOf(const Material& material, const Measurement& measurement) {
  const ReportData data(material, measurement, 1);
  const std::string text = DataJson(data);
  EXPECT_EQ(text.find('<'), std::string::npos) << "could end the script that it stands in";
  return PageJson::parse(text);
}

// The page's slices are the samples, with the fit at the same places, to the digits that are sent.
TEST(DataJson, SlicesAreTheSamplesAndTheFit) {
  const Material material = test::MakeMaterial(3, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(true), 0.1, false);
  const PageJson json = DataOf(material, measurement);
  const ReportData data(material, measurement, 1);
  const Reflectance reflectance(material.model, material.Values(), 3);
  EXPECT_EQ(json["slices"]["outgoing"], false);
  const PageJson& list = json["slices"]["list"];
  ASSERT_EQ(list.size(), data.slices().slices.size());
  std::vector<double> f_r(3);
  for (std::size_t s = 0; s < list.size(); ++s) {
    const PageJson& slice = list[s];
    const Slice& expected = data.slices().slices[s];
    EXPECT_NEAR(slice["theta"].get<double>(), RadiansToDegrees(expected.theta), 0.005);
    ASSERT_EQ(slice["x"].size(), expected.points.size());
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_TRUE(slice["y"][c].size() == slice["x"].size() && slice["f"][c].size() == slice["x"].size());
      for (std::size_t i = 0; i < expected.points.size(); ++i) {
        const std::size_t sample = expected.points[i].sample;
        const double value = measurement.samples.values[c][sample];
        EXPECT_NEAR(slice["y"][c][i].get<double>(), value, 5.1e-4 * std::fabs(value));
        reflectance.Evaluate(measurement.samples.wi(sample), measurement.samples.wo(sample), f_r.data());
        EXPECT_NEAR(slice["f"][c][i].get<double>(), f_r[c], 5.1e-4 * f_r[c]);
        EXPECT_NEAR(slice["x"][i].get<double>(), RadiansToDegrees(expected.points[i].theta), 0.0051);
      }
    }
  }
  EXPECT_TRUE(json["table"].is_null()) << "an anisotropic measurement is no table";
}

// 16-bit logarithms between "low" and "high"; 0 is not known. Of a table without noise they are those of the surface.
TEST(DataJson, TheTableIsTheMeasurement) {
  const Material material = test::MakeMaterial(3, true);
  const Measurement measurement = test::Measure(material, test::TablePairs(), 0, true);
  const PageJson json = DataOf(material, measurement);
  const PageJson& table = json["table"];
  const auto size = table["size"].get<std::vector<std::size_t>>();
  const std::string bytes = FromBase64(table["data"].get<std::string>()).value();
  ASSERT_EQ(bytes.size(), size[0] * size[1] * size[2] * 3 * 2);
  const double low = table["low"].get<double>(), high = table["high"].get<double>();
  EXPECT_NEAR(high - low, std::log(1e7), 1e-4) << "seven decades";
  const IsotropicLookup lookup(measurement);
  const ChannelColor to_color(measurement.channels);
  std::vector<double> f_r(3);
  std::size_t known = 0, brightest = 0;
  for (std::size_t texel = 0; texel < size[0] * size[1] * size[2]; texel += 37) {
    const double h = static_cast<double>(texel % size[0]) / static_cast<double>(size[0] - 1),
                 d = static_cast<double>(texel / size[0] % size[1]) / static_cast<double>(size[1] - 1),
                 p = static_cast<double>(texel / size[0] / size[1]) / static_cast<double>(size[2] - 1);
    Vec3 wi, wo;
    FromHalfDifference({h * h * kPi / 2, 0, d * kPi / 2, p * kPi / 2}, &wi, &wo);
    const bool is_known = lookup.Find(wi, wo, f_r.data());
    const auto byte = [&](std::size_t at) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[at])); };
    const auto code = [&](std::size_t c) { return byte((3 * texel + c) * 2) + 256 * byte((3 * texel + c) * 2 + 1); };
    EXPECT_EQ(code(0) != 0, is_known) << texel;
    if (!is_known) continue;
    ++known;
    const std::array<double, 3> color = to_color.Linear(f_r.data());
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = std::exp(low + (code(c) - 1.0) / 65534 * (high - low));
      EXPECT_NEAR(value, color[c], 2e-4 * color[c]) << texel;
      brightest = std::max<std::size_t>(brightest, code(c));
    }
  }
  EXPECT_GT(known, 300U);
  EXPECT_LE(brightest, 65535U);
}

TEST(DataJson, ParametersStandWithinTheirSliders) {
  for (const bool isotropic : {false, true}) {
    Material material = test::MakeMaterial(3, isotropic);
    material.parameters[0].values = {0.004};  // narrower than the slider usually reaches
    const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0.01, isotropic);
    const PageJson json = DataOf(material, measurement);
    const std::vector<Parameter> parameters = Parameters(material.model);
    ASSERT_EQ(json["parameters"].size(), parameters.size());
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const PageJson& slider = json["parameters"][p];
      const double factor = parameters[p].unit == "deg" ? 180 / kPi : 1;
      ASSERT_EQ(slider["values"].size(), material.parameters[p].values.size());
      for (std::size_t c = 0; c < slider["values"].size(); ++c) {
        const double value = slider["values"][c].get<double>();
        EXPECT_NEAR(value, material.parameters[p].values[c] * factor, 1e-9);
        EXPECT_TRUE(slider["low"].get<double>() <= value && value <= slider["high"].get<double>())
            << parameters[p].name;
      }
      EXPECT_TRUE(!slider["log"].get<bool>() || slider["low"].get<double>() > 0) << parameters[p].name;
    }
  }
}

TEST(DataJson, NamesOfChannelsAreText) {
  Material material = test::MakeMaterial(1, true);
  Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, true);
  const std::string name = "</script><b>\"\\\xff\x01";
  material.channels = measurement.channels.names = {name};
  const PageJson json = DataOf(material, measurement);
  EXPECT_EQ(json["channels"][0].get<std::string>().substr(0, 14), name.substr(0, 14));
}

TEST(PolicyHash, IsThatOfTheStandard) {
  EXPECT_EQ(PolicyHash(""), "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
}

TEST(FillTemplate, FaultsOfATemplateAreFaultsOfTheProgram) {
  EXPECT_THROW(FillTemplate("a {{name", {{"name", "x"}}, {}), std::logic_error);
  EXPECT_THROW(FillTemplate("{{#part}}a", {}, {{"part", true}}), std::logic_error);
  EXPECT_THROW(FillTemplate("{{#part}}a{{/part}}", {}, {}), std::logic_error);
  EXPECT_EQ(FillTemplate("{{#part}}{{gone}}{{/part}}b", {}, {{"part", false}}), "b")
      << "what is left out needs no value";
}

}  // namespace
}  // namespace lobefit

#include "lobefit/measurement/spectrum.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

Channels Wavelengths(double first, double last, double step) {
  Channels channels;
  for (double nm = first; nm <= last + 1e-9; nm += step) {
    channels.wavelengths_nm.push_back(nm);
    channels.names.push_back(std::to_string(static_cast<int>(nm)) + "nm");
  }
  return channels;
}

std::vector<double> Mapped(const ChannelMap& map, const std::vector<double>& values) {
  std::vector<double> result;
  for (const std::vector<double>& row : map.matrix) {
    double sum = 0;
    for (std::size_t k = 0; k < row.size(); ++k) sum += row[k] * values[k];
    result.push_back(sum);
  }
  return result;
}

// The white point of D65 under the 2-degree observer: x = 0.3127, y = 0.3290.
TEST(WeightedMatching, GivesTheWhitePointOfD65) {
  double sum[3] = {};
  for (int nm = 380; nm <= 780; ++nm) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += WeightedMatching(nm)[c];
  }
  EXPECT_NEAR(sum[1], 1, 1e-12);
  EXPECT_NEAR(sum[0] / (sum[0] + sum[1] + sum[2]), 0.3127, 2e-4);
  EXPECT_NEAR(sum[1] / (sum[0] + sum[1] + sum[2]), 0.3290, 2e-4);
}

TEST(MakeChannelMap, WhiteIsWhiteWhateverTheWavelengths) {
  for (const double step : {4.0, 10.0, 31.0, 110.0}) {
    const Channels channels = Wavelengths(400, 730, step);
    const std::vector<double> rgb = Mapped(MakeChannelMap("rgb", channels), std::vector<double>(channels.size(), 0.7));
    for (const double value : rgb) EXPECT_NEAR(value, 0.7, 1e-12);
    EXPECT_NEAR(Mapped(MakeChannelMap("luminance", channels), std::vector<double>(channels.size(), 0.7))[0], 0.7,
                1e-12);
  }
}

TEST(MakeChannelMap, SpectraHaveTheColourOfTheirBand) {
  const Channels channels = Wavelengths(400, 700, 10);
  const ChannelMap map = MakeChannelMap("rgb", channels);
  const auto band = [&](double low, double high) {
    std::vector<double> values;
    for (const double nm : channels.wavelengths_nm) values.push_back(nm >= low && nm <= high ? 1 : 0);
    return Mapped(map, values);
  };
  const std::vector<double> red = band(610, 700), green = band(520, 560), blue = band(430, 480);
  EXPECT_GT(red[0], 3 * std::fabs(red[1]));
  EXPECT_GT(green[1], 3 * std::fabs(green[0]));
  EXPECT_GT(blue[2], 3 * std::fabs(blue[1]));
  // Linear: the whole is the sum of its parts.
  const std::vector<double> low = band(400, 500), high = band(510, 700);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(low[c] + high[c], 1, 1e-12);
}

TEST(MakeChannelMap, ASpectrumOfRgbHasTheseRgb) {
  const Channels rgb = {{"R", "G", "B"}, {}};
  const ChannelMap to_spectrum = MakeChannelMap("spectrum", rgb);
  const ChannelMap back = MakeChannelMap("rgb", to_spectrum.channels);
  for (const std::vector<double>& colour : {std::vector<double>{0.8, 0.5, 0.2}, {0.1, 0.1, 0.1}, {0.2, 0.6, 0.9}}) {
    const std::vector<double> again = Mapped(back, Mapped(to_spectrum, colour));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(again[c], colour[c], 1e-12);
  }
  for (const double value : Mapped(to_spectrum, {0.4, 0.4, 0.4})) EXPECT_NEAR(value, 0.4, 1e-12);
}

TEST(MakeChannelMap, ListsNamesWavelengthsAndRanges) {
  const Channels channels = Wavelengths(400, 700, 50);
  EXPECT_EQ(MakeChannelMap("550", channels).channels.names, (std::vector<std::string>{"550nm"}));
  EXPECT_EQ(MakeChannelMap("600nm,400", channels).channels.wavelengths_nm, (std::vector<double>{600, 400}));
  EXPECT_EQ(MakeChannelMap("450:550", channels).channels.wavelengths_nm, (std::vector<double>{450, 500, 550}));
  EXPECT_EQ(MakeChannelMap("all", channels).channels.names, channels.names);
  EXPECT_EQ(MakeChannelMap("b,R", {{"R", "G", "B"}, {}}).channels.names, (std::vector<std::string>{"B", "R"}));
  EXPECT_EQ(MakeChannelMap("450:550,500", channels).channels.wavelengths_nm, (std::vector<double>{450, 500, 550}));
  EXPECT_THROW(MakeChannelMap("nonsense", channels), UsageError);
  EXPECT_THROW(MakeChannelMap("550,400,550nm", channels), UsageError);
  EXPECT_THROW(MakeChannelMap("r,R", {{"R", "G", "B"}, {}}), UsageError);
  EXPECT_THROW(MakeChannelMap("rgb", {{"Y"}, {}}), UsageError);
  EXPECT_THROW(MakeChannelMap("rgb", Wavelengths(500, 700, 50)), UsageError);
}

TEST(Apply, ChangesMeasurementsAndFunctionsAlike) {
  MeasurementBuilder builder({{"X", "Y", "Z"}, {}});
  const double values[3] = {0.3, 0.4, 0.5};
  builder.Add({0, 0, 1}, {0.6, 0, 0.8}, values, 1);
  Measurement m = builder.Finish();
  const ChannelMap map = MakeChannelMap("rgb", m.channels);
  const BrdfFunction function = Apply(
      map,
      [&](const Vec3&, const Vec3&, double* out) {
        for (int c = 0; c < 3; ++c) out[c] = values[c];
      },
      3);
  Apply(map, &m);
  double mapped[3];
  function({0, 0, 1}, {0, 0, 1}, mapped);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(m.samples.values[c][0], mapped[c]);
  const std::array<double, 3> back = XyzFromSrgb({mapped[0], mapped[1], mapped[2]});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], values[c], 1e-6);
  EXPECT_EQ(m.conventions.at("channels"), "R G B from X Y Z (sRGB primaries)");
}

}  // namespace
}  // namespace lobefit

#include "lobefit/report/web/data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "lobefit/base/text/base64.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::size_t, 3> kTable = {90, 45, 8};  // sqrt(theta_h), theta_d, phi_d
constexpr std::size_t kMostSliceValues = 40000;
constexpr std::size_t kMostPointsOfASlice = 240;

// The number of `digits` significant digits that is nearest, so that its text is short; null where it is not finite.
Json Rounded(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  std::from_chars(text.data(), end.ptr, value);
  return value;
}

Json Hundredths(double radians) { return Rounded(std::round(RadiansToDegrees(radians) * 100) / 100, 6); }

template <class Items, class F>
Json List(const Items& items, const F& json) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(json(item));
  return list;
}

// The measured values for the sphere: 16-bit logarithms of linear red, green, blue; 0: not known.
Json TableJson(const ReportData& data, const ChannelColor& to_color) {
  const IsotropicLookup& lookup = data.lookup();
  const std::size_t width = kTable[0], height = kTable[1], depth = kTable[2], texels = width * height * depth;
  std::vector<std::array<double, 3>> colors(texels, {std::nan(""), 0, 0});
  double high = 0;
  std::vector<double> f_r(data.channels());
  std::size_t known = 0;
  for (std::size_t i = 0; i < texels; ++i) {
    const std::size_t column = i % width, row = i / width % height, slab = i / (width * height);
    const auto share = [](std::size_t at, std::size_t count) {
      return static_cast<double>(at) / static_cast<double>(count - 1);
    };
    const double h = share(column, width), d = share(row, height), p = share(slab, depth);
    Vec3 wi, wo;
    FromHalfDifference({h * h * kPi / 2, 0, d * kPi / 2, p * kPi / 2}, &wi, &wo);
    if (!lookup.Find(wi, wo, f_r.data())) continue;
    colors[i] = to_color.Linear(f_r.data());
    for (const double v : colors[i]) high = std::max(high, v);
    ++known;
  }
  if (known == 0 || !(high > 0)) return nullptr;
  const double top = std::log(high), bottom = top - std::log(1e7);
  std::string bytes;
  for (const std::array<double, 3>& color : colors) {
    for (const double v : color) {
      const double t = v > 0 ? std::clamp((std::log(v) - bottom) / (top - bottom), 0.0, 1.0) : 0;
      const auto q = static_cast<std::uint16_t>(std::isnan(color[0]) ? 0 : 1 + std::lround(65534 * t));
      bytes.push_back(static_cast<char>(q & 255U));
      bytes.push_back(static_cast<char>(q >> 8U));
    }
  }
  return {{"size", kTable}, {"low", Rounded(bottom, 6)}, {"high", Rounded(top, 6)}, {"data", Base64(bytes)}};
}

// The page evaluates the surface: measured values stand beside it without what the instrument makes of it, surface over
// reading at the fit.
double SurfaceOverReading(const ReportData& data, std::size_t channel, std::size_t sample) {
  if (!data.reading) return 1;
  std::vector<double> surface(data.channels());
  data.fitted.Evaluate(data.measurement.samples.wi(sample), data.measurement.samples.wo(sample), surface.data());
  const double ratio = surface[channel] / static_cast<double>(data.fitted_values[channel][sample]);
  return std::isfinite(ratio) ? ratio : 1;
}

Json SlicesJson(const ReportData& data) {
  const Slices& slices = data.slices();
  std::size_t total = 0;
  for (const Slice& slice : slices.slices)
    total += std::min(slice.points.size(), kMostPointsOfASlice) * data.shown_channels.size();
  // Every second, third, ... slice of a table rather than a page that loads slowly.
  const std::size_t step = 1 + total / kMostSliceValues;
  Json list = Json::array();
  for (std::size_t k = 0; k < slices.slices.size(); k += step) {
    const Slice& slice = slices.slices[k];
    std::vector<SlicePoint> points;
    const std::size_t stride = 1 + (slice.points.size() - 1) / kMostPointsOfASlice;
    for (std::size_t i = 0; i < slice.points.size(); i += stride) points.push_back(slice.points[i]);
    const auto values = [&](const auto& value) {
      return List(data.shown_channels, [&](std::size_t c) {
        return List(points, [&](const SlicePoint& p) { return Rounded(value(c, p.sample), 4); });
      });
    };
    list.push_back({{"theta", Hundredths(slice.theta)},
                    {"phi", Hundredths(slice.phi)},
                    {"x", List(points, [](const SlicePoint& p) { return Hundredths(p.theta); })},
                    {"y", values([&](std::size_t c, std::size_t i) {
                       return data.measurement.samples.values[c][i] * SurfaceOverReading(data, c, i);
                     })},
                    // What the fit says at the same places, for browsers that cannot evaluate it.
                    {"f", values([&](std::size_t c, std::size_t i) {
                       return static_cast<double>(data.fitted_values[c][i]) * SurfaceOverReading(data, c, i);
                     })}});
  }
  return {{"outgoing", slices.outgoing_stays}, {"list", list}};
}

std::string HexColor(Rgb c) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c.r, c.g, c.b);
  return text.data();
}

Json ParametersJson(const ReportData& data) {
  const std::vector<Parameter> parameters = Parameters(data.material.model);
  Json list = Json::array();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    const double factor = 1 / InsideFactor(parameter);
    const std::vector<double>& values = data.material.parameters[p].values;
    const double most = *std::max_element(values.begin(), values.end());
    double low = parameter.low * factor, high = parameter.high * factor;
    bool logarithmic = false;
    if (parameter.name.find("alpha") != std::string::npos)
      low = std::min(0.01, *std::min_element(values.begin(), values.end())), logarithmic = true;
    if (parameter.name.ends_with("eta") || parameter.name.ends_with("k"))
      high = std::min(high, std::max(6.0, 2 * most));
    if (parameter.name.find("scale") != std::string::npos) high = std::max(1.0, 4 * most);
    if (parameter.group == ParameterGroup::kDiffuse && !parameter.shared) high = std::max(1.0, 1.5 * most);
    const bool is_shape = parameter.group == ParameterGroup::kShape;
    if (is_shape && parameter.low < 0 && parameter.unit == "1") high = std::min(high, std::max(4.0, 1.5 * most));
    if (parameter.name.ends_with("gamma") || parameter.name == "g" || parameter.name.ends_with(".g"))
      logarithmic = true;
    list.push_back({{"name", parameter.name},
                    {"symbol", Symbol(parameter)},
                    {"lobe", LobeOf(parameter)},
                    {"unit", parameter.unit},
                    {"low", Rounded(low, 6)},
                    {"high", Rounded(high, 6)},
                    {"log", logarithmic},
                    {"free", data.material.parameters[p].free},
                    {"values", List(values, [factor](double v) { return Rounded(v * factor, 12); })}});
  }
  return list;
}

// A profile's spline: for each piece its left end in u, and for each power the coefficient of each number of the fit.
Json SplineJson(const Lobe& lobe) {
  if (FamilyOf(lobe.ndf) != Family::kProfile) return nullptr;
  const ProfileSpline& spline = *GridOf(lobe)->spline();
  Json left = Json::array(), coefficients = Json::array();
  for (std::size_t i = 0; i < spline.intervals(); ++i) {
    left.push_back(spline.Left(i));
    Json powers = Json::array();
    for (std::size_t p = 0; p < 4; ++p) {
      const double* row = spline.Coefficients(i) + p * spline.size();
      powers.push_back(List(std::vector<double>(row, row + spline.size()), [](double c) { return Rounded(c, 12); }));
    }
    coefficients.push_back(powers);
  }
  return {{"left", left}, {"coefficients", coefficients}};
}

int DiffuseNumber(Diffuse diffuse) {
  switch (diffuse) {
    case Diffuse::kLambert:
      return 1;
    case Diffuse::kMicrofacet:
      return 2;
    case Diffuse::kInterfaced:
      return 3;
    case Diffuse::kOrenNayar:
      return 4;
    case Diffuse::kNone:
      break;
  }
  return 0;
}

Json LobesJson(const Model& model) {
  Json lobes = Json::array();
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Lobe& lobe = model.lobes[l];
    const Family family = FamilyOf(lobe.ndf);
    lobes.push_back({{"family", family == Family::kAbg        ? 2
                                : family == Family::kBeckmann ? 1
                                                              : 0},
                     {"round", IsRound(lobe.ndf)},
                     {"retro", lobe.direction == LobeDirection::kRetro},
                     {"shapeParameters", ShapeParameters(lobe)},
                     {"spline", SplineJson(lobe)},
                     {"masking", NameOf(MaskingChoices(), lobe.masking)},
                     {"fresnel", NameOf(FresnelChoices(), lobe.fresnel)},
                     {"first", FirstParameter(model, l)},
                     {"fresnelParameters", FresnelParameters(lobe.fresnel)}});
  }
  return lobes;
}

}  // namespace

std::string DataJson(const ReportData& data) {
  const ChannelColor to_color(data.measurement.channels);
  const Model& model = data.material.model;
  const auto darker = [](Rgb c) {
    const auto mute = [](int v) { return static_cast<std::uint8_t>(v * 7 / 10); };
    return Rgb{mute(c.r), mute(c.g), mute(c.b)};
  };
  Json rgb = Json::array();
  for (std::size_t c = 0; c < data.channels(); ++c) {
    std::vector<double> unit(data.channels());
    unit[c] = 1;
    rgb.push_back(List(to_color.Linear(unit.data()), [](double v) { return Rounded(v, 12); }));
  }
  const Json json = {
      {"channels", data.channel_names},
      {"colors", List(data.channel_colors, HexColor)},
      {"dark", List(data.channel_colors, [&](Rgb c) { return HexColor(darker(c)); })},
      {"shown", data.shown_channels},
      {"rgb", rgb},
      {"model", {{"diffuse", DiffuseNumber(model.diffuse)}, {"lobes", LobesJson(model)}}},
      {"parameters", ParametersJson(data)},
      {"slices", SlicesJson(data)},
      {"table", data.measurement.isotropic ? TableJson(data, to_color) : Json(nullptr)},
      {"exposure",
       Rounded(SphereExposure(LightSphere(Shown(data.fitted), to_color, data.channels(), LitRows(128))), 12)}};
  // Within a <script> element only '<' could end it; JSON has it in strings alone.
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace), safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

}  // namespace lobefit

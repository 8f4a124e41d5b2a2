#include "lobefit/report/web/data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "lobefit/base/base64.h"
#include "lobefit/base/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"
#include "lobefit/report/figures/isotropic_lookup.h"
#include "lobefit/report/figures/sphere.h"
#include "lobefit/report/web/text.h"

namespace lobefit {
namespace {

constexpr std::array<std::size_t, 3> kTable = {90, 45, 8};  // sqrt(theta_h), theta_d, phi_d
constexpr std::size_t kMostSliceValues = 40000;
constexpr std::size_t kMostPointsOfASlice = 240;
constexpr int kReferenceSize = 40;

template <class Items, class F>
std::string JsonList(const Items& items, const F& text) {
  std::vector<std::string> list;
  list.reserve(items.size());
  for (const auto& item : items) list.push_back(text(item));
  return Join({"[", Join(list, ","), "]"}, "");
}

// The measured values for the sphere: 16-bit logarithms of linear red, green, blue; 0: not known.
std::string TableJson(const ReportData& data, const ChannelColor& to_color) {
  const IsotropicLookup lookup(data.measurement);
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
  if (known == 0 || !(high > 0)) return "null";
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
  return Join({"{\"size\":", JsonList(kTable, [](std::size_t n) { return std::to_string(n); }),
               ",\"low\":", JsonNumber(bottom), ",\"high\":", JsonNumber(top), ",\"data\":\"", Base64(bytes), "\"}"},
              "");
}

std::string SlicesJson(const ReportData& data) {
  const Slices slices = GatherSlices(data.measurement, data.staying);
  std::size_t total = 0;
  for (const Slice& slice : slices.slices)
    total += std::min(slice.points.size(), kMostPointsOfASlice) * data.shown_channels.size();
  // Every second, third, ... slice of a table rather than a page that loads slowly.
  const std::size_t step = 1 + total / kMostSliceValues;
  std::vector<std::string> list;
  for (std::size_t k = 0; k < slices.slices.size(); k += step) {
    const Slice& slice = slices.slices[k];
    std::vector<SlicePoint> points;
    const std::size_t stride = 1 + (slice.points.size() - 1) / kMostPointsOfASlice;
    for (std::size_t i = 0; i < slice.points.size(); i += stride) points.push_back(slice.points[i]);
    const auto hundredths = [](double radians) {
      return JsonNumber(std::round(RadiansToDegrees(radians) * 100) / 100);
    };
    const std::string y = JsonList(data.shown_channels, [&](std::size_t c) {
      return JsonList(points,
                      [&](const SlicePoint& p) { return JsonNumber(data.measurement.samples.values[c][p.sample], 4); });
    });
    // What the fit says at the same places, for browsers that cannot evaluate it.
    const std::string f = JsonList(data.shown_channels, [&](std::size_t c) {
      return JsonList(points, [&](const SlicePoint& p) {
        return JsonNumber(static_cast<double>(data.fitted_values[c][p.sample]), 4);
      });
    });
    const std::string x = JsonList(points, [&](const SlicePoint& p) { return hundredths(p.theta); });
    list.push_back(Join({"{\"theta\":", hundredths(slice.theta), ",\"phi\":", hundredths(slice.phi), ",\"x\":", x,
                         ",\"y\":", y, ",\"f\":", f, "}"},
                        ""));
  }
  return Join({"{\"outgoing\":", slices.outgoing_stays ? "true" : "false", ",\"list\":[", Join(list, ","), "]}"}, "");
}

std::string HexColor(Rgb c) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c.r, c.g, c.b);
  return text.data();
}

// "α_x" with markup as HTML.
std::string HtmlSymbol(const Parameter& parameter) {
  std::string symbol = Symbol(parameter);
  const std::size_t at = symbol.find('_');
  if (at != std::string::npos) symbol = Join({symbol.substr(0, at), "<sub>", symbol.substr(at + 1), "</sub>"}, "");
  if (LobeOf(parameter) > 0) symbol += Join({" (", std::to_string(LobeOf(parameter) + 1), ")"}, "");
  return symbol;
}

std::string ParametersJson(const ReportData& data) {
  const std::vector<Parameter> parameters = Parameters(data.material.model);
  std::vector<std::string> list;
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
    if (parameter.group == ParameterGroup::kDiffuse) high = std::max(1.0, 1.5 * most);
    list.push_back(Join(
        {"{\"name\":", JsonString(parameter.name), ",\"label\":", JsonString(HtmlSymbol(parameter)),
         ",\"unit\":", JsonString(parameter.unit), ",\"low\":", JsonNumber(low), ",\"high\":", JsonNumber(high),
         ",\"log\":", logarithmic ? "true" : "false", ",\"free\":", data.material.parameters[p].free ? "true" : "false",
         ",\"values\":", JsonList(values, [factor](double v) { return JsonNumber(v * factor, 12); }), "}"},
        ""));
  }
  return Join({"[", Join(list, ","), "]"}, "");
}

// f_r of the program at a few directions, for the page's test of itself.
std::string CheckJson(const ReportData& data) {
  std::vector<std::string> rows;
  std::vector<double> f_r(data.channels());
  for (int k = 0; k < 24; ++k) {
    const Vec3 wi = FromSpherical(0.06 * k, 1.1 * k), wo = FromSpherical(1.4 - 0.055 * k, 2.3 * k + 1);
    data.fitted.Evaluate(wi, wo, f_r.data());
    const auto vector = [](const Vec3& w) {
      return JsonList(std::array{w.x, w.y, w.z}, [](double v) { return JsonNumber(v, 17); });
    };
    rows.push_back(Join(
        {"[", vector(wi), ",", vector(wo), ",", JsonList(f_r, [](double v) { return JsonNumber(v, 12); }), "]"}, ""));
  }
  return Join({"[", Join(rows, ","), "]"}, "");
}

}  // namespace

std::string DataJson(const ReportData& data) {
  const ChannelColor to_color(data.measurement.channels);
  const Model& model = data.material.model;
  const LitSphere reference = LightFitted(data, to_color, kReferenceSize);
  const double exposure = SphereExposure(LightFitted(data, to_color, 128));
  std::string bytes;
  for (const auto& color : reference.color) {
    const Rgb c = ToScreen(color, exposure);
    for (const std::uint8_t v : {c.r, c.g, c.b}) bytes.push_back(static_cast<char>(v));
  }
  const auto darker = [](Rgb c) {
    const auto mute = [](int v) { return static_cast<std::uint8_t>(v * 7 / 10); };
    return Rgb{mute(c.r), mute(c.g), mute(c.b)};
  };
  std::vector<std::array<double, 3>> rgb;
  for (std::size_t c = 0; c < data.channels(); ++c) {
    std::vector<double> unit(data.channels());
    unit[c] = 1;
    rgb.push_back(to_color.Linear(unit.data()));
  }
  const auto number = [](double v) { return JsonNumber(v, 12); };
  std::vector<std::string> lobes;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Lobe& lobe = model.lobes[l];
    lobes.push_back(Join({"{\"family\":", FamilyOf(lobe.ndf) == NdfFamily::kBeckmann ? "1" : "0",
                          ",\"round\":", IsRound(lobe.ndf) ? "true" : "false",
                          ",\"masking\":", JsonString(NameOf(MaskingChoices(), lobe.masking)),
                          ",\"fresnel\":", JsonString(NameOf(FresnelChoices(), lobe.fresnel)),
                          ",\"first\":", std::to_string(FirstParameter(model, l)),
                          ",\"fresnelParameters\":", std::to_string(FresnelParameters(lobe.fresnel)), "}"},
                         ""));
  }
  const char* diffuse = model.diffuse == Diffuse::kNone ? "0" : model.diffuse == Diffuse::kLambert ? "1" : "2";
  return Join({"{\"channels\":",
               JsonList(data.channel_names, [](const std::string& s) { return JsonString(s); }),
               ",\"colors\":",
               JsonList(data.channel_colors, [](Rgb c) { return JsonString(HexColor(c)); }),
               ",\"dark\":",
               JsonList(data.channel_colors, [&](Rgb c) { return JsonString(HexColor(darker(c))); }),
               ",\"shown\":",
               JsonList(data.shown_channels, [](std::size_t c) { return std::to_string(c); }),
               ",\"rgb\":",
               JsonList(rgb, [&](const std::array<double, 3>& color) { return JsonList(color, number); }),
               ",\"model\":{\"diffuse\":",
               diffuse,
               ",\"lobes\":[",
               Join(lobes, ","),
               "]},\"parameters\":",
               ParametersJson(data),
               ",\"slices\":",
               SlicesJson(data),
               ",\"table\":",
               data.measurement.isotropic ? TableJson(data, to_color) : "null",
               ",\"exposure\":",
               number(exposure),
               ",\"reference\":{\"size\":",
               std::to_string(kReferenceSize),
               ",\"data\":\"",
               Base64(bytes),
               "\"},\"check\":",
               CheckJson(data),
               "}"},
              "");
}

}  // namespace lobefit

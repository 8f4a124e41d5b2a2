#include "lobefit/plot/style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace style {

TextStyle Body(Rgb color, Align align) { return {.size = kBodySize, .color = color, .align = align}; }
TextStyle Note(Rgb color, Align align) { return {.size = kNoteSize, .color = color, .align = align}; }
TextStyle Tick(Align align) {
  return {.size = kTickSize, .color = kSecondary, .align = align, .baseline = Baseline::kMiddle, .markup = true};
}

}  // namespace style

namespace {

template <std::size_t N>
Rgb Interpolate(const std::array<Rgb, N>& stops, double t) {
  if (!std::isfinite(t)) return style::kRule;
  const double at = std::clamp(t, 0.0, 1.0) * (N - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(at), N - 2);
  const double f = at - static_cast<double>(i);
  const auto mix = [f](int a, int b) { return static_cast<std::uint8_t>(std::lround(a + f * (b - a))); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g), mix(stops[i].b, stops[i + 1].b)};
}

std::string Fixed(double value, int decimals) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  std::string result = text.data();
  // "-0.00" is zero.
  if (result.find_first_of("123456789") == std::string::npos && result[0] == '-') result.erase(0, 1);
  if (result[0] == '-') result.replace(0, 1, "−");
  return result;
}

}  // namespace

std::vector<Rgb> ChannelColors(const std::vector<std::string>& names) {
  const std::array<Rgb, 3> rgb = {style::kVermilion, style::kGreen, style::kBlue};
  std::vector<Rgb> colors;
  if (names.size() == 1) return {style::kBlue};
  if (names.size() == 3) return {rgb.begin(), rgb.end()};
  if (names.size() == 2) return {style::kBlue, style::kVermilion};
  // Many channels are ordered wavelengths: blue over green to vermilion.
  const std::array<Rgb, 5> spectrum = {{{68, 56, 148}, {0, 103, 168}, {0, 140, 104}, {196, 150, 0}, {200, 70, 10}}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    colors.push_back(Interpolate(spectrum, static_cast<double>(i) / static_cast<double>(names.size() - 1)));
  }
  return colors;
}

Rgb SequentialColor(double t) {
  static const std::array<Rgb, 7> stops = {
      {{16, 20, 44}, {36, 49, 104}, {35, 92, 138}, {40, 134, 142}, {92, 175, 124}, {180, 208, 104}, {252, 240, 176}}};
  return Interpolate(stops, t);
}

Rgb DivergingColor(double t) {
  static const std::array<Rgb, 7> stops = {
      {{14, 60, 122}, {54, 120, 184}, {152, 192, 222}, {247, 247, 246}, {246, 190, 130}, {221, 118, 30}, {140, 58, 4}}};
  return Interpolate(stops, t);
}

std::string Number(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value == 0) return "0";
  // The exponent after rounding: 0.09996 to three digits is 0.100.
  const double rounded =
      std::round(std::fabs(value) / std::pow(10, std::floor(std::log10(std::fabs(value))) - digits + 1));
  int exponent = static_cast<int>(std::floor(std::log10(std::fabs(value))));
  if (rounded >= std::pow(10, digits)) ++exponent;
  if (exponent < -4 || exponent > std::max(digits, 5)) {
    return Fixed(value / std::pow(10, exponent), digits - 1) + "·10^{" + Fixed(exponent, 0) + "}";
  }
  return Fixed(value, std::max(0, digits - 1 - exponent));
}

std::string Degrees(double radians) {
  double tenths = std::round(RadiansToDegrees(radians) * 10);
  if (tenths == -1800) tenths = 1800;
  return Fixed(tenths / 10, std::fmod(tenths, 10) == 0 ? 0 : 1) + "°";
}

std::string RatioText(double ratio) {
  const auto short_number = [](double value) {
    std::string text = Number(value, 2);
    if (text.size() > 2 && text.substr(text.size() - 2) == ".0") text.resize(text.size() - 2);
    return text;
  };
  if (ratio >= 1.9) return Join({"×", short_number(ratio)}, "");
  if (ratio > 1) return Join({"+", short_number(100 * (ratio - 1)), "%"}, "");
  if (ratio == 1) return "1";
  if (ratio > 1 / 1.9) return Join({"−", short_number(100 * (1 - ratio)), "%"}, "");
  return Join({"÷", short_number(1 / ratio)}, "");
}

std::string Count(std::size_t value) {
  std::string digits = std::to_string(value), result;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) result += "\u2009";
    result += digits[i];
  }
  return result;
}

ValueWithError RoundToError(double value, double error) {
  if (!std::isfinite(error) || error <= 0) return {Number(value, 5), ""};
  const int place = static_cast<int>(std::floor(std::log10(error)));
  // 0.0996 to two digits is 0.10: one place less.
  const int last = std::round(error / std::pow(10, place - 1)) >= 100 ? place : place - 1;
  const int decimals = std::clamp(-last, 0, 9);
  if (decimals == 9 || std::fabs(value) >= 1e6) return {Number(value, 6), Number(error, 2)};
  return {Fixed(value, decimals), Fixed(error, decimals)};
}

}  // namespace lobefit

// Colours, sizes and number formats that every figure shares.
#pragma once

#include <string>
#include <vector>

#include "lobefit/plot/canvas.h"

namespace lobefit::style {

inline constexpr Rgb kInk = {27, 31, 36};
inline constexpr Rgb kSecondary = {91, 101, 112};
inline constexpr Rgb kFaint = {150, 158, 167};
inline constexpr Rgb kRule = {208, 213, 219};
inline constexpr Rgb kGrid = {233, 236, 239};
inline constexpr Rgb kShade = {246, 247, 249};
// Okabe and Ito's colours, which readers with any colour vision tell apart.
inline constexpr Rgb kVermilion = {213, 94, 0};
inline constexpr Rgb kGreen = {0, 140, 104};
inline constexpr Rgb kBlue = {0, 103, 168};
inline constexpr Rgb kOrange = {214, 143, 0};
inline constexpr Rgb kPurple = {178, 92, 143};
inline constexpr Rgb kWarning = {166, 66, 0};
inline constexpr Rgb kAmber = {138, 90, 0};  // white text stands out from it by 5.9 to 1
inline constexpr Rgb kRed = {176, 30, 30};
inline constexpr Rgb kWarningShade = {253, 243, 233};

// Sizes in page units; the smallest stays legible at half scale.
inline constexpr double kTitleSize = 23, kPanelTitleSize = 14.5, kBodySize = 12, kTickSize = 11, kNoteSize = 11;

TextStyle Body(Rgb color = kInk, Align align = Align::kLeft);
TextStyle Note(Rgb color = kSecondary, Align align = Align::kLeft);
TextStyle Tick(Align align);

}  // namespace lobefit::style

namespace lobefit {

// The colour of each of `count` curves or channels.
std::vector<Rgb> ChannelColors(const std::vector<std::string>& names);

// Colour maps from 0 to 1. Sequential: dark to light, monotone in luminance. Diverging: blue over near-white (0.5) to
// orange.
Rgb SequentialColor(double t);
Rgb DivergingColor(double t);

// At most `digits` significant digits, a plain decimal where that is short, else "1.2e-5" as "1.2·10^{-5}" (markup); a
// real minus sign.
std::string Number(double value, int digits = 3);
// An angle in radians as degrees with at most one decimal: "30°", "2.5°".
std::string Degrees(double radians);
// A ratio: "+20%", "−17%" near 1, else "×3", "÷3".
std::string RatioText(double ratio);
// 1 234 567 with thin gaps.
std::string Count(std::size_t value);
// A value rounded to where its error has two digits, and that error: {"0.1834", "0.0012"}. Error NaN or 0: six digits
// and "".
struct ValueWithError {
  std::string value, error;
};
ValueWithError RoundToError(double value, double error);

}  // namespace lobefit

// Symbols and text blocks that tables share.
#pragma once

#include <string>

#include "lobefit/core/brdf/model.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {

// "alpha_x" as it is written in a formula (markup), without the prefix of its lobe: "α_x".
std::string Symbol(const Parameter& parameter);
// 0 for "alpha_x", 1 for "lobe2.alpha_x".
std::size_t LobeOf(const Parameter& parameter);

// A small heading; returns the y below it.
double DrawHeading(Canvas* canvas, double x, double y, const std::string& text);
inline constexpr double kLineHeight = 19;

}  // namespace lobefit

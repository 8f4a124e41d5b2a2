// How a stored pixel becomes a value proportional to radiance.
#pragma once

#include <string>

namespace lobefit {

struct Response {
  enum class Curve { kUnknown, kLinear, kSrgb, kGamma };
  Curve curve = Curve::kUnknown;
  double gamma = 1;
  double black = 0;           // of the stored range [0, 1], subtracted before the curve
  double saturation = 0.999;  // of the stored range; a pixel at or above it is no value. Integer formats only
};

// "linear", "srgb" or "gamma:2.2". Throws InputError with `place` in front.
void ReadEncoding(const std::string& text, const std::string& place, Response* response);
// The same word back.
std::string EncodingWord(const Response& response);

// Linear value of a stored one, both with white at 1; the black level is subtracted first.
double Linear(const Response& response, double stored);
// Stored value of a linear one, without the black level.
double Stored(const Response& response, double linear);

}  // namespace lobefit

#include "lobefit/maps/stack/response.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

void ReadEncoding(const std::string& text, const std::string& place, Response* response) {
  using Curve = Response::Curve;
  response->gamma = 1;
  if (text == "linear") {
    response->curve = Curve::kLinear;
  } else if (text == "srgb") {
    response->curve = Curve::kSrgb;
  } else {
    const std::optional<double> gamma =
        text.rfind("gamma:", 0) == 0 ? ParseDouble(std::string_view(text).substr(6)) : std::nullopt;
    if (!gamma || !(*gamma >= 0.1 && *gamma <= 10)) {
      throw InputError(fmt::format("{}: encoding '{}' is unknown; allowed: linear, srgb, gamma:G with G in 0.1 to 10",
                                   place, Excerpt(text)));
    }
    response->curve = Curve::kGamma;
    response->gamma = *gamma;
  }
}

std::string EncodingWord(const Response& response) {
  switch (response.curve) {
    case Response::Curve::kLinear:
      return "linear";
    case Response::Curve::kSrgb:
      return "srgb";
    case Response::Curve::kGamma:
      return "gamma:" + FormatDouble(response.gamma);
    case Response::Curve::kUnknown:
      break;
  }
  return "unknown";
}

double Linear(const Response& response, double stored) {
  const double v = stored - response.black;
  switch (response.curve) {
    case Response::Curve::kSrgb:
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    case Response::Curve::kGamma:
      return v <= 0 ? 0 : std::pow(v, response.gamma);
    default:
      return v;
  }
}

double Stored(const Response& response, double linear) {
  switch (response.curve) {
    case Response::Curve::kSrgb:
      return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    case Response::Curve::kGamma:
      return linear <= 0 ? 0 : std::pow(linear, 1 / response.gamma);
    default:
      return linear;
  }
}

}  // namespace lobefit

#include "lobefit/measurement/prepare/selection.h"

#include <cmath>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Half the finest step of the goniometers in use: a slice is chosen by a rounded angle.
constexpr double kSlack = 0.05 * kPi / 180;

// The angle's turn that begins at `start`.
double InTurn(double phi, double start) {
  constexpr double kTurn = 2 * kPi;
  const double offset = phi - start;
  return start + offset - kTurn * std::floor(offset / kTurn);
}

bool AzimuthInRange(double phi, const AngleRange& range) {
  const bool from = std::isfinite(range.low), to = std::isfinite(range.high);
  if (!from && !to) return true;
  if (from && to) return InTurn(phi, range.low - kSlack) <= range.high + kSlack;
  // The bounds of the turn belong to it as they are written: 0 and not 360, -180 below and 180 above an angle.
  if (from) return InTurn(phi, range.low < 0 ? kSlack - kPi : -kSlack) >= range.low - kSlack;
  return InTurn(phi, range.high < 0 ? -kPi - kSlack : -kSlack) <= range.high + kSlack;
}

double ParseBound(std::string_view text, double missing, const std::string& whole, const std::string& option) {
  if (Trim(text).empty()) return missing;
  const std::optional<double> degrees = ParseDouble(text);
  if (!degrees || !std::isfinite(*degrees)) {
    throw UsageError(option + " " + whole + ": '" + Excerpt(text) +
                     "' is not a number; write LOW:HIGH or one value, in degrees, as in 30:60");
  }
  return DegreesToRadians(*degrees);
}

}  // namespace

AngleRange ParseAngleRange(const std::string& text, const std::string& option) {
  const std::size_t colon = text.find(':');
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (colon == std::string::npos) {
    const double angle = ParseBound(text, std::nan(""), text, option);
    if (std::isnan(angle))
      throw UsageError(option + ": is empty; write LOW:HIGH or one value, in degrees, as in 30:60");
    return {angle, angle};
  }
  const AngleRange range = {ParseBound(text.substr(0, colon), -kInfinity, text, option),
                            ParseBound(text.substr(colon + 1), kInfinity, text, option)};
  if (range.low > range.high)
    throw UsageError(option + " " + text + ": the first bound is above the second; write LOW:HIGH");
  return range;
}

void Apply(const Selection& selection, Measurement* measurement) {
  Samples& samples = measurement->samples;
  const double cos_max = selection.theta_max >= kPi / 2 ? 0.0 : std::cos(selection.theta_max + 1e-9);
  const bool by_angle = std::isfinite(selection.theta_i.low) || std::isfinite(selection.theta_i.high) ||
                        std::isfinite(selection.phi_i.low) || std::isfinite(selection.phi_i.high);
  if (!by_angle && cos_max == 0.0) return;
  std::vector<std::uint8_t> keep(samples.size(), 1);
  std::size_t kept = samples.size();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.wi_z[i] < cos_max || samples.wo_z[i] < cos_max) {
      keep[i] = 0;
      --kept;
      measurement->set_aside.Add(SetAsideReason::kBeyondAngleLimit);
      continue;
    }
    if (!by_angle) continue;
    const Vec3 wi = samples.wi(i);
    const double theta = PolarAngle(wi);
    const bool in_theta = theta >= selection.theta_i.low - kSlack && theta <= selection.theta_i.high + kSlack;
    if (!in_theta || (theta > kSlack && !AzimuthInRange(Azimuth(wi), selection.phi_i))) {
      keep[i] = 0;
      --kept;
      measurement->set_aside.Add(SetAsideReason::kOutsideSelection);
    }
  }
  if (kept == samples.size()) return;
  if (kept == 0) {
    throw InputError(measurement->source + ": none of its " + std::to_string(samples.size()) +
                     " usable samples lies in the chosen part; see `lobefit info` for the angles that it holds");
  }
  samples.Keep(keep);
}

}  // namespace lobefit

#include "lobefit/export/determined.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kStandardErrors = 2;
constexpr double kAnyTurn = kPi / 8;

// Standard error of a shape parameter: 0 where it was given, infinite where it was fitted and not determined.
double ErrorOf(const FittedParameter& parameter) {
  if (!parameter.free) return 0;
  double error = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>* errors : {&parameter.standard_error_clustered, &parameter.standard_error}) {
    if (!errors->empty() && std::isfinite((*errors)[0]) && !std::isfinite(error)) error = (*errors)[0];
  }
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

double InErrors(double value, double error) {
  if (value == 0) return 0;
  return error > 0 ? std::fabs(value) / error : std::numeric_limits<double>::infinity();
}

std::string Words(double error) {
  return std::isfinite(error) ? fmt::format("its error of {:.2g} degrees", RadiansToDegrees(error))
                              : "its error, which is not determined";
}

void LeaveOutTilt(FittedParameter* shape, const std::string& of, std::vector<Carried>* left_out) {
  double &x = shape[2].values[0], &y = shape[3].values[0];
  const double tilt = std::hypot(x, y), error_x = ErrorOf(shape[2]), error_y = ErrorOf(shape[3]);
  if (tilt == 0 || std::hypot(InErrors(x, error_x), InErrors(y, error_y)) > kStandardErrors) return;
  left_out->push_back({Feature::kTilt, Carries::kNot,
                       fmt::format("left out{}: {:.2g} degrees, within twice {}", of, RadiansToDegrees(tilt),
                                   Words(std::max(error_x, error_y)))});
  x = y = 0;
}

void LeaveOutTurn(FittedParameter* shape, bool round, const std::string& of, std::vector<Carried>* left_out) {
  double &alpha_x = shape[0].values[0], &alpha_y = shape[1].values[0], &turn = shape[4].values[0];
  if (round || alpha_x == alpha_y || !shape[4].free) return;
  const double error = ErrorOf(shape[4]);
  if (error > kAnyTurn) {
    left_out->push_back({Feature::kRotation, Carries::kNot,
                         fmt::format("left out{}: the turn is not determined, nor then the widths {:.3g} and {:.3g} "
                                     "apart; written as round",
                                     of, alpha_x, alpha_y)});
    alpha_x = alpha_y = std::sqrt(alpha_x * alpha_y);
    turn = 0;
  } else if (turn != 0 && InErrors(turn, error) <= kStandardErrors) {
    left_out->push_back(
        {Feature::kRotation, Carries::kNot,
         fmt::format("left out{}: {:.2g} degrees, within twice {}", of, RadiansToDegrees(turn), Words(error))});
    turn = 0;
  }
}

}  // namespace

Determined OnlyDetermined(const Material& material) {
  Determined result = {material, {}};
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    FittedParameter* shape = &result.material.parameters[FirstParameter(material.model, l)];
    const std::string of = material.model.lobes.size() > 1 ? fmt::format(" (lobe {})", l + 1) : "";
    LeaveOutTilt(shape, of, &result.left_out);
    LeaveOutTurn(shape, IsRound(material.model.lobes[l].ndf), of, &result.left_out);
  }
  return result;
}

}  // namespace lobefit

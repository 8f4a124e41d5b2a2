#include "lobefit/material/material.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/math/vec.h"

namespace lobefit {

ParameterValues Material::Values() const {
  ParameterValues values;
  for (const FittedParameter& parameter : parameters) values.push_back(parameter.values);
  return values;
}

const std::vector<Choice<VerdictKind>>& VerdictChoices() {
  static const std::vector<Choice<VerdictKind>> choices = {
      {VerdictKind::kWithinNoise, "within-noise", "the model differs from the data by no more than their noise"},
      {VerdictKind::kClose, "close", "the model is close to the data"},
      {VerdictKind::kRough, "rough", "the model follows the data roughly"},
      {VerdictKind::kDoesNotDescribe, "does-not-describe", "the model does not describe the data"},
  };
  return choices;
}

std::string EnergyText(const EnergyBalance& balance) {
  if (!balance.absolute || !(balance.albedo > 1.005)) return "";
  std::string text = fmt::format("an albedo of {:.3g} at theta_i {:.4g}, phi_i {:.4g} degrees in {}", balance.albedo,
                                 RadiansToDegrees(balance.theta_i), RadiansToDegrees(balance.phi_i), balance.channel);
  return text + fmt::format(", above 1 at {} of {} incident directions", balance.above_one, balance.incidences);
}

std::string PercentText(double share) {
  if (std::isnan(share)) return "unknown";
  if (share > 10) return "over 1000 %";
  return share < 0.995 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

}  // namespace lobefit

#include "summary.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text.h"
#include "lobefit/measurement/set_aside.h"

namespace lobefit {
namespace {

// Words for a key of Material::set_aside.
std::string WordsOf(const std::string& key) {
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (Key(reason) == key) return std::string(Words(reason));
  }
  return key;
}

void AppendParameters(const Material& material, std::string* text) {
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FittedParameter& fitted = material.parameters[i];
    if (!fitted.free && parameters[i].group == ParameterGroup::kShape && parameters[i].unit == "deg" &&
        fitted.values[0] == 0)
      continue;
    const double factor = InsideFactor(parameters[i]);
    *text += fmt::format("  {:<18}", parameters[i].json_name);
    for (std::size_t c = 0; c < fitted.values.size(); ++c) {
      if (c == 4 && fitted.values.size() > 5) {
        *text += fmt::format("  ... {} channels", fitted.values.size());
        break;
      }
      const std::string label =
          parameters[i].per_channel && material.channels.size() > 1 ? material.channels[c] + " " : "";
      *text += "  " + label + WithError(fitted.values[c] / factor, fitted.standard_error[c] / factor);
    }
    if (!fitted.free) *text += "  (fixed)";
    if (fitted.at_bound) *text += "  (at its bound)";
    *text += '\n';
  }
}

}  // namespace

std::string WithError(double value, double standard_error) {
  if (!std::isfinite(standard_error) || standard_error <= 0) return fmt::format("{:.5g}", value);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(standard_error))));
  if (decimals > 9) return fmt::format("{:.10g} +- {:.1e}", value, standard_error);
  return fmt::format("{:.{}f} +- {:.{}f}", value, decimals, standard_error, decimals);
}

std::string Summary(const Material& material) {
  std::string text =
      fmt::format("{} ({}): recipe {}", material.source.file, material.source.format, material.recipe_name);
  if (!material.recipe_reason.empty()) text += fmt::format(", because {}", material.recipe_reason);
  text += '\n';
  text += fmt::format("{} of {} samples used, {} channel{}", material.samples_used, material.samples_read,
                      material.channels.size(), material.channels.size() == 1 ? "" : "s");
  for (const auto& [key, count] : material.set_aside) text += fmt::format("; {} {}", count, WordsOf(key));
  text += fmt::format("\nParameters (+- one standard error), metric {} on {}:\n", material.metric, material.weighting);
  AppendParameters(material, &text);
  text += "Root mean square error:";
  for (const MetricError& error : material.errors) text += fmt::format("  {} {:.3g}", error.metric, error.rms);
  text += '\n';
  if (material.minima.size() > 1) {
    text += fmt::format("{} distinct minima found, the next one costs {:.3g} times as much\n", material.minima.size(),
                        material.minima[1].cost / material.minima[0].cost);
  }
  for (const std::string& remark : material.remarks) text += "Note: " + remark + '\n';
  for (const std::string& direction : material.degenerate) text += "Not determined: " + direction + '\n';
  if (!material.termination.converged) text += "NOT CONVERGED: " + material.termination.message + '\n';
  return text;
}

}  // namespace lobefit

#include "text/summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/material/abg.h"
#include "lobefit/math/vec.h"
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

// One number for all channels: shared between them, or fixed at the same value.
bool IsOneForAll(const FittedParameter& fitted) {
  const auto one = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [&](double value) {
      return value == values[0] || (std::isnan(value) && std::isnan(values[0]));
    });
  };
  return fitted.values.size() > 1 && one(fitted.values) && one(fitted.standard_error);
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
    const bool one_for_all = IsOneForAll(fitted);
    for (std::size_t c = 0; c < (one_for_all ? 1 : fitted.values.size()); ++c) {
      if (c == 4 && fitted.values.size() > 5) {
        *text += fmt::format("  ... {} channels", fitted.values.size());
        break;
      }
      const std::string label =
          parameters[i].per_channel && material.channels.size() > 1 && !one_for_all ? material.channels[c] + " " : "";
      *text += "  " + label + WithError(fitted.values[c] / factor, fitted.standard_error[c] / factor);
    }
    if (one_for_all) *text += "  (all channels)";
    if (!fitted.free) *text += "  (fixed)";
    if (fitted.at_bound) *text += "  (at its bound)";
    *text += '\n';
  }
}

// An ABg lobe by the numbers that stray-light programs take, and what it scatters.
void AppendAbg(const Material& material, std::string* text) {
  const auto with_error = [](const char* name, double value, double error) {
    return std::isfinite(error) && error > 0 ? fmt::format("  {} {:.4g} +- {:.2g}", name, value, error)
                                             : fmt::format("  {} {:.4g}", name, value);
  };
  for (const AbgNumbers& n : AbgNumbersOf(material)) {
    const std::string channel = material.channels.size() > 1 ? " of " + n.channel : "";
    *text += fmt::format("ABg{}: f_r = A / (B + |beta - beta0|^g),{}{}{}\n", channel, with_error("A", n.A, n.A_error),
                         with_error("B", n.B, n.B_error), with_error("g", n.g, n.g_error));
  }
  if (material.scatter.empty()) return;
  *text += "Total integrated scatter:";
  for (const ScatterAt& at : material.scatter) {
    *text += fmt::format("{} {:.3g}", &at == &material.scatter.front() ? "" : ",",
                         *std::max_element(at.share.begin(), at.share.end()));
    *text += fmt::format(" at theta_i {:.3g}", RadiansToDegrees(at.theta_i));
  }
  *text += material.channels.size() > 1 ? " (the largest of the channels)\n" : "\n";
}

// At most twelve slices of a table of lobes, evenly chosen.
void AppendLobes(const SelTable& table, const std::string& channel, std::string* text) {
  *text += fmt::format(
      "{} incident direction{}, {} squared ellipsoidal lobe{} and a constant for {}{}; amplitudes of {}:\n",
      table.slices.size(), table.slices.size() == 1 ? "" : "s", table.slices[0].lobes.size(),
      table.slices[0].lobes.size() == 1 ? "" : "s", table.quantity == SelQuantity::kBrdf ? "f_r" : "f_r cos theta_o",
      table.bound ? ", on or above every sample" : "", channel);
  *text += "  theta_i   phi_i  constant |  alpha_x  alpha_y offset/deg      psi/deg amplitude\n";
  const std::size_t shown = std::min<std::size_t>(12, table.slices.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const SelSlice& slice = table.slices[shown == 1 ? 0 : k * (table.slices.size() - 1) / (shown - 1)];
    *text += fmt::format("  {:>7.2f} {:>7.2f} {:>9.3g}", RadiansToDegrees(slice.theta_i), RadiansToDegrees(slice.phi_i),
                         slice.constant[0]);
    for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
      const SelShape& shape = slice.lobes[l];
      *text += fmt::format(" | {:>8.4f} {:>8.4f} {:>6.2f},{:>6.2f} {:>8.1f} {:>9.3g}", shape.alpha_x, shape.alpha_y,
                           RadiansToDegrees(shape.offset_in), RadiansToDegrees(shape.offset_across),
                           RadiansToDegrees(shape.psi), slice.amplitude[l][0]);
    }
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
  std::string text = fmt::format("{} ({}): recipe {}", PrintableName(material.source.file), material.source.format,
                                 material.recipe_name);
  if (!material.recipe_reason.empty()) text += fmt::format(", because {}", material.recipe_reason);
  text += '\n';
  text += fmt::format("{} of {} samples used, {} channel{}", material.samples_used, material.samples_read,
                      material.channels.size(), material.channels.size() == 1 ? "" : "s");
  for (const auto& [key, count] : material.set_aside) text += fmt::format("; {} {}", count, WordsOf(key));
  if (material.sel) {
    text += '\n';
    AppendLobes(*material.sel, material.channels[0], &text);
    text += fmt::format("Metric {} on {}. ", material.metric, material.weighting);
  } else {
    text +=
        fmt::format("\nParameters (+- one standard error), metric {} on {}:\n", material.metric, material.weighting);
    AppendParameters(material, &text);
    AppendAbg(material, &text);
  }
  if (!material.tried.empty()) {
    text += "Models tried, error on incident directions held out:\n";
    for (const TriedModel& model : material.tried) {
      text += fmt::format("  {} {:<34} {:>3} parameters  {:.3g}  ({:.2f} of the first)\n", model.chosen ? '*' : ' ',
                          model.name, model.free_parameters, model.held_out, model.ratio);
    }
  }
  if (material.verdict) {
    const Verdict& verdict = *material.verdict;
    text += fmt::format("Verdict: {}. Typical error {}", NameOf(VerdictChoices(), verdict.kind),
                        PercentText(verdict.typical_error));
    if (std::isfinite(verdict.noise)) text += fmt::format(", noise of the data {}", PercentText(verdict.noise));
    text += verdict.advice.empty() ? "\n" : "; " + verdict.advice + '\n';
  }
  if (material.energy) {
    if (!material.energy->absolute) text += "The scale of the values is free: no albedo follows from the fit\n";
    if (const std::string above = EnergyText(*material.energy); !above.empty())
      text += "More light leaves than arrives: " + above + '\n';
  }
  text += "Root mean square error:";
  for (const MetricError& error : material.errors) {
    // A metric may weigh no sample at all: those that weigh by sin(theta_i) at normal incidence.
    text += std::isnan(error.rms) ? fmt::format("  {} -", error.metric)
                                  : fmt::format("  {} {:.3g}", error.metric, error.rms);
  }
  text += '\n';
  if (material.minima.size() > 1) {
    text += fmt::format("{} distinct minima found, the next one costs {:.3g} % more\n", material.minima.size(),
                        100 * (material.minima[1].cost / material.minima[0].cost - 1));
  }
  if (material.instrument) {
    const InstrumentUsed& i = *material.instrument;
    const std::string across = i.across > 0 ? fmt::format(" x {:.4g}", RadiansToDegrees(i.across)) : std::string();
    text += fmt::format("Instrument: half angles {:.4g} (source) and {:.4g}{} degrees (detector), {} mean\n",
                        RadiansToDegrees(i.source), RadiansToDegrees(i.detector), across, i.mean);
    if (!i.gains.empty()) {
      const auto [low, high] =
          std::minmax_element(i.gains.begin(), i.gains.end(),
                              [](const IncidenceGain& a, const IncidenceGain& b) { return a.gain < b.gain; });
      text += fmt::format("  gains of {} incidences {:.4g} to {:.4g}, standard deviation {:.2g}{}\n", i.gains.size(),
                          low->gain, high->gain, i.drift->sd, i.drift->estimated ? " (estimated)" : " (given)");
    }
    for (const InstrumentHalfAngle& half_angle : i.half_angles) {
      text += fmt::format("  {} {:.3f} +- {:.3f} degrees, given {:.3g} +- {:.2g}{}\n", half_angle.name,
                          RadiansToDegrees(half_angle.value), RadiansToDegrees(half_angle.standard_error),
                          RadiansToDegrees(half_angle.given), RadiansToDegrees(half_angle.prior),
                          half_angle.determined ? "" : " (not determined)");
    }
    for (const InstrumentAngle& angle : i.alignment) {
      text += fmt::format("  {:<6} {:.3f} +- {:.3f} degrees\n", angle.name, RadiansToDegrees(angle.value),
                          RadiansToDegrees(angle.standard_error));
    }
    for (std::size_t c = 0; c < i.offset.size(); ++c) {
      text += fmt::format("  offset {} {:.3g} +- {:.2g} /sr\n", material.channels[c], i.offset[c].value,
                          i.offset[c].standard_error);
    }
  }
  for (const std::string& remark : material.remarks) text += "Note: " + remark + '\n';
  for (const std::string& direction : material.degenerate) text += "Not determined: " + direction + '\n';
  if (!material.termination.converged) text += "NOT CONVERGED: " + material.termination.message + '\n';
  return text;
}

}  // namespace lobefit

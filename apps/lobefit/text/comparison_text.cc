#include "text/comparison_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/version.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string Cell(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

// Ends in words: whether a fit is to be trusted.
std::string Ending(const JudgedModel& model) {
  if (!model.fitted) return "given";
  if (!model.material.termination.converged) return "NOT CONVERGED";
  return model.material.termination.determined ? "converged" : "NOT DETERMINED";
}

Json ModelToJson(const JudgedModel& model) {
  Json errors = Json::object(), folds = Json::array();
  for (const MetricError& error : model.errors) errors[error.metric] = Number(error.rms);
  for (const double square : model.fold_mean_square) folds.push_back(Number(std::sqrt(square)));
  Json json = {{"name", model.name}, {"fitted", model.fitted}, {"free_parameters", model.free_parameters}};
  json["errors"] = errors;
  json["aic"] = model.fitted ? Number(model.aic) : Json(nullptr);
  json["bic"] = model.fitted ? Number(model.bic) : Json(nullptr);
  json["held_out"] = {{"rms", Number(model.held_out)},
                      {"folds_rms", folds},
                      {"excess_mean_square", Number(model.excess)},
                      {"excess_stderr", Number(model.excess_error)}};
  json["converged"] = model.material.termination.converged;
  json["determined"] = model.material.termination.determined;
  json["timings_s"] = {{"fit", model.fit_s}, {"folds", model.folds_s}};
  json["remarks"] = model.remarks;
  return json;
}

}  // namespace

std::string ComparisonText(const Comparison& comparison, const ComparisonContext& context) {
  const std::string metric = NameOf(MetricChoices(), comparison.metric);
  std::string text = fmt::format("{} ({}): {} of {} samples used by all, {} incident direction{}", context.source,
                                 context.format, comparison.samples, comparison.samples_read, comparison.incidences,
                                 comparison.incidences == 1 ? "" : "s");
  if (comparison.folds > 0) text += fmt::format(" in {} folds", comparison.folds);
  text += fmt::format("\nRoot mean square error; AIC, BIC and held-out error under metric {} on {}:\n", metric,
                      NameOf(WeightingChoices(), comparison.weighting));
  std::size_t width = 6;
  double least_aic = std::numeric_limits<double>::infinity(), least_bic = least_aic;
  for (const JudgedModel& model : comparison.models) {
    width = std::max(width, model.name.size());
    if (!model.fitted) continue;
    least_aic = std::min(least_aic, model.aic);
    least_bic = std::min(least_bic, model.bic);
  }
  text += fmt::format("  {:<{}} {:>5}", "recipe", width, "free");
  for (const Choice<Metric>& choice : MetricChoices()) text += fmt::format(" {:>9}", choice.name);
  text += fmt::format(" {:>10} {:>10} {:>9} {:>8}\n", "AIC", "BIC", "held-out", "time/s");
  for (std::size_t m = 0; m < comparison.models.size(); ++m) {
    const JudgedModel& model = comparison.models[m];
    text += fmt::format("{} {:<{}} {:>5}", m == comparison.recommended ? '>' : ' ', model.name, width,
                        model.free_parameters);
    for (const MetricError& error : model.errors) text += fmt::format(" {:>9}", Cell(error.rms));
    if (model.fitted) {
      text += fmt::format(" {:>10} {:>10}", fmt::format("+{:.6g}", model.aic - least_aic),
                          fmt::format("+{:.6g}", model.bic - least_bic));
    } else {
      text += fmt::format(" {:>10} {:>10}", "-", "-");
    }
    text += fmt::format(" {:>9} {:>8.2f}  {}\n", Cell(model.held_out), model.fit_s + model.folds_s, Ending(model));
  }
  text += fmt::format("Recommended: {}.\n", comparison.reason);
  if (comparison.models.size() > 1) {
    text +=
        "AIC and BIC count from the least. They take residuals for independent and Gaussian; samples of one incident "
        "direction are not, so both favour the richer model more than they should.\n";
  }
  for (const std::string& remark : comparison.remarks) text += "Note: " + remark + '\n';
  for (const JudgedModel& model : comparison.models) {
    for (const std::string& remark : model.remarks) text += fmt::format("Note: {}: {}\n", model.name, remark);
  }
  return text;
}

std::string ComparisonJson(const Comparison& comparison, const ComparisonContext& context) {
  Json models = Json::array();
  for (const JudgedModel& model : comparison.models) models.push_back(ModelToJson(model));
  const Json json = {
      {"format", "lobefit comparison"},
      {"format_version", "1.0"},
      {"version", Version()},
      {"command", context.command},
      {"source", {{"file", context.source}, {"sha256", context.sha256}, {"format", context.format}}},
      {"metric", NameOf(MetricChoices(), comparison.metric)},
      {"weighting", NameOf(WeightingChoices(), comparison.weighting)},
      {"theta_max_deg", RadiansToDegrees(comparison.theta_max)},
      {"samples_read", comparison.samples_read},
      {"samples_used", comparison.samples},
      {"residuals", comparison.residuals},
      {"incidences", comparison.incidences},
      {"folds", comparison.folds},
      {"held_out_samples", comparison.held_out_samples},
      {"models", models},
      {"recommended",
       {{"name", comparison.models[comparison.recommended].name},
        {"reason", comparison.reason},
        {"document", context.document}}},
      {"remarks", comparison.remarks},
  };
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lobefit

#include "lobefit/batch/results/result_row.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "lobefit/base/text/text.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string ModelText(const Material& material) {
  if (material.sel) return "sel";
  std::vector<std::string> parts;
  for (const Lobe& lobe : material.model.lobes) {
    parts.push_back(Join({NameOf(NdfChoices(), lobe.ndf), NameOf(MaskingChoices(), lobe.masking),
                          NameOf(FresnelChoices(), lobe.fresnel)},
                         "/"));
  }
  parts.emplace_back(NameOf(DiffuseChoices(), material.model.diffuse));
  return Join(parts, " + ");
}

void AppendParameters(const Material& material, Json* row) {
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FittedParameter& fitted = material.parameters[i];
    const double factor = InsideFactor(parameters[i]);
    const auto entry = [&](const std::vector<double>& numbers, std::size_t c) {
      return c < numbers.size() ? Number(numbers[c] / factor) : Json(nullptr);
    };
    for (std::size_t c = 0; c < fitted.values.size(); ++c) {
      std::string name = parameters[i].json_name;
      if (parameters[i].per_channel) name += "[" + material.channels[c] + "]";
      (*row)[name] = entry(fitted.values, c);
      (*row)[name + ".stderr"] = entry(fitted.standard_error, c);
      (*row)[name + ".stderr_clustered"] = entry(fitted.standard_error_clustered, c);
      (*row)[name + ".clustered_freedom"] = c < fitted.freedom.size() ? Number(fitted.freedom[c]) : Json(nullptr);
    }
  }
}

}  // namespace

const std::vector<std::string>& FixedResultColumns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names = {"verdict",    "typical_error", "noise",        "recipe",       "model",
                                      "format",     "channels",      "samples_read", "samples_used", "converged",
                                      "determined", "misfit",        "minima",       "metric",       "cost"};
    for (const Choice<Metric>& metric : MetricChoices()) names.push_back(std::string("error.") + metric.name);
    return names;
  }();
  return columns;
}

std::string ResultRow(const Material& material) {
  Json row;
  for (const std::string& name : FixedResultColumns()) row[name] = nullptr;
  if (material.verdict) {
    row["verdict"] = NameOf(VerdictChoices(), material.verdict->kind);
    row["typical_error"] = Number(100 * material.verdict->typical_error);
    row["noise"] = Number(100 * material.verdict->noise);
  }
  row["recipe"] = material.recipe_name;
  row["model"] = ModelText(material);
  row["format"] = material.source.format;
  row["channels"] = Join(material.channels, " ");
  row["samples_read"] = material.samples_read;
  row["samples_used"] = material.samples_used;
  row["converged"] = material.termination.converged;
  row["determined"] = material.termination.determined;
  if (material.misfit && material.misfit->tested) row["misfit"] = material.misfit->flagged;
  row["minima"] = material.minima.size();
  row["metric"] = material.metric;
  row["cost"] = Number(material.cost);
  for (const MetricError& error : material.errors) row["error." + error.metric] = Number(error.rms);
  AppendParameters(material, &row);
  return row.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lobefit

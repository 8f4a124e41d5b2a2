#include "lobefit/report/panels/curve_interval.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lobefit/math/student_t.h"

namespace lobefit {
namespace {

constexpr double kUpper = 0.975;
// What gives less of a variance decides nothing of its interval.
constexpr double kLeastShare = 0.01;

}  // namespace

std::vector<double> HalfIntervals(const Material& material,
                                  const std::function<std::vector<double>(const ParameterValues&)>& curve,
                                  const std::function<bool(std::size_t, std::size_t)>& depends) {
  const std::vector<Parameter> parameters = Parameters(material.model);
  const std::vector<std::string>& names = material.covariance_names;
  const bool clustered = !material.covariance_clustered.empty();
  const std::vector<double>& covariance = clustered ? material.covariance_clustered : material.covariance;
  if (covariance.size() != names.size() * names.size()) return {};
  const ParameterValues values = material.Values();
  std::vector<std::size_t> rows;
  std::vector<std::vector<double>> slopes;
  std::vector<double> freedom;  // of each row
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    for (std::size_t c = 0; c < values[p].size(); ++c) {
      if (!depends(p, c)) continue;
      const std::string& name = parameters[p].json_name;
      auto at = std::find(names.begin(), names.end(), name + "[" + material.channels[c] + "]");
      if (at == names.end()) at = std::find(names.begin(), names.end(), name);
      if (at == names.end()) continue;
      const auto row = static_cast<std::size_t>(at - names.begin());
      const double variance = covariance[row * names.size() + row];
      if (!(variance > 0) || !std::isfinite(variance)) continue;
      const double step = 1e-3 * std::min(1.0, std::sqrt(variance));
      ParameterValues above = values, below = values;
      above[p][c] += step * InsideFactor(parameters[p]);
      below[p][c] -= step * InsideFactor(parameters[p]);
      std::vector<double> slope = curve(above);
      const std::vector<double> low = curve(below);
      for (std::size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - low[i]) / (2 * step);
      rows.push_back(row);
      const FittedParameter& fitted = material.parameters[p];
      const std::vector<double>& degrees = clustered ? fitted.freedom : fitted.independent_freedom;
      freedom.push_back(c < degrees.size() && degrees[c] > 0 ? degrees[c] : HUGE_VAL);
      slopes.push_back(slope);
    }
  }
  std::vector<double> half(slopes.empty() ? 0 : slopes[0].size());
  for (std::size_t i = 0; i < half.size(); ++i) {
    double sum = 0, fewest = HUGE_VAL;
    for (std::size_t a = 0; a < rows.size(); ++a) {
      for (std::size_t b = 0; b < rows.size(); ++b)
        sum += slopes[a][i] * covariance[rows[a] * names.size() + rows[b]] * slopes[b][i];
    }
    for (std::size_t a = 0; a < rows.size(); ++a) {
      const double alone = slopes[a][i] * slopes[a][i] * covariance[rows[a] * names.size() + rows[a]];
      if (alone >= kLeastShare * sum) fewest = std::min(fewest, freedom[a]);
    }
    half[i] = std::sqrt(std::max(0.0, sum)) * StudentTQuantile(kUpper, fewest);
  }
  return half;
}

}  // namespace lobefit

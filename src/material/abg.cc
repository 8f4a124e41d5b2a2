#include "lobefit/material/abg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// sqrt(d^T C d) over the entries by these names; entries that are not in the covariance are fixed.
double ErrorOf(const Material& material, const std::array<std::string, 3>& names, const std::array<double, 3>& slopes) {
  const std::vector<double>& covariance = material.covariance;
  const std::size_t n = material.covariance_names.size();
  std::vector<double> by(n, 0.0);
  bool any = false;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto at = std::find(material.covariance_names.begin(), material.covariance_names.end(), names[k]);
    if (at == material.covariance_names.end()) continue;
    by[static_cast<std::size_t>(at - material.covariance_names.begin())] = slopes[k];
    any = true;
  }
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      square += by[i] == 0 || by[j] == 0 ? 0.0 : by[i] * covariance[i * n + j] * by[j];
  }
  return any && square >= 0 ? std::sqrt(square) : kNan;
}

}  // namespace

std::vector<AbgNumbers> AbgNumbersOf(const Material& material) {
  std::vector<AbgNumbers> all;
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    const Lobe& lobe = material.model.lobes[l];
    if (FamilyOf(lobe.ndf) != Family::kAbg || !IsRound(lobe.ndf)) continue;
    const std::size_t first = FirstParameter(material.model, l), scale = FirstFresnel(material.model, l);
    const std::size_t exponent = first + kEllipseParameters;
    const double alpha = material.parameters[first].values[0], g = material.parameters[exponent].values[0];
    for (std::size_t c = 0; c < material.channels.size(); ++c) {
      const double factor = material.parameters[scale].values[c];
      AbgNumbers numbers = {l, material.channels[c]};
      numbers.g = g;
      numbers.B = std::pow(2 * alpha, g);
      numbers.A = numbers.B * factor / (4 * kPi * alpha * alpha);
      const std::string scale_name = parameters[scale].json_name;
      const bool one = material.channels.size() == 1 &&
                       std::find(material.covariance_names.begin(), material.covariance_names.end(), scale_name) !=
                           material.covariance_names.end();
      const std::array<std::string, 3> names = {parameters[first].json_name, parameters[exponent].json_name,
                                                one ? scale_name : scale_name + "[" + material.channels[c] + "]"};
      const double by_g = std::log(2 * alpha);
      numbers.A_error = numbers.A * ErrorOf(material, names, {(g - 2) / alpha, by_g, factor > 0 ? 1 / factor : kNan});
      numbers.B_error = numbers.B * ErrorOf(material, names, {g / alpha, by_g, 0});
      numbers.g_error = ErrorOf(material, names, {0, 1, 0});
      all.push_back(numbers);
    }
  }
  return all;
}

}  // namespace lobefit

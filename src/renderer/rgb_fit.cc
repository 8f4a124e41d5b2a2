#include "lobefit/renderer/rgb_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

// What MakeChannelMap asks wavelengths to cover, nm, and how far inside their ends may lie here.
constexpr double kCovered[2] = {430, 650};
constexpr double kLatestFirst = 480, kEarliestLast = 600;

std::vector<double> Mapped(const ChannelMap& map, const std::vector<double>& values) {
  std::vector<double> result;
  for (const std::vector<double>& row : map.matrix) {
    double sum = 0;
    for (std::size_t c = 0; c < values.size(); ++c) sum += row[c] * values[c];
    result.push_back(std::max(0.0, sum));
  }
  return result;
}

// eta and k, or ior, whose curve is nearest to the mapped one.
void MapIndex(const FittedBrdf& fit, const ChannelMap& map, std::size_t lobe, FittedParameter* first,
              FittedParameter* second) {
  first->values.clear();
  if (second != nullptr) second->values.clear();
  for (const std::vector<double>& row : map.matrix) {
    const auto curve = [&](double cos_d) {
      double sum = 0;
      for (std::size_t c = 0; c < row.size(); ++c) sum += row[c] * fit.Fresnel(lobe, c, cos_d);
      return std::max(0.0, sum);
    };
    if (second == nullptr) {
      const double root = std::sqrt(std::min(curve(1), 0.9999));
      first->values.push_back((1 + root) / (1 - root));
      continue;
    }
    const ConductorIndex index = NearestConductor(curve);
    first->values.push_back(index.eta);
    second->values.push_back(index.k);
  }
}

}  // namespace

ChannelMap RgbMapOf(const FittedBrdf& fit) {
  if (fit.material().channels.size() == 1) {
    return {{{"grey"}, {}}, {{1.0}}, "the value of " + fit.material().channels[0] + " as grey"};
  }
  // Constant beyond the ends, which may lie a little inside of what the map asks for.
  Channels wider = fit.channels();
  const std::size_t count = wider.size();
  const bool first = !wider.wavelengths_nm.empty() && wider.wavelengths_nm.front() > kCovered[0] &&
                     wider.wavelengths_nm.front() <= kLatestFirst;
  const bool last = !wider.wavelengths_nm.empty() && wider.wavelengths_nm.back() < kCovered[1] &&
                    wider.wavelengths_nm.back() >= kEarliestLast;
  if (first) {
    wider.names.insert(wider.names.begin(), "first");
    wider.wavelengths_nm.insert(wider.wavelengths_nm.begin(), kCovered[0]);
  }
  if (last) {
    wider.names.emplace_back("last");
    wider.wavelengths_nm.push_back(kCovered[1]);
  }
  ChannelMap map = MakeChannelMap("rgb", wider);
  for (std::vector<double>& row : map.matrix) {
    if (first) {
      row[1] += row[0];
      row.erase(row.begin());
    }
    if (last) {
      row[count - 1] += row[count];
      row.pop_back();
    }
  }
  if (first || last) {
    map.description = "R G B from " + std::to_string(count) + " wavelengths, constant beyond " +
                      fit.material().channels.front() + " and " + fit.material().channels.back();
  }
  return map;
}

Material RgbFit(const FittedBrdf& fit, const ChannelMap& map) {
  Material material = fit.material();
  material.channels = map.channels.names;
  material.wavelengths_nm = map.channels.wavelengths_nm;
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (parameters[p].per_channel) material.parameters[p].values = Mapped(map, material.parameters[p].values);
  }
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    const Fresnel fresnel = material.model.lobes[l].fresnel;
    FittedParameter* first = &material.parameters[FirstFresnel(material.model, l)];
    if (fresnel == Fresnel::kConductor) {
      MapIndex(fit, map, l, first, first + 1);
      material.model.lobes[l].metal.clear();
    } else if (fresnel == Fresnel::kDielectric) {
      MapIndex(fit, map, l, first, nullptr);
    } else if (IsCoat(fresnel)) {
      first->values.assign(map.channels.size(), fit.material().parameters[FirstFresnel(material.model, l)].values[0]);
    }
  }
  for (FittedParameter& parameter : material.parameters) {
    parameter.standard_error.assign(parameter.values.size(), std::numeric_limits<double>::quiet_NaN());
    parameter.standard_error_clustered = parameter.standard_error;
  }
  material.covariance_names.clear();
  material.covariance.clear();
  return material;
}

}  // namespace lobefit

#include "lobefit/export/targets/spectra.h"

#include <algorithm>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr double kFirst = 360, kLast = 830;

}  // namespace

SpectrumNodes Continued(const SpectrumNodes& nodes) {
  SpectrumNodes result = nodes;
  if (result.wavelengths_nm.front() > kFirst) {
    result.wavelengths_nm.insert(result.wavelengths_nm.begin(), kFirst);
    result.values.insert(result.values.begin(), result.values.front());
  }
  if (result.wavelengths_nm.back() < kLast) {
    result.wavelengths_nm.push_back(kLast);
    result.values.push_back(result.values.back());
  }
  return result;
}

double ValueAt(const SpectrumNodes& nodes, double nm) {
  const std::vector<double>& at = nodes.wavelengths_nm;
  if (at.size() == 1) return nodes.values[0];
  const auto next = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), nm) - at.begin());
  const std::size_t high = std::clamp<std::size_t>(next, 1, at.size() - 1);
  const double t = std::clamp((nm - at[high - 1]) / (at[high] - at[high - 1]), 0.0, 1.0);
  return (1 - t) * nodes.values[high - 1] + t * nodes.values[high];
}

std::vector<double> WavelengthsOf(const std::vector<SpectrumNodes>& spectra) {
  std::vector<double> wavelengths = spectra[0].wavelengths_nm;
  const std::size_t last = wavelengths.size() - 1;
  const auto repeated = [&](std::size_t end, std::size_t neighbour) {
    return last > 1 && std::all_of(spectra.begin(), spectra.end(), [&](const SpectrumNodes& nodes) {
             return nodes.values[end] == nodes.values[neighbour];
           });
  };
  if (wavelengths[last] == kLast && repeated(last, last - 1)) wavelengths.pop_back();
  if (wavelengths[0] == kFirst && wavelengths.size() > 1 && repeated(0, 1)) wavelengths.erase(wavelengths.begin());
  return wavelengths;
}

Channels WavelengthChannels(const std::vector<double>& wavelengths_nm) {
  Channels channels = {{}, wavelengths_nm};
  for (const double nm : wavelengths_nm) channels.names.push_back(FormatDouble(nm) + "nm");
  return channels;
}

BrdfFunction AtWavelengths(const BrdfFunction& brdf, const std::vector<double>& from, const std::vector<double>& to) {
  return [=](const Vec3& wi, const Vec3& wo, double* values) {
    SpectrumNodes known = {from, std::vector<double>(from.size())};
    brdf(wi, wo, known.values.data());
    for (std::size_t c = 0; c < to.size(); ++c) values[c] = ValueAt(known, to[c]);
  };
}

}  // namespace lobefit

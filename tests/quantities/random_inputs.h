// Random inputs of a quantity, from what its own columns say of their domains.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "lobefit/base/text/text.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit::test {

// Whose rows take milliseconds.
inline bool IsQuadrature(const Quantity& quantity) {
  return quantity.name == "aperture_ggx" || quantity.name == "white_furnace" || quantity.name == "vndf_moments";
}

inline std::string Described(const Quantity& quantity, const std::vector<double>& in) {
  std::string text;
  for (std::size_t i = 0; i < in.size(); ++i) text += quantity.inputs[i].name + "=" + FormatDouble(in[i]) + " ";
  return text;
}

class InputGenerator {
 public:
  explicit InputGenerator(unsigned seed) : engine_(seed) {}

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  // Moderate inputs that pass the quantity's checks: roughness .03 to 3, angles to 1, directions mostly upwards.
  std::vector<double> Draw(const Quantity& quantity) {
    std::vector<double> in(quantity.inputs.size());
    do {
      for (std::size_t i = 0; i < in.size(); ++i) in[i] = DrawColumn(quantity.inputs[i]);
      for (const std::size_t first : quantity.directions) in[first + 2] += Uniform(0, 1);
    } while (CheckDomain(quantity, in.data()).has_value());
    return in;
  }

 private:
  double DrawColumn(const InputColumn& column) {
    if (!column.words.empty()) {
      return std::uniform_int_distribution<int>(0, static_cast<int>(column.words.size()) - 1)(engine_);
    }
    const bool low = std::isfinite(column.low), high = std::isfinite(column.high);
    if (low && high) return Uniform(column.low + 1e-3 * (column.high - column.low), column.high);
    if (low) return column.low + std::exp(Uniform(std::log(0.03), std::log(3)));
    return Uniform(-1, 1);
  }

  std::mt19937_64 engine_;
};

}  // namespace lobefit::test

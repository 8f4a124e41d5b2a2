// The loader of the RGL database (powitacq) on an exported _rgb.bsdf, against samples of the fit:
//   powitacq FILE_rgb.bsdf < samples.csv
// The samples are those of `lobefit synth` (theta_i, phi_i, theta_o, phi_o in degrees, then R, G, B). Prints, for each
// polar angle of the viewer, the 10 %, 50 % and 90 % quantiles of the loader's f_r over the fit's.
#define POWITACQ_IMPLEMENTATION
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "powitacq_rgb.h"

namespace {

powitacq_rgb::Vector3f Direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * M_PI / 180, phi = phi_deg * M_PI / 180;
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const powitacq_rgb::BRDF brdf(arguments[1]);
  std::map<int, std::vector<double>> ratios;  // by the viewer's polar angle
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0])) != 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double theta_i = 0, phi_i = 0, theta_o = 0, phi_o = 0, wanted[3] = {};
    fields >> theta_i >> phi_i >> theta_o >> phi_o >> wanted[0] >> wanted[1] >> wanted[2];
    if (!fields) continue;
    // The table's direction is the viewer, and the value has the cosine of the other.
    const powitacq_rgb::Vector3f light = Direction(theta_i, phi_i);
    const auto value = brdf.eval(Direction(theta_o, phi_o), light);
    for (int c = 0; c < 3; ++c) {
      const double found = static_cast<double>(value[c]) / static_cast<double>(light[2]);
      if (wanted[c] > 0) ratios[static_cast<int>(std::lround(theta_o))].push_back(found / wanted[c]);
    }
  }
  std::printf("%8s %8s %8s %8s %8s\n", "viewer", "values", "10 %", "50 %", "90 %");
  for (auto& [theta, values] : ratios) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) { return values[static_cast<std::size_t>(share * (values.size() - 1))]; };
    std::printf("%8d %8zu %8.3f %8.3f %8.3f\n", theta, values.size(), at(0.1), at(0.5), at(0.9));
  }
  return 0;
}

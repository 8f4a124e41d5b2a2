// The loader of the RGL database (powitacq) on an exported _rgb.bsdf:
//   powitacq FILE_rgb.bsdf < rows
// Each row begins with theta_i, phi_i, theta_o, phi_o in degrees. Prints the loader's f_r, R G B, one line a row.
#define POWITACQ_IMPLEMENTATION
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

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
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream fields(line);
    double theta_i = 0, phi_i = 0, theta_o = 0, phi_o = 0;
    if (!(fields >> theta_i >> phi_i >> theta_o >> phi_o)) return 1;
    // The table's direction is the viewer, and the value has the cosine of the other.
    const powitacq_rgb::Vector3f light = Direction(theta_i, phi_i);
    const auto value = brdf.eval(Direction(theta_o, phi_o), light);
    const double cosine = static_cast<double>(light[2]);
    std::printf("%.9g %.9g %.9g\n", static_cast<double>(value[0]) / cosine, static_cast<double>(value[1]) / cosine,
                static_cast<double>(value[2]) / cosine);
  }
  return 0;
}

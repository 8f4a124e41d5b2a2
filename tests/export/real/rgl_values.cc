// lobefit's own reading of an RGL file at random pairs of directions:
//   rgl_values FILE.bsdf COUNT
// Both directions are uniform over the solid angle to 88 degrees; pairs that the file does not cover are left out.
// Prints theta_i, phi_i, theta_o, phi_o in degrees, then f_r of each channel, separated by commas.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/rgl/brdf.h"
#include "lobefit/math/directions.h"

namespace {

using lobefit::Vec3;

void Print(const lobefit::RglBrdf& brdf, int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const double least = std::cos(lobefit::DegreesToRadians(88));
  const auto direction = [&] {
    const double cos_theta = 1 - unit(random) * (1 - least);
    return lobefit::FromSpherical(std::acos(cos_theta), 2 * lobefit::kPi * unit(random));
  };
  std::vector<double> values(brdf.channels().size());
  for (int k = 0; k < count;) {
    const Vec3 wi = direction(), wo = direction();
    if (!brdf.Covers(wi, wo)) continue;
    brdf.Evaluate(wi, wo, values.data());
    for (const Vec3& w : {wi, wo}) {
      std::printf("%.12g,%.12g,", lobefit::RadiansToDegrees(lobefit::PolarAngle(w)),
                  lobefit::RadiansToDegrees(lobefit::Azimuth(w)));
    }
    for (std::size_t c = 0; c < values.size(); ++c) std::printf("%s%.12g", c == 0 ? "" : ",", values[c]);
    std::printf("\n");
    ++k;
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  try {
    const lobefit::FileBytes bytes(arguments[1]);
    Print(lobefit::RglBrdf(arguments[1], bytes.bytes()), std::atoi(arguments[2]));
    return 0;
  } catch (const lobefit::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

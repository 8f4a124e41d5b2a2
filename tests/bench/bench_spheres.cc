// How fits of a MERL table look beside it: spheres under a point light and under a sky, in dB.
//   bench_spheres TABLE.binary NAME.material.json...
// Prints a line: for each document the ratio under the light and under the sky. `spheres` fits and makes the table.
#include <cstdio>

#include "tests/bench/look.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

void Run(const std::string& file, const std::vector<std::string>& documents) {
  const Measurement table = ReadMeasurement(file, {});
  const IsotropicLookup lookup(table);
  const ChannelColor to_color(table.channels);
  std::vector<FittedFunction> fits;
  for (const std::string& document : documents) fits.emplace_back(ReadMaterial(document));
  const SlopeCoordinates lobe = fits.at(0).lobe_shapes().at(0);
  const Look reference = Render(Shown(lookup, 3), lobe, to_color);
  std::string line;
  for (const FittedFunction& fit : fits) {
    const Look look = Render(Shown(fit), lobe, to_color);
    line += fmt::format(" {:.1f} {:.1f}", CompareSpheres(reference.light, look.light).first,
                        CompareSpheres(reference.sky, look.sky).first);
  }
  fmt::print("{}\n", line.substr(1));
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_spheres TABLE.binary NAME.material.json...\n");
    return 2;
  }
  try {
    lobefit::Run(argv[1], {argv + 2, argv + argc});
  } catch (const lobefit::Error& error) {
    std::fprintf(stderr, "bench_spheres: %s\n", error.what());
    return error.exit_code();
  }
}

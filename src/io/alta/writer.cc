#include "lobefit/io/alta/writer.h"

#include <cmath>
#include <ostream>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/alta/header.h"
#include "lobefit/math/directions.h"

namespace lobefit {

void WriteAlta(const Measurement& measurement, const std::filesystem::path& path) {
  const Samples& samples = measurement.samples;
  const std::size_t channels = measurement.channels.size();
  const bool sigma = !samples.sigma.empty(), intervals = sigma || !samples.weight.empty();
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << "#ALTA HEADER BEGIN\n";
    for (const std::string& comment : measurement.comments) out << "# " << Printable(comment) << '\n';
    out << "# channels: " << Join(measurement.channels.names, " ") << "\n#DIM 4 " << channels
        << "\n#PARAM_IN SPHERICAL_TL_PL_TV_PV\n#PARAM_OUT INV_STERADIAN\n";
    if (intervals) {
      out << "#VS";
      for (std::size_t c = 0; c < channels; ++c) out << " 1";
      out << (sigma ? "\n# " + std::string(kAltaSigma) : "") << '\n';
    }
    out << "#ALTA HEADER END\n";
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 wi = samples.wi(i), wo = samples.wo(i);
      out << FormatDouble(PolarAngle(wi)) << ' ' << FormatDouble(Azimuth(wi)) << ' ' << FormatDouble(PolarAngle(wo))
          << ' ' << FormatDouble(Azimuth(wo));
      for (std::size_t c = 0; c < channels; ++c) out << ' ' << FormatDouble(samples.values[c][i]);
      const double half_width = !intervals ? 0 : sigma ? samples.sigma[i] : 1 / std::sqrt(samples.weight[i]);
      for (std::size_t c = 0; intervals && c < channels; ++c) out << ' ' << FormatDouble(half_width);
      out << '\n';
    }
  });
}

}  // namespace lobefit

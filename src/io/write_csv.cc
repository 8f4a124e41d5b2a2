#include "lobefit/io/write_csv.h"

#include <ostream>

#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/math/directions.h"

namespace lobefit {

void WriteCsv(const Measurement& measurement, const std::vector<std::string>& comments,
              const std::filesystem::path& path) {
  const Samples& samples = measurement.samples;
  WriteFileAtomically(path, [&](std::ostream& out) {
    for (const std::string& comment : comments) out << "# " << comment << '\n';
    out << "# angle-unit: deg\n# value-kind: f\n# incident: towards\n";
    out << "theta_i,phi_i,theta_o,phi_o";
    const bool mono = measurement.channels.size() == 1 && measurement.channels.wavelengths_nm.empty();
    for (const std::string& name : measurement.channels.names) out << ',' << (mono ? "value" : name);
    out << '\n';
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 wi = samples.wi(i), wo = samples.wo(i);
      out << FormatDouble(RadiansToDegrees(PolarAngle(wi))) << ',' << FormatDouble(RadiansToDegrees(Azimuth(wi))) << ','
          << FormatDouble(RadiansToDegrees(PolarAngle(wo))) << ',' << FormatDouble(RadiansToDegrees(Azimuth(wo)));
      for (const std::vector<double>& values : samples.values) out << ',' << FormatDouble(values[i]);
      out << '\n';
    }
  });
}

}  // namespace lobefit

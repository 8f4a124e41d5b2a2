#include "lobefit/io/mountain/writer.h"

#include <array>
#include <cmath>
#include <ostream>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

// What the columns of values are.
struct Columns {
  const char* colorimetry;
  std::vector<std::vector<double>> share;  // share[column][channel]
};

Columns ColumnsOf(const Channels& channels) {
  if (channels.size() == 1) return {"CIE-Y", {{1}}};
  if (channels.names == std::vector<std::string>{"X", "Y", "Z"}) return {"CIE-XYZ", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (channels.names == std::vector<std::string>{"R", "G", "B"}) {
    Columns columns = {"CIE-XYZ", std::vector(3, std::vector<double>(3))};
    for (std::size_t channel = 0; channel < 3; ++channel) {
      std::array<double, 3> primary = {};
      primary[channel] = 1;
      const std::array<double, 3> xyz = XyzFromSrgb(primary);
      for (std::size_t column = 0; column < 3; ++column) columns.share[column][channel] = xyz[column];
    }
    return columns;
  }
  throw UsageError("a Mountain file holds CIE Y or X Y Z, not the channels " + Excerpt(Join(channels.names), 80) +
                   "; convert them with --channels rgb or luminance");
}

std::string Rounded(double degrees) { return FormatDouble(std::round(degrees * 100) / 100 + 0.0); }

}  // namespace

std::vector<std::filesystem::path> WriteMountain(const Measurement& measurement, const std::filesystem::path& path) {
  const Columns columns = ColumnsOf(measurement.channels);
  if (measurement.isotropic) {
    throw UsageError(
        "a Mountain file lists viewers of one incident direction, but an isotropic table has no list of them; "
        "write it as csv, alta or rgl");
  }
  const Samples& samples = measurement.samples;
  const Incidences incidences = GroupByDirection(measurement, Beam::kLight);
  std::vector<std::filesystem::path> written;
  for (std::size_t group = 0; group < incidences.wi.size(); ++group) {
    const std::string theta = Rounded(RadiansToDegrees(PolarAngle(incidences.wi[group])));
    const std::string phi = Rounded(RadiansToDegrees(Azimuth(incidences.wi[group])));
    std::filesystem::path file = path;
    if (incidences.wi.size() > 1) {
      file.replace_filename(path.stem().string() + "_theta" + theta + "_phi" + phi + path.extension().string());
    }
    std::size_t rows = 0;
    for (const std::uint32_t of : incidences.group) rows += of == group ? 1 : 0;
    WriteFileAtomically(file, [&](std::ostream& out) {
      for (const std::string& comment : measurement.comments) out << "#comment " << Printable(comment) << '\n';
      out << "#sample_name \"" << measurement.source << "\"\n#format: theta phi BRDF\n#intheta " << theta << "\n#inphi "
          << phi << "\n#upphi 90\n#colorimetry: " << columns.colorimetry << "\n#datapoints_in_file: " << rows << '\n';
      for (std::size_t i = 0; i < samples.size(); ++i) {
        if (incidences.group[i] != group) continue;
        out << FormatDouble(RadiansToDegrees(PolarAngle(samples.wo(i)))) << ' '
            << FormatDouble(RadiansToDegrees(Azimuth(samples.wo(i))));
        for (const std::vector<double>& share : columns.share) {
          double value = 0;
          for (std::size_t c = 0; c < share.size(); ++c) value += share[c] * samples.values[c][i];
          out << ' ' << FormatDouble(value);
        }
        out << '\n';
      }
    });
    written.push_back(file);
  }
  return written;
}

}  // namespace lobefit

#include "lobefit/io/csv/writer.h"

#include <charconv>
#include <ostream>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/keys.h"
#include "lobefit/io/csv/head/lines.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Whether the reader would take the comment of another file for a key of this one.
bool IsKey(const std::string& comment) {
  CsvKeys keys;
  try {
    return ReadKey(InputFile{}, 0, comment, &keys);
  } catch (const InputError&) {
    return true;
  }
}

void WriteInstrument(const StatedInstrument& instrument, std::ostream& out) {
  const auto write = [&out](const char* key, const std::optional<double>& half_angle,
                            const std::optional<double>& prior, const std::optional<double>& across) {
    if (!half_angle) return;
    out << "# " << key << ": " << FormatDouble(RadiansToDegrees(*half_angle));
    if (prior) out << " +- " << FormatDouble(RadiansToDegrees(*prior));
    if (across) out << " x " << FormatDouble(RadiansToDegrees(*across));
    out << '\n';
  };
  write("source", instrument.source, instrument.source_prior, {});
  write("detector", instrument.detector, instrument.detector_prior, instrument.detector_across);
  if (instrument.plain_mean) out << "# mean: " << (*instrument.plain_mean ? "plain" : "flux") << '\n';
  if (instrument.drift)
    out << "# drift: " << (instrument.drift->sd ? FormatDouble(*instrument.drift->sd) : std::string("auto")) << '\n';
  if (instrument.alignment) out << "# alignment: " << FormatDouble(RadiansToDegrees(*instrument.alignment)) << '\n';
  if (instrument.offset) out << "# offset: " << (*instrument.offset ? "true" : "false") << '\n';
  if (instrument.noise) {
    out << "# noise: floor=" << FormatDouble(instrument.noise->floor)
        << ", relative=" << FormatDouble(instrument.noise->relative)
        << ", poisson=" << FormatDouble(instrument.noise->poisson) << '\n';
  }
}

}  // namespace

void RequireReadableChannels(const Channels& channels) {
  if (channels.size() == 1 && channels.wavelengths_nm.empty()) return;
  constexpr std::string_view kColours = "RGBXYZ";
  std::size_t rgb = 0, xyz = 0;
  for (const std::string& name : channels.names) {
    const CsvColumn column = ClassifyColumn(name);
    const std::size_t colour = name.size() == 1 ? kColours.find(name[0]) : std::string_view::npos;
    if (colour != std::string_view::npos) ++(colour < 3 ? rgb : xyz);
    if (column.role == ColumnRole::kChannel && name.find_first_of(",;\t\"\n\r") == std::string::npos) continue;
    throw InputError("the channel '" + Excerpt(Printable(name)) +
                     "' has no name that a column of CSV may have: R G B, X Y Z or a wavelength as 550nm; choose one "
                     "channel with --channels, or another format");
  }
  if (rgb % 3 + xyz % 3 > 0) {
    throw InputError("CSV holds colours as R G B or X Y Z together, but the channels are " + JoinSome(channels.names) +
                     "; choose one channel with --channels, or another format");
  }
}

void WriteCsv(const Measurement& measurement, const std::vector<std::string>& comments,
              const std::filesystem::path& path, int digits) {
  const Samples& samples = measurement.samples;
  const auto number = [&](double value) {
    if (digits >= 17) return FormatDouble(value);
    char buffer[40];
    const std::to_chars_result end =
        std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::general, digits);
    return std::string(buffer, end.ptr);
  };
  const auto degrees = [&](double radians) { return number(RadiansToDegrees(radians)); };
  WriteFileAtomically(path, [&](std::ostream& out) {
    for (const std::string& comment : comments) out << "# " << comment << '\n';
    for (const std::string& comment : measurement.comments) {
      const std::string text = Printable(comment);
      out << "# " << (IsKey(text) ? kCommentKey : std::string_view()) << text << '\n';
    }
    WriteInstrument(measurement.instrument, out);
    out << "# angle-unit: deg\n# value-kind: f\n# incident: towards\n";
    out << "theta_i,phi_i,theta_o,phi_o";
    const bool mono = measurement.channels.size() == 1 && measurement.channels.wavelengths_nm.empty();
    for (const std::string& name : measurement.channels.names) out << ',' << (mono ? "value" : name);
    if (!samples.weight.empty()) out << ",weight";
    if (!samples.sigma.empty() && samples.weight.empty()) out << ",sigma";
    out << '\n';
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 wi = samples.wi(i), wo = samples.wo(i);
      out << degrees(PolarAngle(wi)) << ',' << degrees(Azimuth(wi)) << ',' << degrees(PolarAngle(wo)) << ','
          << degrees(Azimuth(wo));
      for (const std::vector<double>& values : samples.values) out << ',' << number(values[i]);
      if (!samples.weight.empty()) out << ',' << number(samples.weight[i]);
      if (!samples.sigma.empty() && samples.weight.empty()) out << ',' << number(samples.sigma[i]);
      out << '\n';
    }
  });
}

}  // namespace lobefit

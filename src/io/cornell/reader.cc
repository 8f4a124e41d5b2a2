// Cornell spectral text: '#' comments, the number of wavelengths, the wavelengths in nanometres, then for each sample
// theta_i phi_i theta_o phi_o in radians and one value of f_r in 1/sr a wavelength. Both directions point away from the
// surface: the specular direction is half a turn from its incidence (seen in the data: the peak at grazing light is
// there). Line ends do not matter to the format.
#include "lobefit/io/cornell/reader.h"

#include <cmath>
#include <string>
#include <vector>

#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostWavelengths = 4096;

// A wavelength of optics, in nanometres.
bool IsWavelength(double nanometres) { return nanometres >= 100 && nanometres <= 1e5; }

Channels ReadChannels(WordReader* words) {
  const std::size_t count = words->Count("the number of wavelengths");
  if (count > kMostWavelengths) {
    words->Fail("the number of wavelengths is " + std::to_string(count) + "; at most " +
                std::to_string(kMostWavelengths) + " are allowed");
  }
  Channels channels;
  for (std::size_t i = 0; i < count; ++i) {
    const double wavelength = words->FiniteNumber("a wavelength");
    if (!IsWavelength(wavelength)) {
      words->Fail("the wavelength " + FormatDouble(wavelength) + " is not between 100 and 100000 nm; the " +
                  std::to_string(count) + " wavelengths stand in nanometres before the samples");
    }
    if (i > 0 && wavelength <= channels.wavelengths_nm.back()) {
      words->Fail("the wavelength " + FormatDouble(wavelength) + " does not rise above the one before it, " +
                  FormatDouble(channels.wavelengths_nm.back()));
    }
    channels.wavelengths_nm.push_back(wavelength);
    channels.names.push_back(FormatDouble(wavelength) + "nm");
  }
  return channels;
}

// Those of the head.
std::vector<std::string> CommentsOf(std::string_view bytes) {
  std::vector<std::string> comments;
  LineReader lines(bytes);
  std::string_view line;
  while (lines.Next(&line) && (Trim(line).empty() || Trim(line).starts_with('#'))) {
    if (const std::string_view text = Trim(line); text.size() > 1) comments.emplace_back(Trim(text.substr(1)));
  }
  return comments;
}

}  // namespace

bool IsCornell(std::string_view bytes) {
  const InputFile head = {{}, Head(bytes)};
  WordReader words(head);
  const std::optional<std::string_view> first = words.Next();
  const std::optional<long long> count = first ? ParseInteger(*first) : std::nullopt;
  if (!count || *count < 1 || *count > static_cast<long long>(kMostWavelengths) || !words.RestOfLine().empty()) {
    return false;
  }
  double last = 0;
  for (long long i = 0; i < *count; ++i) {
    const std::optional<std::string_view> word = words.Next();
    const std::optional<double> wavelength = word ? ParseDouble(*word) : std::nullopt;
    if (!wavelength || !IsWavelength(*wavelength) || *wavelength <= last) return false;
    last = *wavelength;
  }
  return true;
}

Measurement ReadCornell(const InputFile& file, const ReadOptions&) {
  WordReader words(file);
  Channels channels = ReadChannels(&words);
  const std::size_t count = channels.size();
  MeasurementBuilder builder(std::move(channels));
  const std::vector<std::string> names = {"theta_i", "phi_i", "theta_o", "phi_o"};
  std::vector<double> angles(4), values(count);
  while (words.Peek()) {
    std::uint32_t line = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      angles[i] = words.FiniteNumber(names[i]);
      if (i == 0) line = static_cast<std::uint32_t>(words.line());
      if (std::fabs(angles[i]) > (i % 2 == 0 ? kPi : 2 * kPi) + 1e-5) {
        words.Fail(names[i] + " is " + FormatDouble(angles[i]) + ", beyond " + (i % 2 == 0 ? "pi" : "2 pi") +
                   "; angles are in radians, each sample has 4 angles and " + std::to_string(count) + " values");
      }
    }
    for (double& value : values) value = words.Number("a value");
    builder.Add(FromSpherical(angles[0], angles[1]), FromSpherical(angles[2], angles[3]), values.data(), line);
  }
  Measurement measurement = builder.Finish();
  measurement.comments = CommentsOf(file.bytes);
  measurement.conventions["angle-unit"] = "rad (format)";
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["incident"] = "towards (format)";
  return measurement;
}

}  // namespace lobefit

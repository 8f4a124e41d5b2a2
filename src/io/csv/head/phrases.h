// What comments and titles state without a key of the program's own: "AOI 30 deg", "theta_i=30, phi_i=90", "BRDF in %".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lobefit/io/csv/head/keys.h"

namespace lobefit {

// "30 deg", "633nm", "0,5": a number and the unit behind it, as PlainUnit gives it.
struct Quantity {
  double number = 0;
  std::string unit;
};
std::optional<Quantity> ParseQuantity(std::string_view text);

// An angle or a wavelength that holds for all rows. All of these change nothing and return false for what they do not
// understand as a whole.
bool ReadCoordinate(std::string_view key, std::string_view word, CsvKeys* keys);
// Several of them in one line: "theta_i=30, phi_i=90", "incident zenith: 30 deg; azimuth: 90 deg".
bool ReadCoordinates(std::string_view text, CsvKeys* keys);
// Without a mark between: "Laser wavelength 632.8 nm".
bool ReadPhrase(std::string_view text, CsvKeys* keys);
// Angles and wavelengths among other things: "Sample A, theta_i = 30", "white tile; AOI: 30 deg".
bool ReadParts(std::string_view text, CsvKeys* keys);
// One angle with its unit beside words for the angle of incidence, amid a title: "BRDF at 30 deg incidence". It gives
// way to keys and columns, and is said where it is used.
bool ReadMention(std::string_view text, CsvKeys* keys);
// "All angles are in radians.", "BRDF values in %".
bool ReadSentence(std::string_view text, CsvKeys* keys);
// "Units: rad, 1/sr", "BRDF unit: %", "unit of theta_i: rad"; `name` is the key in small letters with hyphens.
bool ReadUnits(const std::string& name, std::string_view word, CsvKeys* keys);

}  // namespace lobefit

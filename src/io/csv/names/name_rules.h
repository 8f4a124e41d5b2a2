// Rules by which the words of a name are understood; each sets what it learns in the column and returns whether it
// matches.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/base/text/same_word.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/csv/names/words.h"

namespace lobefit {

using NameList = std::vector<std::string>;

template <std::size_t N>
bool HoldsWord(const std::array<std::string_view, N>& set, std::string_view word) {
  return std::any_of(set.begin(), set.end(), [&](std::string_view known) { return SameWord(known, word); });
}

// Whether one of the parts stands anywhere in the text.
template <std::size_t N>
bool HoldsAnyPart(std::string_view text, const std::array<std::string_view, N>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

// "incident_angle".
std::string Joined(const NameList& words);
// Without "of", "the", "mean" and their like; all of them where nothing else is left.
NameList WithoutFillers(const NameList& words);
bool IsFiller(std::string_view word);

// A name that is none of the grammar's: "aoi", "sza", "beta_s".
struct WholeName {
  std::string_view name;
  ColumnRole role;
  Coordinate coordinate = Coordinate::kThetaI;
};
// By the words joined by "_"; null: none.
const WholeName* FindWholeName(const std::string& joined);
// "cos_sza".
bool ClassifyCosineOfWholeName(std::string_view joined, CsvColumn* column);
// Of columns that nothing needs: "comment", "temperature".
bool IsIgnoredName(std::string_view joined);
// A short name of an angle that means nothing else.
bool IsAngleShorthand(std::string_view word);
// Reads the unit of the column by what the column is; `problem` says what is not known.
void ParseColumnUnit(CsvColumn* column);

// Angles by what kind of angle the words speak of, and of which direction; components of directions.
bool ClassifyAngle(const NameList& words, bool magnitude, CsvColumn* column);
bool ClassifyComponent(const NameList& words, CsvColumn* column);
// True for a word that names a kind of angle.
bool IsAngleWord(std::string_view word);
// Words for the side of the light and for that of the viewer.
bool IsLightWord(std::string_view word);
bool IsViewerWord(std::string_view word);

// Whether the words, joined, name a value; its kind goes to `kind`.
bool NamesValue(const std::string& joined, std::optional<ValueKind>* kind);
bool ClassifyValue(const NameWords& name, CsvColumn* column);
// The first column whose name speaks of a value without saying which ("reflectance", "BRDF_raw"); the number of columns
// where there is none.
std::size_t FindPossibleValue(const std::vector<CsvColumn>& columns);
// "U (k=2)", "2 sigma", "relative uncertainty", "u_rel": how far a number of uncertainty is from a standard deviation.
bool ClassifySpread(const NameWords& name, CsvColumn* column);
// A channel by its letter, colour or wavelength: "R", "550nm", "lambda=550".
bool ClassifyChannel(NameList words, CsvColumn* column);
// A channel beside the name of a value: "brdf_r", "f 550nm".
bool ClassifyValueOfChannel(const NameList& words, CsvColumn* column);
bool ClassifyWavelengthColumn(const NameList& words, CsvColumn* column);
// "AOI=10", "theta_i 30", "BRDF (AOI 10 deg)", "10deg": a column of values at a fixed angle.
bool ClassifyFixed(const NameList& words, CsvColumn* column);

}  // namespace lobefit

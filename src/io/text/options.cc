#include "lobefit/io/text/options.h"

#include <algorithm>
#include <array>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/units.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

template <class Value>
struct Word {
  std::string_view word;
  Value value;
};

// The first word of each value is its name.
constexpr std::array<Word<AngleUnit>, 6> kAngleUnits = {{{"deg", AngleUnit::kDegrees},
                                                         {"rad", AngleUnit::kRadians},
                                                         {"gon", AngleUnit::kGon},
                                                         {"mrad", AngleUnit::kMilliradians},
                                                         {"arcmin", AngleUnit::kArcMinutes},
                                                         {"arcsec", AngleUnit::kArcSeconds}}};
constexpr std::array<Word<ValueKind>, 7> kValueKinds = {{{"f", ValueKind::kBrdf},
                                                         {"f-cos-o", ValueKind::kBrdfCosO},
                                                         {"f-cos-i", ValueKind::kBrdfCosI},
                                                         {"pi-f", ValueKind::kReflectanceFactor},
                                                         {"intensity", ValueKind::kIntensity},
                                                         {"pi-f-cos-o", ValueKind::kReading},
                                                         {"pi-f-cos-i", ValueKind::kReflectanceCosI}}};
constexpr std::array<Word<IncidentSense>, 2> kSenses = {
    {{"towards", IncidentSense::kTowardsSource}, {"propagation", IncidentSense::kPropagation}}};
constexpr std::array<Word<CellPosition>, 3> kPositions = {
    {{"centre", CellPosition::kCentre}, {"center", CellPosition::kCentre}, {"edge", CellPosition::kEdge}}};

constexpr std::array<Word<Side>, 2> kSides = {{{"front", Side::kFront}, {"back", Side::kBack}}};
constexpr std::array<Word<XmlNaming>, 2> kXmlNamings = {{{"window", XmlNaming::kWindow}, {"plain", XmlNaming::kPlain}}};
constexpr std::array<Word<int>, 3> kSigns = {{{"+1", 1}, {"1", 1}, {"-1", -1}}};
constexpr std::array<Word<IntervalKind>, 2> kIntervals = {
    {{"bounds", IntervalKind::kBounds}, {"offsets", IntervalKind::kOffsets}}};
constexpr std::array<Word<MountainAzimuth>, 2> kMountainAzimuths = {
    {{"file", MountainAzimuth::kFile}, {"up", MountainAzimuth::kUp}}};
constexpr std::array<Word<RepeatedRows>, 2> kRepeated = {
    {{"first", RepeatedRows::kFirst}, {"mean", RepeatedRows::kMean}}};
constexpr std::array<Word<UtiaEncoding>, 2> kUtiaEncodings = {
    {{"raw", UtiaEncoding::kRaw}, {"srgb", UtiaEncoding::kSrgb}}};
constexpr std::array<Word<ExrAxes>, 4> kExrAxes = {{{"slice", ExrAxes::kSlice},
                                                    {"slice-sqrt", ExrAxes::kSliceSqrt},
                                                    {"hemisphere", ExrAxes::kHemisphere},
                                                    {"utia", ExrAxes::kUtia}}};
constexpr std::array<Word<ExrProjection>, 3> kExrProjections = {{{"equidistant", ExrProjection::kEquidistant},
                                                                 {"equal-area", ExrProjection::kEqualArea},
                                                                 {"concentric", ExrProjection::kConcentric}}};
constexpr std::array<Word<ExrRows>, 2> kExrRows = {{{"up", ExrRows::kUp}, {"down", ExrRows::kDown}}};

template <class Table>
auto Find(const Table& table, std::string_view word) -> std::optional<decltype(table[0].value)> {
  const std::string lower = ToLower(Trim(word));
  for (const auto& entry : table) {
    if (entry.word == lower) return entry.value;
  }
  return std::nullopt;
}

template <class Table, class Value>
std::string NameIn(const Table& table, Value value) {
  for (const auto& entry : table) {
    if (entry.value == value) return std::string(entry.word);
  }
  return "";
}

// The value of a word, or a UsageError that names the option.
template <class Table>
auto Require(const Table& table, const char* option, const std::string& word) -> decltype(table[0].value) {
  const auto value = Find(table, word);
  if (value) return *value;
  std::vector<std::string> words;
  for (const auto& entry : table) words.emplace_back(entry.word);
  throw UsageError("--" + std::string(option) + " " + Excerpt(word) + ": allowed are " + Join(words));
}

double RequireNumber(const char* option, const std::string& word, double low, double high) {
  const std::optional<double> number = ParseDouble(word);
  if (!number || !(*number >= low && *number <= high)) {
    throw UsageError("--" + std::string(option) + " " + Excerpt(word) + ": a number from " + FormatDouble(low) +
                     " to " + FormatDouble(high) + " is allowed");
  }
  return *number;
}

}  // namespace

std::optional<ValueKind> ParseValueKind(std::string_view word) { return Find(kValueKinds, word); }
std::optional<IncidentSense> ParseIncidentSense(std::string_view word) { return Find(kSenses, word); }
std::optional<RepeatedRows> ParseRepeatedRows(std::string_view word) { return Find(kRepeated, word); }
std::optional<CellPosition> ParseCellPosition(std::string_view word) { return Find(kPositions, word); }

std::optional<UtiaEncoding> ParseUtiaEncoding(std::string_view word) { return Find(kUtiaEncodings, word); }
std::optional<ExrAxes> ParseExrAxes(std::string_view word) { return Find(kExrAxes, word); }
std::optional<ExrProjection> ParseExrProjection(std::string_view word) { return Find(kExrProjections, word); }
std::optional<ExrRows> ParseExrRows(std::string_view word) { return Find(kExrRows, word); }

std::string AllowedValueKinds() {
  std::vector<std::string> words;
  for (const auto& entry : kValueKinds) words.emplace_back(entry.word);
  return Join(words);
}

std::string Name(AngleUnit unit) { return NameIn(kAngleUnits, unit); }
std::string Name(ValueKind kind) { return NameIn(kValueKinds, kind); }
std::string Name(IncidentSense sense) { return NameIn(kSenses, sense); }
std::string Name(RepeatedRows rows) { return NameIn(kRepeated, rows); }
std::string Name(CellPosition position) { return NameIn(kPositions, position); }
std::string Name(UtiaEncoding encoding) { return NameIn(kUtiaEncodings, encoding); }
std::string Name(ExrAxes axes) { return NameIn(kExrAxes, axes); }
std::string Name(ExrProjection projection) { return NameIn(kExrProjections, projection); }
std::string Name(ExrRows rows) { return NameIn(kExrRows, rows); }

const std::vector<ReadOptionEntry>& ReadOptionTable() {
  using Options = ReadOptions*;
  using Word = const std::string&;
  static const std::vector<ReadOptionEntry> table = {
      {"noise-floor",
       "SIGMA",
       "standard deviation of the reading f cos(theta_i), becomes weights",
       {},
       [](Options o, Word w) { o->noise_floor = RequireNumber("noise-floor", w, 1e-300, 1e300); }},
      {"repeated",
       "first|mean",
       "what becomes of rows with the same directions",
       {"csv"},
       [](Options o, Word w) { o->repeated = Require(kRepeated, "repeated", w); }},
      {"angle-unit",
       "deg|rad|gon|mrad",
       "unit of the angles",
       {"csv", "astm"},
       [](Options o, Word w) {
         o->angle_unit = ParseAngleUnit(w);
         if (!o->angle_unit) Require(kAngleUnits, "angle-unit", w);
       }},
      {"columns",
       "MEANING=COLUMN,...",
       "what columns mean, as in theta_i=zenith_1,theta_o=#3,f=reading",
       {"csv"},
       [](Options o, Word w) { o->columns = w; }},
      {"where",
       "COLUMN=VALUE,...",
       "only the rows with these values, as in pol=s",
       {"csv"},
       [](Options o, Word w) { o->where = w; }},
      {"wavelength-tolerance",
       "NM",
       "wavelengths of rows that differ by no more than so many nanometres are one channel",
       {"csv"},
       [](Options o, Word w) { o->wavelength_tolerance_nm = RequireNumber("wavelength-tolerance", w, 0, 1e6); }},
      {"no-value",
       "LIST",
       "numbers and words that stand for no value, as in 0,-999,OVER (words: csv)",
       {},
       [](Options o, Word w) { o->no_value = w; }},
      {"exclude",
       "ZONES",
       "what is set aside: specular:DEG, retro:DEG, value<X, value>X, theta-i>DEG, theta-o>DEG, with commas between",
       {},
       [](Options o, Word w) { o->exclude = w; }},
      {"value-scale",
       "UNIT",
       "what the values are in: %, dB, log10, ln, 1e-3/sr, a.u.",
       {"csv"},
       [](Options o, Word w) { o->value_scale = w; }},
      {"value-kind",
       "f|f-cos-o|f-cos-i|pi-f|intensity|pi-f-cos-o|pi-f-cos-i",
       "what the values are",
       {"csv", "alta", "astm", "exr"},
       [](Options o, Word w) { o->value_kind = Require(kValueKinds, "value-kind", w); }},
      {"incident",
       "towards|propagation",
       "sense of the incident direction",
       {"csv", "astm", "fred"},
       [](Options o, Word w) { o->incident_sense = Require(kSenses, "incident", w); }},
      {"value-column",
       "NAME",
       "the column that holds the values",
       {"csv"},
       [](Options o, Word w) { o->value_column = w; }},
      {"merl-cell",
       "centre|edge",
       "where in its cell a sample stands",
       {"merl"},
       [](Options o, Word w) { o->merl_cell = Require(kPositions, "merl-cell", w); }},
      {"side",
       "front|back",
       "side of the sample",
       {"bsdf-xml", "lighttools"},
       [](Options o, Word w) { o->side = Require(kSides, "side", w); }},
      {"xml-naming",
       "window|plain",
       "what 'front' means",
       {"bsdf-xml"},
       [](Options o, Word w) { o->xml_naming = Require(kXmlNamings, "xml-naming", w); }},
      {"xml-wavelength", "NAME", "the block to read", {"bsdf-xml"}, [](Options o, Word w) { o->xml_wavelength = w; }},
      {"zemax-rotation-sign",
       "+1|-1",
       "sense of SampleRotation",
       {"zemax"},
       [](Options o, Word w) { o->zemax_rotation_sign = Require(kSigns, "zemax-rotation-sign", w); }},
      {"lighttools-azimuth",
       "DEGREES",
       "azimuth of the light at POI 0",
       {"lighttools"},
       [](Options o, Word w) { o->lighttools_azimuth_deg = RequireNumber("lighttools-azimuth", w, -360, 360); }},
      {"alta-interval",
       "bounds|offsets",
       "what the two columns of #VS 2 are",
       {"alta"},
       [](Options o, Word w) { o->alta_interval = Require(kIntervals, "alta-interval", w); }},
      {"mountain-azimuth",
       "file|up",
       "azimuths as they are, or 'up' turned to +y",
       {"mountain"},
       [](Options o, Word w) { o->mountain_azimuth = Require(kMountainAzimuths, "mountain-azimuth", w); }},
      {"mit-cell",
       "centre|edge",
       "where in its cell a sample stands",
       {"mit"},
       [](Options o, Word w) { o->mit_cell = Require(kPositions, "mit-cell", w); }},
      {"mit-scale",
       "FACTOR",
       "factor of the stored values, default 10",
       {"mit"},
       [](Options o, Word w) { o->mit_scale = RequireNumber("mit-scale", w, 1e-12, 1e12); }},
      {"mit-stride",
       "N",
       "every N-th azimuth, default as many as keep 4 million cells",
       {"mit"},
       [](Options o, Word w) { o->mit_stride = static_cast<int>(RequireNumber("mit-stride", w, 1, 1000)); }},
      {"utia-encoding",
       "raw|srgb",
       "how the values are encoded",
       {"utia"},
       [](Options o, Word w) { o->utia_encoding = Require(kUtiaEncodings, "utia-encoding", w); }},
      {"utia-scale",
       "FACTOR",
       "factor of the values, default 1",
       {"utia"},
       [](Options o, Word w) { o->utia_scale = RequireNumber("utia-scale", w, 1e-12, 1e12); }},
      {"exr-axes",
       "slice|slice-sqrt|hemisphere|utia",
       "what the pixels are",
       {"exr"},
       [](Options o, Word w) { o->exr_axes = Require(kExrAxes, "exr-axes", w); }},
      {"exr-projection",
       "equidistant|equal-area|concentric",
       "projection of a hemisphere",
       {"exr"},
       [](Options o, Word w) { o->exr_projection = Require(kExrProjections, "exr-projection", w); }},
      {"exr-rows",
       "up|down",
       "whether theta_d grows upwards",
       {"exr"},
       [](Options o, Word w) { o->exr_rows = Require(kExrRows, "exr-rows", w); }},
      {"exr-phi-d",
       "DEGREES",
       "phi_d of a slice, default 90",
       {"exr"},
       [](Options o, Word w) { o->exr_phi_d_deg = RequireNumber("exr-phi-d", w, -360, 360); }},
      {"exr-theta-i",
       "DEGREES",
       "polar angle of the light of a hemisphere",
       {"exr"},
       [](Options o, Word w) { o->exr_theta_i_deg = RequireNumber("exr-theta-i", w, 0, 90); }},
      {"exr-phi-i",
       "DEGREES",
       "azimuth of the light of a hemisphere",
       {"exr"},
       [](Options o, Word w) { o->exr_phi_i_deg = RequireNumber("exr-phi-i", w, -360, 360); }},
  };
  return table;
}

void CheckOptionOf(const ReadOptionEntry& option, const std::string& format, const std::string& file) {
  if (option.formats.empty() ||
      std::find(option.formats.begin(), option.formats.end(), format) != option.formats.end()) {
    return;
  }
  std::string own;
  for (const ReadOptionEntry& other : ReadOptionTable()) {
    if (std::find(other.formats.begin(), other.formats.end(), format) == other.formats.end()) continue;
    own += (own.empty() ? "" : ", ") + std::string("--") + other.name;
  }
  throw UsageError("--" + std::string(option.name) + " is an option of " + Join(option.formats) + ", and " + file +
                   " is " + format + "; leave it out" + (own.empty() ? "" : " (" + format + " has " + own + ")"));
}

double BrdfFactor(ValueKind kind, double cos_theta_i, double cos_theta_o) {
  const double per_cos_o = cos_theta_o > 0 ? 1 / cos_theta_o : 1;
  switch (kind) {
    case ValueKind::kBrdf:
      return 1;
    case ValueKind::kBrdfCosO:
    case ValueKind::kIntensity:
      return per_cos_o;
    case ValueKind::kBrdfCosI:
      return cos_theta_i > 0 ? 1 / cos_theta_i : 1;
    case ValueKind::kReflectanceFactor:
      return kInvPi;
    case ValueKind::kReading:
      return kInvPi * per_cos_o;
    case ValueKind::kReflectanceCosI:
      return cos_theta_i > 0 ? kInvPi / cos_theta_i : kInvPi;
  }
  return 1;
}

}  // namespace lobefit

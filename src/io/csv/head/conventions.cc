#include "lobefit/io/csv/head/conventions.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

enum class Side { kNone, kMirror, kLight };

// Parts of words, so that endings and letters with accents do not matter.
constexpr std::array<std::string_view, 9> kMirror = {"forward", "specular", "mirror",    "spiegel", "glanz",
                                                     "vorw",    "culaire",  "speculare", "miroir"};
constexpr std::array<std::string_view, 8> kLight = {"backscatter", "backward", "retro",  "ckw",
                                                    "source",      "lamp",     "quelle", "hotspot"};
constexpr std::array<std::string_view, 3> kAzimuth = {"azim", "acimut", "\xcf\x86"};
constexpr std::array<std::string_view, 10> kViewer = {"scatter",     "detector",        "viewing",   "receiver",
                                                      "observation", "detektor",        "streuwink", "beobach",
                                                      "diffus",      "reflexionswinkel"};
constexpr std::array<std::string_view, 4> kIncident = {"incident", "incoming", "einfall", "incidence"};

Side SideOf(std::string_view word) {
  return HoldsAnyPart(word, kMirror) ? Side::kMirror : HoldsAnyPart(word, kLight) ? Side::kLight : Side::kNone;
}

// 0 or 180 degrees, however the unit is written behind it.
std::optional<double> HalfTurnOf(std::string_view word) {
  if (word == "zero" || word == "null") return 0.0;
  std::size_t digits = 0;
  while (digits < word.size() &&
         (word[digits] == '.' || word[digits] == '-' || (word[digits] >= '0' && word[digits] <= '9')))
    ++digits;
  const std::optional<double> number = ParseDouble(word.substr(0, digits));
  if (!number || (*number != 0 && *number != 180 && *number != -180)) return std::nullopt;
  return *number;
}

// Parts of the sentence between commas, brackets and stops, each as its words in small letters.
std::vector<std::vector<std::string>> ClausesOf(std::string_view text) {
  std::vector<std::vector<std::string>> clauses(1);
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) clauses.back().push_back(std::move(word));
    word.clear();
  };
  const std::string lower = ToLower(text);
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const char c = lower[i];
    const bool stop = c == '.' && (i + 1 == lower.size() || lower[i + 1] == ' ');
    if (stop || std::string_view(",;()[]").find(c) != std::string_view::npos) {
      end_word();
      if (!clauses.back().empty()) clauses.emplace_back();
    } else if (std::string_view(" \t=:'\"").find(c) != std::string_view::npos) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
  return clauses;
}

bool IsFrom(std::string_view word) {
  static constexpr std::array<std::string_view, 8> kFrom = {"from",   "von",   "vom",   "ab",
                                                            "depuis", "dalla", "desde", "dal"};
  return std::find(kFrom.begin(), kFrom.end(), word) != kFrom.end();
}

// The side that azimuth 0 lies on: of each word for a side by the 0 or 180 next to it, or by a "from" before it.
std::vector<Side> SidesOfZero(const std::vector<std::string>& words) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Side side = SideOf(words[i]);
    if (side == Side::kNone || (i + 1 < words.size() && words[i + 1] == "plane")) continue;
    std::optional<double> nearest;
    std::size_t distance = words.size();
    for (std::size_t k = 0; k < words.size(); ++k) {
      const std::optional<double> number = HalfTurnOf(words[k]);
      const std::size_t away = k > i ? k - i : i - k;
      if (number && away < distance) nearest = number, distance = away;
    }
    if (nearest) {
      sides.push_back(*nearest == 0 ? side : side == Side::kMirror ? Side::kLight : Side::kMirror);
      continue;
    }
    constexpr std::size_t kNear = 4;
    for (std::size_t k = i - std::min(i, kNear); k < i; ++k) {
      if (IsFrom(words[k])) sides.push_back(side);
    }
  }
  return sides;
}

bool ReadAzimuthZero(std::size_t line, const std::vector<std::vector<std::string>>& clauses, CsvKeys* keys) {
  std::vector<Side> sides;
  std::vector<std::string> all;
  for (const std::vector<std::string>& clause : clauses) {
    for (const Side side : SidesOfZero(clause)) sides.push_back(side);
    all.insert(all.end(), clause.begin(), clause.end());
  }
  if (sides.empty()) sides = SidesOfZero(all);
  if (sides.empty() || std::count(sides.begin(), sides.end(), sides[0]) != static_cast<std::ptrdiff_t>(sides.size()))
    return false;
  keys->incident_sense = sides[0] == Side::kMirror ? IncidentSense::kPropagation : IncidentSense::kTowardsSource;
  if (sides[0] == Side::kMirror) {
    keys->remarks.push_back("line " + std::to_string(line) +
                            ": azimuths count from the mirror's side, as the line says; --incident towards "
                            "reads them from the light's");
  }
  return true;
}

// What the viewer's angles are related to: "relative to", "measured from", "bezogen auf", "par rapport a".
bool ReadViewerZero(std::size_t line, const std::vector<std::string>& words, CsvKeys* keys) {
  static constexpr std::array<std::string_view, 9> kRelation = {"relative", "respect", "relativ",  "bezogen", "gegen",
                                                                "rapport",  "relatif", "rispetto", "respecto"};
  if (std::none_of(words.begin(), words.end(), [](const std::string& word) { return HoldsAnyPart(word, kViewer); }))
    return false;
  if (std::find(words.begin(), words.end(), "not") != words.end()) return false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!IsFrom(words[i]) && !HoldsAnyPart(words[i], kRelation)) continue;
    constexpr std::size_t kNear = 4;
    for (std::size_t k = i + 1; k < std::min(words.size(), i + 1 + kNear); ++k) {
      if (HoldsAnyPart(words[k], kMirror)) {
        keys->viewer_zero = ViewerZero::kMirror;
        keys->remarks.push_back("line " + std::to_string(line) +
                                ": the viewer's angles count from the mirror direction, as the line says; --columns "
                                "theta_o=NAME reads them from the normal");
        return true;
      }
      if (HoldsAnyPart(words[k], kIncident)) {
        keys->viewer_zero = ViewerZero::kIncidentBeam;
        return true;
      }
    }
  }
  return false;
}

constexpr std::array<std::string_view, 4> kAngleParts = {"angle", "winkel", "angulo", "angolo"};
constexpr std::array<std::string_view, 4> kLightParts = {"inciden", "einfall", "illumin", "light"};

// Words of a sentence about angles that say nothing of where they count from.
bool IsBesideAngle(std::string_view word) {
  static constexpr std::array<std::string_view, 36> kBeside = {
      "all",   "both",    "the",      "are",     "is",    "as",       "in",      "of",     "and",
      "polar", "zenith",  "measured", "counted", "given", "taken",    "defined", "stated", "relative",
      "with",  "respect", "to",       "degrees", "deg",   "rad",      "radians", "sample", "plane",
      "alle",  "die",     "der",      "sind",    "und",   "gemessen", "strahl",  "theta",  "parallel"};
  return std::find(kBeside.begin(), kBeside.end(), word) != kBeside.end() || HoldsAnyPart(word, kLightParts) ||
         HoldsAnyPart(word, kViewer) || word.find_first_not_of("0123456789.=") == std::string_view::npos;
}

// Whether the words before `at` speak of an angle: "angle of incidence is measured" before "from".
bool FollowsAngle(const std::vector<std::string>& words, std::size_t at) {
  while (at > 0 && IsBesideAngle(words[at - 1])) --at;
  return at > 0 && HoldsAnyPart(words[at - 1], kAngleParts);
}

bool IsSurface(std::string_view word) {
  static constexpr std::array<std::string_view, 7> kSurface = {
      "surface", "horizon", "oberfl\u00e4che", "oberflaeche", "surfaces", "superficie", "ebene"};
  return std::find(kSurface.begin(), kSurface.end(), word) != kSurface.end();
}

// "grazing angles", "all angles are elevation angles (0 = parallel)"; not "grazing angles are left out".
bool AreGrazing(const std::vector<std::string>& words, std::size_t at) {
  if ((words[at] != "grazing" && words[at] != "elevation") || at + 1 == words.size() ||
      !HoldsAnyPart(words[at + 1], kAngleParts))
    return false;
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return &word == &words[at] || IsBesideAngle(word) || HoldsAnyPart(word, kAngleParts) || IsSurface(word);
  });
}

// "All angles are measured from the surface", "grazing angles", "Winkel zur Oberflaeche": of the light's, of the
// viewer's, or of both where none is named. Light is scattered "from the surface" too, at angles from the normal.
bool ReadSurface(std::size_t line, const std::vector<std::string>& words, CsvKeys* keys) {
  static constexpr std::array<std::string_view, 5> kRelation = {"to", "respect", "relative", "zur", "gegen"};
  const auto any = [&](const auto& parts) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return HoldsAnyPart(word, parts); });
  };
  if (!any(kAngleParts)) return false;
  bool found = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "not" || HoldsAnyPart(words[i], std::array<std::string_view, 3>{"normal", "senkrecht", "lot"}))
      return false;
    found = found || AreGrazing(words, i);
    if (!IsSurface(words[i])) continue;
    for (std::size_t k = i - std::min<std::size_t>(i, 3); k < i; ++k) {
      const bool relation = IsFrom(words[k]) || HoldsAnyPart(words[k], std::array<std::string_view, 1>{"zwischen"}) ||
                            std::find(kRelation.begin(), kRelation.end(), words[k]) != kRelation.end();
      found = found || (relation && FollowsAngle(words, k));
    }
  }
  if (!found) return false;
  const bool light = any(kLightParts), viewer = any(kViewer);
  keys->light_from_surface = keys->light_from_surface || light || !viewer;
  keys->viewer_from_surface = keys->viewer_from_surface || viewer || !light;
  keys->remarks.push_back(
      "line " + std::to_string(line) +
      ": polar angles count from the surface, as the line says; --columns theta_i=NAME,theta_o=NAME "
      "reads them from the normal");
  return true;
}

}  // namespace

bool ReadConvention(std::size_t line, std::string_view text, CsvKeys* keys) {
  constexpr std::size_t kMostLetters = 300;  // more are a description
  if (text.size() > kMostLetters || text.size() < 8) return false;
  const std::vector<std::vector<std::string>> clauses = ClausesOf(text);
  const auto is_azimuth = [](const std::string& word) {
    return HoldsAnyPart(word, kAzimuth) || word == "phi" || word == "raa" || word == "dphi";
  };
  for (const std::vector<std::string>& clause : clauses) {
    if (std::any_of(clause.begin(), clause.end(), is_azimuth)) return ReadAzimuthZero(line, clauses, keys);
  }
  for (const std::vector<std::string>& clause : clauses) {
    if (ReadViewerZero(line, clause, keys) || ReadSurface(line, clause, keys)) return true;
  }
  return false;
}

void TakeConventionsOfNames(std::size_t line, std::vector<CsvColumn>* columns, CsvKeys* keys) {
  for (CsvColumn& column : *columns) {
    const std::size_t open = column.name.find_first_of("([");
    if (column.role != ColumnRole::kUnknown || open == std::string::npos) continue;
    CsvColumn bare = ClassifyColumn(std::string_view(column.name).substr(0, open));
    if (bare.role != ColumnRole::kCoordinate || !ReadConvention(line, column.name, keys)) continue;
    bare.name = std::move(column.name);
    column = std::move(bare);
  }
}

}  // namespace lobefit

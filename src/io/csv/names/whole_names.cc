#include <algorithm>
#include <array>

#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

constexpr std::array<WholeName, 56> kWholeNames = {{
    {"emi", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"pha", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"aoi", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"incidence", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"incident", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"inc", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"einfallswinkel", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"sza", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"iza", ColumnRole::kCoordinate, Coordinate::kThetaI},
    {"saa", ColumnRole::kCoordinate, Coordinate::kPhiI},
    {"iaa", ColumnRole::kCoordinate, Coordinate::kPhiI},
    {"vza", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"oza", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"receive", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"emission", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"emergence", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"viewing", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"ausfallswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"streuwinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"beobachtungswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"detektorwinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"reflexionswinkel", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aor", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aov", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"aos", ColumnRole::kCoordinate, Coordinate::kThetaO},
    {"vaa", ColumnRole::kCoordinate, Coordinate::kPhiO},
    {"oaa", ColumnRole::kCoordinate, Coordinate::kPhiO},
    {"raa", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"dphi", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"dazimuth", ColumnRole::kCoordinate, Coordinate::kDeltaPhi},
    {"phase", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"phase_angle", ColumnRole::kCoordinate, Coordinate::kPhase},
    {"delta_theta", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"dtheta", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"aspecular", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"aspecular_angle", ColumnRole::kCoordinate, Coordinate::kFromSpecular},
    {"bistatic", ColumnRole::kCoordinate, Coordinate::kBistatic},
    {"bistatic_angle", ColumnRole::kCoordinate, Coordinate::kBistatic},
    {"deviation_angle", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"angle_of_deviation", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"total_deviation", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"total_deviation_angle", ColumnRole::kCoordinate, Coordinate::kDeviation},
    {"beta_0", ColumnRole::kCoordinate, Coordinate::kBeta0},
    {"beta", ColumnRole::kCoordinate, Coordinate::kBeta},
    {"beta_s", ColumnRole::kCoordinate, Coordinate::kBeta},
    {"beta_beta_0", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"b_b0", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"delta_beta", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"dbeta", ColumnRole::kCoordinate, Coordinate::kBetaOffset},
    {"sample_rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"sample_azimuth", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"stage_rotation", ColumnRole::kCoordinate, Coordinate::kSampleRotation},
    {"weight", ColumnRole::kWeight},
    {"weights", ColumnRole::kWeight},
    {"fr_authors_formula", ColumnRole::kOtherValue},
}};

constexpr std::array<std::string_view, 55> kIgnored = {"index",
                                                       "id",
                                                       "no",
                                                       "nr",
                                                       "row",
                                                       "rows",
                                                       "n",
                                                       "num",
                                                       "number",
                                                       "#",
                                                       "point",
                                                       "time",
                                                       "date",
                                                       "datetime",
                                                       "timestamp",
                                                       "temperature",
                                                       "temp",
                                                       "humidity",
                                                       "comment",
                                                       "comments",
                                                       "remark",
                                                       "remarks",
                                                       "note",
                                                       "notes",
                                                       "operator",
                                                       "file",
                                                       "filename",
                                                       "l_o_raw",
                                                       "radiance",
                                                       "irradiance",
                                                       "raw",
                                                       "counts",
                                                       "signal",
                                                       "dark",
                                                       "reference",
                                                       "gain",
                                                       "exposure",
                                                       "exposure_time",
                                                       "integration_time",
                                                       "power",
                                                       "distance",
                                                       "solid_angle",
                                                       "aperture",
                                                       "user",
                                                       "sample",
                                                       "material",
                                                       "status",
                                                       "flag",
                                                       "scan",
                                                       "step",
                                                       "unnamed",
                                                       "unnamed_0",
                                                       "voltage",
                                                       "current",
                                                       "background"};

// Short names of angles that mean nothing else.
constexpr std::array<std::string_view, 18> kAngleShorthands = {"aoi", "aor",  "aos",    "aov",      "sza",       "iza",
                                                               "saa", "iaa",  "vza",    "oza",      "vaa",       "oaa",
                                                               "raa", "dphi", "dtheta", "dazimuth", "aspecular", "psi"};

}  // namespace

const WholeName* FindWholeName(const std::string& joined) {
  const auto* const found = std::find_if(kWholeNames.begin(), kWholeNames.end(),
                                         [&](const WholeName& n) { return SameWord(n.name, joined); });
  return found == kWholeNames.end() ? nullptr : found;
}

bool IsIgnoredName(std::string_view joined) { return HoldsWord(kIgnored, joined); }
bool IsAngleShorthand(std::string_view word) { return HoldsWord(kAngleShorthands, word); }

bool ClassifyCosineOfWholeName(std::string_view joined, CsvColumn* column) {
  if (!joined.starts_with("cos_")) return false;
  const auto* const synonym = std::find_if(kWholeNames.begin(), kWholeNames.end(),
                                           [&](const WholeName& n) { return n.name == joined.substr(4); });
  if (synonym == kWholeNames.end() || synonym->role != ColumnRole::kCoordinate ||
      (synonym->coordinate != Coordinate::kThetaI && synonym->coordinate != Coordinate::kThetaO))
    return false;
  column->role = ColumnRole::kCoordinate;
  column->coordinate = synonym->coordinate;
  column->form = AngleForm::kCosine;
  return true;
}

}  // namespace lobefit

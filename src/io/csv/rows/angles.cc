#include "lobefit/io/csv/rows/angles.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/csv/rows/geometries.h"
#include "lobefit/io/csv/rows/short_names.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using C = Coordinate;

bool IsSine(C coordinate) { return coordinate == C::kBeta || coordinate == C::kBeta0 || coordinate == C::kBetaOffset; }
bool IsComponent(C coordinate) { return coordinate >= C::kWiX && coordinate <= C::kWoZ; }

class AngleFinder {
 public:
  AngleFinder(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
              std::vector<CsvColumn>* columns, CsvLayout* layout, Measurement* notes)
      : file_(file),
        header_(header),
        options_(options),
        columns_(*columns),
        layout_(*layout),
        notes_(*notes),
        head_(header.head_coordinate) {}

  void Find() {
    NameShortAngles(&columns_);
    DropCosines();
    ChooseUnit();
    ResolveLetters();
    ResolveDifferences();
    ResolveLone();
    ResolveSurface();
    ResolveViewerZero();
    ResolvePhase();
    DropRedundant();
    Give();
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { FailAtLine(file_, header_.names_line, what); }

  CsvColumn* Column(C coordinate) {
    for (CsvColumn& column : columns_) {
      if (column.role == ColumnRole::kCoordinate && column.coordinate == coordinate) return &column;
    }
    return nullptr;
  }
  // Columns of that meaning; the columns of a table whose names are its values count as one.
  std::size_t Count(C coordinate) const {
    const auto in_rows = std::count_if(columns_.begin(), columns_.end(), [&](const CsvColumn& column) {
      return column.role == ColumnRole::kCoordinate && column.coordinate == coordinate;
    });
    return static_cast<std::size_t>(in_rows) + (InNames(coordinate) ? 1 : 0);
  }
  bool InNames(C coordinate) const {
    return head_ == coordinate || std::any_of(columns_.begin(), columns_.end(), [&](const CsvColumn& column) {
             return column.role == ColumnRole::kFixed && column.coordinate == coordinate;
           });
  }
  // How messages name what has that meaning.
  std::string NameOf(C coordinate, const char* in_names) {
    const CsvColumn* column = Column(coordinate);
    return column != nullptr ? column->name : in_names;
  }
  // Stated by a column, a key, or the names of the columns of a table.
  bool Known(C coordinate) {
    return Column(coordinate) != nullptr || header_.keys.Find(coordinate) != nullptr || InNames(coordinate);
  }
  void Become(C from, C to) {
    for (CsvColumn& column : columns_) {
      const bool angle = column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kFixed;
      if (angle && column.coordinate == from) column.coordinate = to;
    }
    if (head_ == from) head_ = to;
  }

  void ChooseUnit() {
    default_unit_ = options_.angle_unit.value_or(header_.keys.angle_unit.value_or(AngleUnit::kDegrees));
    bool by_name = false;
    for (const CsvColumn& column : columns_)
      by_name = by_name || (column.role == ColumnRole::kCoordinate && column.angle_unit && !options_.angle_unit);
    const char* origin = options_.angle_unit ? "option" : header_.keys.angle_unit ? "header" : "default";
    notes_.conventions["angle-unit"] = by_name ? "by column names" : Name(default_unit_) + " (" + origin + ")";
  }

  double Scale(const CsvColumn& column) const {
    return column.form == AngleForm::kCosine ? 1 : Scale(column.coordinate, column.angle_unit);
  }
  double Scale(C coordinate, const std::optional<AngleUnit>& own) const {
    if (IsSine(coordinate) || IsComponent(coordinate)) return 1;
    return RadiansPerUnit(own && !options_.angle_unit ? *own : default_unit_);
  }

  // Names that are not understood, with letters beyond ASCII: in another encoding they may be others.
  bool HasGarbledName() const {
    return std::any_of(columns_.begin(), columns_.end(), [](const CsvColumn& column) {
      return column.role == ColumnRole::kUnknown && std::any_of(column.name.begin(), column.name.end(), [](char c) {
               return static_cast<unsigned char>(c) >= 0x80;
             });
    });
  }

  // "theta_s" is the sun where theta_v or theta_r stands beside it and no other name is the light's.
  void ResolveLetters() {
    for (const auto& [viewer, light] : {std::pair{C::kThetaO, C::kThetaI}, std::pair{C::kPhiO, C::kPhiI}}) {
      if (Count(viewer) != 2 || Known(light)) continue;
      for (CsvColumn& column : columns_) {
        if (column.role == ColumnRole::kCoordinate && column.coordinate == viewer && column.letter_s)
          column.coordinate = light;
      }
    }
  }

  // "d" is the difference angle beside theta_h, else a detector's or, of an azimuth alone, the difference of azimuths.
  void ResolveDifferences() {
    if (Known(C::kThetaH)) return;
    const bool detector = Column(C::kThetaD) != nullptr;
    Become(C::kPhiD, detector ? C::kPhiO : C::kDeltaPhi);
    Become(C::kThetaD, C::kThetaO);
  }

  // Where a sentence of the file says that polar angles count from the surface. An explicit choice goes first.
  bool CountsFromSurface(C coordinate) const {
    const bool light = coordinate == C::kThetaI;
    if (!light && coordinate != C::kThetaO) return false;
    return (light ? header_.keys.light_from_surface : header_.keys.viewer_from_surface) &&
           options_.columns.find(light ? "theta_i=" : "theta_o=") == std::string::npos;
  }
  void ResolveSurface() {
    for (CsvColumn& column : columns_) {
      if ((column.role == ColumnRole::kCoordinate || column.role == ColumnRole::kFixed) &&
          column.form == AngleForm::kPolar && CountsFromSurface(column.coordinate))
        column.form = AngleForm::kElevation;
    }
  }

  bool HasLight() { return Known(C::kThetaI) || Known(C::kBeta0); }
  bool HasViewer() {
    return Known(C::kThetaO) || Known(C::kFromSpecular) || Known(C::kBistatic) || Known(C::kDeviation) ||
           Known(C::kBeta) || Known(C::kBetaOffset);
  }

  void ResolveLone() {
    if (Count(C::kTheta) == 1 && !Known(C::kThetaH)) {
      if (HasLight() && !HasViewer()) {
        Become(C::kTheta, C::kThetaO);
      } else if (HasViewer() && !HasLight()) {
        Become(C::kTheta, C::kThetaI);
      } else if (!HasLight() && !HasViewer()) {
        Fail("the column '" + Excerpt(NameOf(C::kTheta, "theta")) +
             "' can be the light's or the viewer's polar angle; say where the light stands by a line '# theta_i: 30', "
             "by FILE:theta_i=30, or which is which by --columns");
      }
    }
    if (Count(C::kPhi) != 1) return;
    const std::string phi = NameOf(C::kPhi, "phi");
    const CsvColumn* viewer = Column(C::kThetaO);
    const bool three_axis = viewer != nullptr && ToLower(viewer->name).find("receive") != std::string::npos &&
                            ToLower(phi).find("azim") != std::string::npos;
    if (Known(C::kThetaH)) {
      Become(C::kPhi, Known(C::kPhiH) ? C::kPhiD : C::kPhiH);
    } else if (three_axis && !Known(C::kPhiI) && !Known(C::kPhiO)) {
      Become(C::kPhi, C::kAzimuth);
    } else if (Known(C::kPhase)) {
      return;  // the first rows tell
    } else if (Known(C::kPhiI) && !Known(C::kPhiO) && !Known(C::kDeltaPhi)) {
      Become(C::kPhi, C::kPhiO);
    } else if (Known(C::kPhiO) && !Known(C::kPhiI)) {
      Become(C::kPhi, C::kPhiI);
    } else if (!Known(C::kPhiI) && !Known(C::kPhiO) && !Known(C::kDeltaPhi)) {
      notes_.conventions["azimuths"] = Excerpt(phi) + " is relative to the light: 180 degrees is the mirror's side";
      Become(C::kPhi, C::kDeltaPhi);
    }
  }

  // Where a sentence of the file says what the viewer's angles count from. An explicit choice of the column goes first.
  void ResolveViewerZero() {
    const ViewerZero zero = header_.keys.viewer_zero;
    if (zero == ViewerZero::kNotSaid || Count(C::kThetaO) != 1 || options_.columns.find('=') != std::string::npos)
      return;
    if (zero == ViewerZero::kMirror) {
      Become(C::kThetaO, C::kFromSpecular);
      return;
    }
    const std::string name = Excerpt(NameOf(C::kThetaO, "theta_o"));
    Fail("a line says that the angles of '" + name +
         "' count from the incident beam, but not whether from the light or from where it would go on; say it with "
         "--columns \"bistatic=" +
         name + "\" (theta_i + theta_o, 0 is the light), --columns \"deviation angle=" + name +
         "\" (180 degrees less that), or --columns \"theta_o=" + name + "\" if they count from the normal");
  }

  // The angle of a row's field in radians; NaN where it is none.
  double Angle(const std::vector<std::string>& row, const CsvColumn* column) const {
    const auto at = static_cast<std::size_t>(column - columns_.data());
    const std::optional<double> number = at < row.size() ? ParseCsvNumber(row[at], header_.decimal_mark) : std::nullopt;
    if (number && column->form == AngleForm::kCosine) return std::acos(*number);
    return number ? *number * Scale(*column) : std::nan("");
  }

  // Planetary files hold incidence, emission, the azimuth between them and the phase angle, which follows from those.
  // Where the numbers are not bound in this way, azimuth and phase are those of the two directions.
  void ResolvePhase() {
    const CsvColumn* phase = Column(C::kPhase);
    const CsvColumn* azimuth = Column(C::kPhi);
    if (phase == nullptr || azimuth == nullptr) return;
    const CsvColumn* in = Column(C::kThetaI);
    const CsvColumn* out = Column(C::kThetaO);
    if (in == nullptr || out == nullptr) return;
    std::size_t rows = 0, follow = 0;
    for (const std::vector<std::string>& row : header_.first_rows) {
      const double i = Angle(row, in), e = Angle(row, out), psi = Angle(row, azimuth), g = Angle(row, phase);
      if (std::isnan(i + e + psi + g)) continue;
      ++rows;
      const double cos_g = std::cos(i) * std::cos(e) + std::sin(i) * std::sin(e) * std::cos(psi);
      follow += std::fabs(std::acos(std::clamp(cos_g, -1.0, 1.0)) - std::fabs(g)) < 0.02 ? 1 : 0;
    }
    if (10 * follow >= 9 * rows && rows > 0) {
      notes_.remarks.push_back(QuotedName(*phase) + " follows from the other angles and was not used; " +
                               QuotedName(*azimuth) + " is relative to the light");
      Become(C::kPhi, C::kDeltaPhi);
      columns_[static_cast<std::size_t>(phase - columns_.data())].role = ColumnRole::kIgnored;
    } else {
      notes_.remarks.push_back(QuotedName(*phase) +
                               " is not the angle between the two directions: read as the azimuth of the viewer, and " +
                               QuotedName(*azimuth) + " as that of the light");
      Become(C::kPhi, C::kPhiI);
      Become(C::kPhase, C::kPhiO);
    }
  }

  // Cosines beside the angles that they are of, or beside directions that hold them.
  void DropCosines() {
    for (CsvColumn& column : columns_) {
      if (column.role != ColumnRole::kCoordinate || column.form != AngleForm::kCosine) continue;
      const bool beside = std::any_of(columns_.begin(), columns_.end(), [&](const CsvColumn& other) {
        return other.role == ColumnRole::kCoordinate && other.form != AngleForm::kCosine &&
               (other.coordinate == column.coordinate || other.coordinate == C::kThetaH || other.coordinate == C::kWiX);
      });
      if (beside || header_.keys.Find(column.coordinate) != nullptr || InNames(column.coordinate))
        column.role = ColumnRole::kIgnored;
    }
  }

  // Offsets from the mirror direction and phase angles beside what they follow from.
  void DropRedundant() {
    for (CsvColumn& column : columns_) {
      if (column.role != ColumnRole::kCoordinate) continue;
      const bool offset = column.coordinate == C::kFromSpecular || column.coordinate == C::kBetaOffset ||
                          column.coordinate == C::kBeta || column.coordinate == C::kBistatic ||
                          column.coordinate == C::kDeviation;
      const bool sine = column.coordinate == C::kBeta0;
      const bool phase =
          column.coordinate == C::kPhase && (Known(C::kPhiO) || Known(C::kDeltaPhi) || Known(C::kAzimuth));
      if ((offset && Known(C::kThetaO)) || (sine && Known(C::kThetaI)) || phase) column.role = ColumnRole::kIgnored;
    }
    if (Column(C::kBeta) != nullptr || Column(C::kFromSpecular) != nullptr) {
      CsvColumn* offset = Column(C::kBetaOffset);
      if (offset != nullptr) offset->role = ColumnRole::kIgnored;
    }
    if (Known(C::kPhiI) && Known(C::kPhiO) && Column(C::kDeltaPhi) != nullptr) {
      Fail("both phi_o and dphi are given; remove one of them");
    }
  }

  // Of an offset from the mirror direction. That of "aspecular" is a convention that not all keep to: where the first
  // rows would lie beyond the horizon by it, and none without, it is the other one.
  bool IsTowardsLight(const CsvColumn& column) {
    if (!column.aspecular || column.magnitude) return column.reversed;
    const CsvColumn* in = Column(C::kThetaI);
    const FixedCoordinate* fixed = header_.keys.Find(C::kThetaI);
    std::size_t beyond_towards = 0, beyond_away = 0;
    for (const std::vector<std::string>& row : header_.first_rows) {
      const double theta_i = in != nullptr      ? Angle(row, in)
                             : fixed != nullptr ? fixed->number * Scale(C::kThetaI, fixed->unit)
                                                : std::nan("");
      const double offset = Angle(row, &column);
      beyond_towards += std::fabs(theta_i - offset) > kPi / 2 ? 1 : 0;
      beyond_away += std::fabs(theta_i + offset) > kPi / 2 ? 1 : 0;
    }
    const bool towards = beyond_towards == 0 || beyond_away > 0;
    const std::string away = towards ? "theta_o - theta_i" : "theta_i - theta_o";
    notes_.remarks.push_back(QuotedName(column) + " counts from the mirror direction " +
                             (towards ? "towards the light, as in 45as15" : "away from the light") + "; --columns \"" +
                             away + "=" + Excerpt(column.name) + "\" counts it the other way");
    return towards;
  }

  // Vectors along the propagation of the light point into the surface.
  bool PointsDown() {
    const CsvColumn* in = Column(C::kWiZ);
    const CsvColumn* out = Column(C::kWoZ);
    if (in == nullptr || out == nullptr || options_.incident_sense || header_.keys.incident_sense) return false;
    std::size_t rows = 0, down = 0;
    for (const std::vector<std::string>& row : header_.first_rows) {
      const double z_i = Angle(row, in), z_o = Angle(row, out);
      rows += std::isnan(z_i + z_o) ? 0 : 1;
      down += z_i < 0 && z_o > 0 ? 1 : 0;
    }
    return rows > 0 && down == rows;
  }

  void Give() {
    DirectionReader& directions = layout_.directions;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const CsvColumn& column = columns_[i];
      if (column.role != ColumnRole::kCoordinate) continue;
      for (const auto& [coordinate, other] : layout_.coordinates) {
        if (coordinate == column.coordinate)
          Fail(
              "the columns " + QuotedName(columns_[other]) + " and " + QuotedName(column) + " mean the same; " +
              (ToLower(columns_[other].name) == ToLower(column.name)
                   ? "put tables that stand side by side under headings as in 'AOI 10', or into files of their own, or "
                     "remove one of them"
                   : "remove one of them"));
      }
      directions.Give(column.coordinate, Scale(column), column.form);
      if (column.coordinate == C::kFromSpecular || column.coordinate == C::kBetaOffset)
        directions.SetOffset(IsTowardsLight(column), column.magnitude);
      layout_.coordinates.emplace_back(column.coordinate, i);
    }
    const CsvColumn* first = nullptr;
    for (const CsvColumn& column : columns_) {
      if (column.role != ColumnRole::kFixed) continue;
      if (first == nullptr) first = &column;
      if (Scale(column) != Scale(*first) || column.form != first->form)
        Fail("the columns " + QuotedName(*first) + " and " + QuotedName(column) +
             " have different units; use one unit");
      directions.Give(column.coordinate, Scale(column), column.form);
      if (column.fixed_incidence) {
        directions.Give(C::kThetaI, RadiansPerUnit(AngleUnit::kDegrees));
        directions.SetOffset(column.reversed, false);
      }
      if (column.fixed_incidence.has_value() != first->fixed_incidence.has_value()) {
        Fail("the columns " + QuotedName(*first) + " and " + QuotedName(column) +
             " hold values at angles of different kinds; put them into files of their own");
      }
    }
    if (head_) {
      directions.Give(*head_, Scale(*head_, std::nullopt),
                      CountsFromSurface(*head_) ? AngleForm::kElevation : AngleForm::kPolar);
    }
    for (const FixedCoordinate& fixed : header_.keys.fixed) {
      if (directions.Has(fixed.coordinate)) continue;
      const bool from_surface = fixed.form == AngleForm::kPolar && CountsFromSurface(fixed.coordinate);
      directions.Give(fixed.coordinate, Scale(fixed.coordinate, fixed.unit),
                      from_surface ? AngleForm::kElevation : fixed.form);
      layout_.fixed[static_cast<std::size_t>(fixed.coordinate)] = fixed.number;
      const std::string& mention = header_.keys.mention_of_incidence;
      if (fixed.coordinate == C::kThetaI && !mention.empty()) {
        notes_.remarks.push_back("the angle of incidence is " + FormatDouble(fixed.number) + ", as the line '" +
                                 Excerpt(mention, 60) + "' says");
      }
    }
    if (directions.Has(C::kPhiO) && directions.Has(C::kDeltaPhi))
      Fail("both phi_o and dphi are given; remove one of them");
    const bool other_phi = directions.Has(C::kPhiO) || directions.Has(C::kDeltaPhi) || directions.Has(C::kPhiI);
    if (directions.Has(C::kAzimuth) && other_phi)
      Fail("both azimuth and phi columns are given; name them phi_i and phi_o");
    const bool azimuths = other_phi || directions.Has(C::kAzimuth) || directions.Has(C::kPhase) ||
                          directions.Has(C::kThetaH) || directions.Has(C::kWiX) || Column(C::kPhi) != nullptr;
    if (!header_.keys.lone_azimuth.empty() && !azimuths) {
      Fail(
          "the head states '" + Excerpt(header_.keys.lone_azimuth, 40) +
          "', which does not say whose azimuth it is; name it phi_i, phi_o or dphi (180 degrees is the mirror's side)");
    }
    const std::string missing = directions.Missing();
    if (!missing.empty()) {
      const std::string geometry = DescribeGeometries(columns_, header_.first_rows);
      if (!geometry.empty()) Fail(geometry);
    }
    if (!missing.empty()) {
      std::vector<std::string> names;
      for (const CsvColumn& column : columns_) names.push_back(Excerpt(column.name));
      Fail("no column holds " + missing + "; the columns are " + Excerpt(Join(names), 200) +
           (missing.find("(theta_") == std::string::npos
                ? ""
                : "; an angle that all rows share is stated by a line '# theta_i: 30', or by FILE:theta_i=30") +
           (HasGarbledName() ? "; if the letters of the names look wrong, save the file as UTF-8" : "") +
           "; allowed: " + AllowedColumns());
    }
    const auto alpha = std::find_if(columns_.begin(), columns_.end(), [](const CsvColumn& column) {
      const NameWords name = SplitName(column.name);
      return column.role == ColumnRole::kUnknown && !name.words.empty() && name.words[0] == "alpha";
    });
    if (directions.Has(C::kBeta) && alpha != columns_.end()) {
      Fail(QuotedName(*alpha) + " and " + QuotedName(*Column(C::kBeta)) +
           " are two direction cosines of which the axes are not said; write wi_x ... wo_z or polar angles and "
           "azimuths");
    }
    if (Column(C::kTheta) != nullptr || Column(C::kPhi) != nullptr) {
      const CsvColumn& column = *(Column(C::kTheta) != nullptr ? Column(C::kTheta) : Column(C::kPhi));
      Fail("the column " + QuotedName(column) +
           " does not say whose angle it is; name it phi_i, phi_o or dphi (theta_i or theta_o), or say it with "
           "--columns phi_o=" +
           Excerpt(column.name));
    }
    const IncidentSense sense =
        options_.incident_sense.value_or(header_.keys.incident_sense.value_or(IncidentSense::kTowardsSource));
    const bool down = PointsDown();
    directions.SetPropagation(sense == IncidentSense::kPropagation || down);
    if (down) {
      notes_.remarks.push_back(
          "the light's vectors point into the surface, so they are taken as along its propagation");
    }
    notes_.conventions["incident"] =
        Name(down ? IncidentSense::kPropagation : sense) + (down                          ? " (by the first rows)"
                                                            : options_.incident_sense     ? " (option)"
                                                            : header_.keys.incident_sense ? " (header)"
                                                                                          : " (default)");
    if (notes_.conventions.count("azimuths") == 0 && !directions.Azimuths().empty())
      notes_.conventions["azimuths"] = directions.Azimuths();
  }

  const InputFile& file_;
  const CsvHeader& header_;
  const ReadOptions& options_;
  std::vector<CsvColumn>& columns_;
  CsvLayout& layout_;
  Measurement& notes_;
  std::optional<C> head_;  // what the names of the columns of a table are
  AngleUnit default_unit_ = AngleUnit::kDegrees;
};

}  // namespace

void FindAngles(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                std::vector<CsvColumn>* columns, CsvLayout* layout, Measurement* notes) {
  AngleFinder(file, header, options, columns, layout, notes).Find();
}

}  // namespace lobefit

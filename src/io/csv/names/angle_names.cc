#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/name_rules.h"

namespace lobefit {
namespace {

constexpr std::array<std::string_view, 10> kPolar = {"theta",       "th",         "polar", "zenith",   "zen",
                                                     "inclination", "colatitude", "tht",   "vartheta", "teta"};
constexpr std::array<std::string_view, 5> kElevation = {"elevation", "elev", "el", "altitude", "grazing"};
constexpr std::array<std::string_view, 11> kAzimuthal = {"phi", "ph",     "azimuth",  "azimuthal", "azim",  "az",
                                                         "azi", "azimut", "azimutal", "varphi",    "acimut"};
constexpr std::array<std::string_view, 8> kAngle = {"angle",  "angles", "winkel",    "angulo",
                                                    "angolo", "ang",    "direction", "plane"};
constexpr std::array<std::string_view, 31> kLight = {
    "i",         "in",      "inc",        "incident",     "incidence",    "incoming",     "incidencia",
    "incidenza", "einfall", "einfalls",   "illumination", "illum",        "illuminating", "light",
    "source",    "src",     "lamp",       "laser",        "sun",          "solar",        "l",
    "input",     "ill",     "0",          "incid",        "einfallender", "beleuchtung",  "illumin",
    "emitter",   "tx",      "transmitter"};
constexpr std::array<std::string_view, 54> kViewer = {
    "o",    "out",      "outgoing",    "r",          "refl",      "reflected", "reflection", "reflexion",   "s",
    "scat", "scatter",  "scattered",   "scattering", "sca",       "v",         "view",       "viewing",     "viewer",
    "obs",  "observer", "observation", "observed",   "e",         "em",        "emission",   "emergence",   "emergent",
    "exit", "exitance", "exitant",     "exiting",    "detector",  "det",       "d",          "receiver",    "receive",
    "rec",  "sensor",   "camera",      "cam",        "output",    "ausfall",   "diffusion",  "riflessione", "rcv",
    "rcvr", "recv",     "sens",        "reflechi",   "detection", "detected",  "ref",        "reflectance", "rx"};
constexpr std::array<std::string_view, 11> kRelative = {"relative", "rel",     "delta",   "diff", "difference", "d",
                                                        "between",  "relatif", "relativ", "dif",  "relatieve"};
bool Has(const NameList& words, std::initializer_list<std::string_view> any) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return std::find(any.begin(), any.end(), word) != any.end(); });
}

void SetCoordinate(Coordinate coordinate, CsvColumn* column) {
  column->role = ColumnRole::kCoordinate;
  column->coordinate = coordinate;
}

AngleForm FormOf(std::size_t elevations, std::size_t cosines) {
  return cosines > 0 ? AngleForm::kCosine : elevations > 0 ? AngleForm::kElevation : AngleForm::kPolar;
}

}  // namespace

// "wi_x", "in.y", "lz": a component of a direction.
bool ClassifyComponent(const NameList& words, CsvColumn* column) {
  std::string joined;
  for (const std::string& word : words) joined += word;
  if (joined.size() < 2) return false;
  const char axis = joined.back();
  if (axis < 'x' || axis > 'z') return false;
  joined.pop_back();
  static constexpr std::array<std::string_view, 21> kIn = {
      "wi",  "i",  "in",  "l",   "light",    "omegai",   "di",       "wl",    "vi",    "li",    "omegain",
      "win", "ki", "kin", "sun", "incident", "incoming", "lightdir", "indir", "dirin", "sundir"};
  static constexpr std::array<std::string_view, 23> kOut = {
      "wo", "o",        "out",       "v",       "view",   "omegao",   "do",     "wv",
      "vo", "r",        "wr",        "omegar",  "wout",   "omegaout", "ko",     "kout",
      "kr", "outgoing", "reflected", "viewdir", "outdir", "dirout",   "exitant"};
  const int base = HoldsWord(kIn, joined)    ? static_cast<int>(Coordinate::kWiX)
                   : HoldsWord(kOut, joined) ? static_cast<int>(Coordinate::kWoX)
                                             : -1;
  if (base < 0) return false;
  SetCoordinate(static_cast<Coordinate>(base + axis - 'x'), column);
  return true;
}

// Angles by what kind of angle the words speak of, and of which direction.
bool ClassifyAngle(const NameList& words, bool magnitude, CsvColumn* column) {
  std::size_t polar = 0, azimuthal = 0, lights = 0, viewers = 0, angles = 0, others = 0, elevations = 0, relatives = 0,
              sines = 0, cosines = 0, speculars = 0;
  bool light_first = false;
  for (const std::string_view word : words) {
    if (HoldsWord(kPolar, word)) {
      ++polar;
    } else if (HoldsWord(kElevation, word)) {
      ++elevations;
    } else if (HoldsWord(kAzimuthal, word)) {
      ++azimuthal;
    } else if (HoldsWord(kAngle, word)) {
      ++angles;
    } else if (word == "h" || word == "half" || word == "halfway") {
      if (words.size() > 3 || lights + viewers > 0) return false;
      if (polar + azimuthal + angles == 0) return false;
      SetCoordinate(azimuthal > 0 ? Coordinate::kPhiH : Coordinate::kThetaH, column);
      return true;
    } else if (word == "sin" || word == "sine") {
      ++sines;
    } else if (word == "cos" || word == "cosine") {
      ++cosines;
    } else if (word == "mu") {
      ++polar;
      ++cosines;
    } else if (word == "specular" || word == "spec" || word == "mirror") {
      ++speculars;
    } else if (HoldsWord(kLight, word)) {
      light_first = light_first || viewers == 0;
      ++lights;
    } else if (word == "d" || (!HoldsWord(kViewer, word) && HoldsWord(kRelative, word))) {
      ++relatives;
    } else if (HoldsWord(kViewer, word)) {
      ++viewers;
      column->letter_s = word == "s";
    } else if (word == "off" || word == "offset" || word == "minus" || word == "to") {
      continue;
    } else {
      ++others;
    }
  }
  if (others > 0) return false;
  if (cosines > 0 && (cosines > 1 || azimuthal + elevations + sines + relatives + speculars > 0 ||
                      polar + angles == 0 || (lights > 0 && viewers > 0)))
    return false;
  const std::size_t kinds = (polar > 0) + (azimuthal > 0) + (elevations > 0);
  if (speculars > 0) {
    if (azimuthal + elevations > 0) return false;
    SetCoordinate(Coordinate::kFromSpecular, column);
    column->magnitude = magnitude;
    return words.size() > 1 || !column->unit.empty();
  }
  if (lights > 0 && viewers > 0) {  // a difference
    if (kinds != 1 || elevations > 0) return false;
    column->letter_s = false;
    column->reversed = light_first && polar > 0;
    column->magnitude = magnitude;
    SetCoordinate(azimuthal > 0 ? Coordinate::kDeltaPhi
                  : sines > 0   ? Coordinate::kBetaOffset
                                : Coordinate::kFromSpecular,
                  column);
    return true;
  }
  if (sines > 0) {
    if (polar == 0 || lights + viewers == 0) return false;
    SetCoordinate(lights > 0 ? Coordinate::kBeta0 : Coordinate::kBeta, column);
    return true;
  }
  // "viewing zenith angle" and "azimuthal angle" name their kind twice; "polar azimuth" none.
  if (azimuthal > 0 && elevations > 0) return false;
  if (relatives > 0 && lights + viewers == 0) {
    // "theta_d" and "phi_d" are half-difference angles beside theta_h, else the detector's.
    if (polar > 0 && relatives == 1 && Has(words, {"d", "diff", "difference"}) && words.size() == 2 &&
        HoldsWord(kPolar, words[0])) {
      SetCoordinate(Coordinate::kThetaD, column);
      return true;
    }
    if (azimuthal > 0 && words.size() == 2 && words[1] == "d") {
      SetCoordinate(Coordinate::kPhiD, column);
      return true;
    }
    if (azimuthal == 0) return false;
    SetCoordinate(Coordinate::kDeltaPhi, column);
    return true;
  }
  if (lights + viewers == 0) {
    if (azimuthal > 0) {
      SetCoordinate(Coordinate::kPhi, column);
    } else if (polar + elevations > 0 || (angles > 0 && words.size() == angles)) {
      SetCoordinate(Coordinate::kTheta, column);
      column->form = FormOf(elevations, cosines);
    } else {
      return false;
    }
    return true;
  }
  // "observation (deg)": what a direction has in degrees is its polar angle.
  const bool by_unit = words.size() == 1 && words[0].size() > 2 && ParseAngleUnit(column->unit);
  if (kinds + angles == 0 && !by_unit) return false;
  const bool light = lights > 0;
  column->form = FormOf(elevations, cosines);
  SetCoordinate(azimuthal > 0 ? (light ? Coordinate::kPhiI : Coordinate::kPhiO)
                              : (light ? Coordinate::kThetaI : Coordinate::kThetaO),
                column);
  return true;
}

bool IsLightWord(std::string_view word) { return HoldsWord(kLight, word); }
bool IsViewerWord(std::string_view word) { return HoldsWord(kViewer, word); }

bool IsAngleWord(std::string_view word) {
  return HoldsWord(kPolar, word) || HoldsWord(kElevation, word) || HoldsWord(kAzimuthal, word) ||
         HoldsWord(kAngle, word) || word == "tilt" || word == "incident" || word == "incidence";
}

}  // namespace lobefit

#include "lobefit/io/bird/reader.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/csv/rows/wavelengths.h"
#include "lobefit/io/text/json_text.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/text/units.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/pair_index.h"
#include "lobefit/measurement/prepare/noise.h"
#include "lobefit/measurement/prepare/polarisation.h"

namespace lobefit {
namespace {

using Json = nlohmann::json;

// One variable of the file: a number or, where it is no number, a text for each point.
struct Variable {
  std::string unit;
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

class BirdReader {
 public:
  BirdReader(const InputFile& file, const ReadOptions& options) : file_(file), options_(options) {}

  Measurement Read() {
    const Json document = ParseJson<Json>(file_.bytes);
    if (document.is_discarded()) Fail("is no valid JSON; it may be cut off: fetch or export it again");
    if (!document.is_object() || !document.contains("data") || !document["data"].is_object())
      Fail("has no object 'data'");
    TakeVariables(document["data"]);
    return Gather();
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { throw InputError(file_.path.string() + ": " + what); }

  void TakeVariables(const Json& data) {
    if (data.contains("variables") && data.contains("values")) {
      TakeRows(data["variables"], data["values"]);
      return;
    }
    for (const auto& [name, object] : data.items()) {
      if (!object.is_object() || !object.contains("values")) continue;
      if (!object["values"].is_array()) Fail("'" + Excerpt(name) + "' has no array of 'values'");
      variables_[name] = ReadArray(object, object["values"]);
      if (name == "BRDF" && object.contains("uncertainty")) TakeUncertainty(object["uncertainty"]);
    }
  }

  // Drafts: [{"name": "theta_i", "unit": "deg"}, ...] and rows of values.
  void TakeRows(const Json& names, const Json& rows) {
    if (!names.is_array() || !rows.is_array()) Fail("'variables' and 'values' of 'data' are not both arrays");
    std::vector<Variable*> columns;
    for (const Json& entry : names) {
      if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string()) Fail("a variable has no name");
      Variable& variable = variables_[entry["name"].get<std::string>()];
      if (entry.contains("unit") && entry["unit"].is_string()) variable.unit = entry["unit"].get<std::string>();
      columns.push_back(&variable);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!rows[r].is_array() || rows[r].size() != columns.size()) {
        Fail("row " + std::to_string(r + 1) + " of 'values' has not the " + std::to_string(columns.size()) +
             " numbers of 'variables'");
      }
      for (std::size_t c = 0; c < columns.size(); ++c) Append(rows[r][c], columns[c]);
    }
    const auto uncertainty = variables_.find("uBRDF");
    if (uncertainty == variables_.end()) return;
    sigma_ = uncertainty->second.numbers;
    sigma_unit_ = uncertainty->second.unit;
  }

  static void Append(const Json& value, Variable* variable) {
    variable->numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
    variable->texts.push_back(value.is_string() ? value.get<std::string>() : value.dump());
  }

  static Variable ReadArray(const Json& object, const Json& values) {
    Variable variable;
    if (object.contains("unit") && object["unit"].is_string()) variable.unit = object["unit"].get<std::string>();
    for (const Json& value : values) Append(value, &variable);
    return variable;
  }

  void TakeUncertainty(const Json& uncertainty) {
    if (!uncertainty.is_object()) return;
    sigma_unit_ = uncertainty.value("unit", std::string());
    for (const char* name : {"value", "values"}) {
      if (!uncertainty.contains(name)) continue;
      const Json& value = uncertainty[name];
      if (value.is_number()) sigma_.assign(variables_["BRDF"].numbers.size(), value.get<double>());
      if (value.is_array()) {
        for (const Json& entry : value) sigma_.push_back(entry.is_number() ? entry.get<double>() : std::nan(""));
      }
    }
    // Metrologists state expanded uncertainties beside standard ones.
    if (uncertainty.contains("k") && uncertainty["k"].is_number() && uncertainty["k"].get<double>() > 0)
      coverage_ = uncertainty["k"].get<double>();
  }

  const Variable& Require(const char* name) const {
    const auto found = variables_.find(name);
    if (found == variables_.end())
      Fail("'data' has no variable '" + std::string(name) + "'; theta_i, phi_i, theta_r, phi_r and BRDF are needed");
    if (found->second.numbers.size() != variables_.at("BRDF").numbers.size()) {
      Fail("'" + std::string(name) + "' has " + std::to_string(found->second.numbers.size()) + " values, BRDF has " +
           std::to_string(variables_.at("BRDF").numbers.size()));
    }
    return found->second;
  }

  double AngleScale(const char* name) const {
    const std::string& unit = Require(name).unit;
    const std::optional<AngleUnit> known = options_.angle_unit ? options_.angle_unit : ParseAngleUnit(unit);
    if (!known) Fail("'" + std::string(name) + "' has the unit '" + Excerpt(unit) + "'; allowed are deg, rad");
    return RadiansPerUnit(*known);
  }

  // What a number of uncertainty is to be multiplied by where it is relative to the value; nothing where it is
  // absolute.
  std::optional<double> RelativeUncertainty() const {
    const std::string unit = PlainUnit(sigma_unit_);
    if (unit == "%" || unit == "percent") return 0.01;
    // Without a dimension beside values that have one.
    const std::string of_values = PlainUnit(variables_.at("BRDF").unit);
    const bool is_ratio = unit == "1" && !of_values.empty() && of_values != "1";
    if (is_ratio || unit == "relative" || unit == "rel" || unit == "rel.") return 1.0;
    if (const std::optional<ValueScale> known = ParseValueScale(unit);
        known && known->form == ValueScale::Form::kLinear && !known->arbitrary)
      return std::nullopt;
    Fail("the uncertainty of BRDF has the unit '" + Excerpt(sigma_unit_) +
         "', which is not known; allowed are sr^-1, % and relative");
  }

  // Nanometres of a point; 0 where the file states none.
  std::vector<double> Wavelengths(std::size_t count) const {
    for (const char* name : {"wavelength_i", "wavelength", "lambda"}) {
      const auto found = variables_.find(name);
      if (found == variables_.end()) continue;
      const Variable& variable = Require(name);
      const std::optional<WavelengthUnit> unit = ParseWavelengthUnit(variable.unit.empty() ? "nm" : variable.unit);
      if (!unit)
        Fail("'" + std::string(name) + "' has the unit '" + Excerpt(variable.unit) + "'; allowed are nm, um, m");
      std::vector<double> nm;
      for (std::size_t i = 0; i < count; ++i) {
        nm.push_back(std::round(unit->ToNm(variable.numbers[i]) * 1e6) / 1e6);
        if (!(nm.back() > 0) || std::isinf(nm.back()))
          Fail("point " + std::to_string(i + 1) + ": the wavelength is no positive number");
      }
      return nm;
    }
    return std::vector<double>(count, 0.0);
  }

  Measurement Gather() {
    if (variables_.count("BRDF") == 0) Fail("'data' has no variable 'BRDF'");
    const Variable& brdf = Require("BRDF");
    const std::size_t count = brdf.numbers.size();
    const std::optional<ValueScale> scale = ParseValueScale(brdf.unit);
    if (!scale || scale->arbitrary)
      Fail("BRDF has the unit '" + Excerpt(brdf.unit) + "', which is not known; sr^-1 is allowed");
    const bool has_sigma = sigma_.size() == count;
    const std::optional<double> relative = RelativeUncertainty();
    const double theta_i = AngleScale("theta_i"), phi_i = AngleScale("phi_i"), theta_r = AngleScale("theta_r"),
                 phi_r = AngleScale("phi_r");
    const std::vector<double> nm = Wavelengths(count);

    // The mean over polarisations of each pair and wavelength: sums by state, states in the order of the file.
    struct Cell {
      WavelengthTable::Row row;
      std::map<std::string, std::pair<double, double>> states;  // sum, count
      double variance = 0, variances = 0;
    };
    std::map<std::tuple<std::size_t, double>, std::size_t> index;
    std::vector<Cell> cells;
    std::map<std::string, bool> states;
    PairIndex pairs;
    MeasurementBuilder skipped({{"Y"}, {}});
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 wi = FromSpherical(theta_i * Require("theta_i").numbers[i], phi_i * Require("phi_i").numbers[i]);
      const Vec3 wo = FromSpherical(theta_r * Require("theta_r").numbers[i], phi_r * Require("phi_r").numbers[i]);
      const double value = scale->Apply(brdf.numbers[i]);
      if (!std::isfinite(value) || !std::isfinite(wi.x + wi.y + wi.z + wo.x + wo.y + wo.z)) {
        skipped.Skip(brdf.texts[i] == "null" ? SetAsideReason::kHole : SetAsideReason::kNotFinite);
        continue;
      }
      if (!IsAboveHorizon(wi) || !IsAboveHorizon(wo)) {
        skipped.Skip(SetAsideReason::kBelowHorizon);
        continue;
      }
      const std::string state = State(i);
      states[state] = true;
      const auto [place, is_new] = index.try_emplace({pairs.FindOrAdd(wi, wo), nm[i]}, cells.size());
      if (is_new) cells.push_back({{wi, wo, nm[i], 0, 1, static_cast<std::uint32_t>(i + 1)}, {}});
      Cell& cell = cells[place->second];
      std::pair<double, double>& sum = cell.states[state];
      if (sum.second > 0 && options_.repeated.value_or(RepeatedRows::kFirst) == RepeatedRows::kFirst) {
        skipped.Skip(SetAsideReason::kDuplicate);
        continue;
      }
      sum.first += value;
      ++sum.second;
      if (has_sigma && sigma_[i] > 0) {
        const double sigma = (relative ? *relative * std::fabs(value) : scale->factor) * sigma_[i] / coverage_;
        cell.variance += sigma * sigma;
        ++cell.variances;
      }
    }
    if (states.size() > 2)
      Fail("holds " + std::to_string(states.size()) +
           " states of polarisation; two that are orthogonal, or one, can be read");
    WavelengthTable table(has_sigma ? WavelengthTable::Weights::kSigma : WavelengthTable::Weights::kNone);
    for (Cell& cell : cells) {
      if (cell.states.size() < states.size()) {
        skipped.Skip(SetAsideReason::kHole);
        continue;
      }
      for (const auto& [state, sum] : cell.states)
        cell.row.value += sum.first / sum.second / static_cast<double>(states.size());
      // Of the mean over the polarisations; a point without an uncertainty counts as 5 % of itself.
      cell.row.weight =
          cell.variances > 0 ? std::sqrt(cell.variance) / cell.variances : 0.05 * std::fabs(cell.row.value);
      table.Add(cell.row);
    }
    Measurement measurement = Finish(table, skipped.measurement().set_aside, has_sigma);
    if (states.size() > 1)
      measurement.remarks.emplace_back("the points of two polarisations were averaged to f_r of unpolarised light");
    if (states.size() == 1) RemarkOnPolarisation(states.begin()->first, &measurement);
    return measurement;
  }

  // The one state of all points, as State() joins it.
  static void RemarkOnPolarisation(std::string_view state, Measurement* measurement) {
    for (const std::string_view part : Split(state, ';')) {
      const std::string name = ToLower(Trim(part));
      if (name.empty() || name == "null" || name == "unknown" || IsUnpolarised(name)) continue;
      measurement->remarks.push_back("the polarisation is '" + Excerpt(name, 40) +
                                     "': the values are f_r of that light, not of unpolarised light");
      return;
    }
  }

  Measurement Finish(const WavelengthTable& table, const SetAside& skipped, bool has_sigma) const {
    Measurement measurement = table.Gather(false);
    for (int r = 0; r < kSetAsideReasons; ++r)
      measurement.set_aside.Add(static_cast<SetAsideReason>(r), skipped[static_cast<SetAsideReason>(r)]);
    if (measurement.channels.size() == 1 && measurement.channels.wavelengths_nm == std::vector<double>{0})
      measurement.channels = {{"Y"}, {}};
    if (has_sigma) {
      const std::vector<double> sigma = std::exchange(measurement.samples.weight, {});
      AddSigma(sigma, &measurement.samples);
    }
    measurement.conventions["angle-unit"] = "as each variable states";
    measurement.conventions["value-kind"] = "f (header)";
    measurement.conventions["incident"] = "towards (format)";
    return measurement;
  }

  // Polarisation of the light and, where it is stated, of the detection, as text.
  std::string State(std::size_t i) const {
    std::string state;
    for (const char* name : {"polarization_i", "polarisation_i", "polarization", "polarization_r"}) {
      const auto found = variables_.find(name);
      if (found != variables_.end() && i < found->second.texts.size()) state += found->second.texts[i] + ";";
    }
    return state;
  }

  const InputFile& file_;
  const ReadOptions& options_;
  std::map<std::string, Variable> variables_;
  std::vector<double> sigma_;
  std::string sigma_unit_;
  double coverage_ = 1;
};

}  // namespace

bool IsBird(std::string_view bytes) {
  if (Trim(bytes.substr(0, 256)).substr(0, 1) != "{") return false;
  const auto has = [&](std::string_view word) { return bytes.find(word) != std::string_view::npos; };
  return has("\"data\"") && has("\"BRDF\"") && (has("\"theta_r\"") || has("\"variables\""));
}

Measurement ReadBird(const InputFile& file, const ReadOptions& options) { return BirdReader(file, options).Read(); }

}  // namespace lobefit

#include "lobefit/io/openmaterial/reader.h"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/rows/wavelengths.h"
#include "lobefit/io/text/json_text.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {

bool IsOpenMaterial(std::string_view bytes) {
  if (Trim(bytes.substr(0, 256)).substr(0, 1) != "{") return false;
  return bytes.find("\"lookupTable\"") != std::string_view::npos && bytes.find("\"brdf\"") != std::string_view::npos;
}

Measurement ReadOpenMaterial(const InputFile& file, const ReadOptions& options) {
  using Json = nlohmann::json;
  const auto fail = [&](const std::string& what) { throw InputError(file.path.string() + ": " + what); };
  const Json document = ParseJson<Json>(file.bytes);
  if (document.is_discarded()) fail("is no valid JSON; it may be cut off: fetch or export it again");
  if (!document.is_object() || !document.contains("brdf") || !document["brdf"].is_object() ||
      !document["brdf"].contains("lookupTable") || !document["brdf"]["lookupTable"].is_array()) {
    fail("has no array 'lookupTable' in the object 'brdf'");
  }
  const double turn = options.incident_sense == IncidentSense::kPropagation ? kPi : 0;
  WavelengthTable table(WavelengthTable::Weights::kNone);
  MeasurementBuilder skipped({{"Y"}, {}});
  std::uint32_t number = 0;
  for (const Json& row : document["brdf"]["lookupTable"]) {
    ++number;
    if (!row.is_array() || row.size() != 5)
      fail("row " + std::to_string(number) +
           " of lookupTable has not the 5 entries wavelength, theta_i, theta_o, phi_o, f_r");
    for (std::size_t c = 0; c < 5; ++c) {
      if (!row[c].is_number() && !row[c].is_null())
        fail("row " + std::to_string(number) + " of lookupTable: entry " + std::to_string(c + 1) +
             " is neither a number nor null");
    }
    if (row[0].is_null() || row[1].is_null() || row[2].is_null() || row[3].is_null() || row[4].is_null()) {
      skipped.Skip(SetAsideReason::kHole);
      continue;
    }
    const double metres = row[0].get<double>(), theta_i = row[1].get<double>(), theta_o = row[2].get<double>();
    if (!(metres > 0))
      fail("row " + std::to_string(number) + " of lookupTable: the wavelength is " + FormatDouble(metres) +
           " m; it must be positive");
    if (std::fabs(theta_i) > kPi || std::fabs(theta_o) > kPi) {
      fail("row " + std::to_string(number) +
           " of lookupTable: a polar angle is beyond a half turn; angles are radians in this format");
    }
    const Vec3 wi = FromSpherical(theta_i, turn), wo = FromSpherical(theta_o, row[3].get<double>());
    if (!IsAboveHorizon(wi) || !IsAboveHorizon(wo)) {
      skipped.Skip(SetAsideReason::kBelowHorizon);
      continue;
    }
    table.Add({wi, wo, std::round(metres * 1e15) / 1e6, row[4].get<double>(), 1, number});
  }
  Measurement measurement = table.Gather(false);
  for (int r = 0; r < kSetAsideReasons; ++r) {
    measurement.set_aside.Add(static_cast<SetAsideReason>(r),
                              skipped.measurement().set_aside[static_cast<SetAsideReason>(r)]);
  }
  measurement.isotropic = true;
  measurement.conventions["angle-unit"] = "rad (format)";
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["incident"] = turn > 0 ? "propagation (option)" : "towards (default)";
  return measurement;
}

}  // namespace lobefit

// The instrument of a document.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lobefit/material/json_reader.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// What pictures and predictions compute with.
void CheckInstrument(const JsonReader& reader, const InstrumentUsed& instrument, std::size_t channels) {
  constexpr double kMostHalfAngle = 30.001 * kPi / 180, kMostAngle = 10.001 * kPi / 180;
  for (const double half_angle : {instrument.source, instrument.detector, instrument.across}) {
    if (!(half_angle >= 0 && half_angle <= kMostHalfAngle))
      reader.Fail(
          fmt::format("a half angle of the instrument is {:g} degrees; allowed are 0 to 30", half_angle * 180 / kPi));
  }
  for (const InstrumentHalfAngle& half_angle : instrument.half_angles) {
    const bool known = half_angle.name == "source" || half_angle.name == "detector";
    if (!known)
      reader.Fail(fmt::format("a fitted half angle is named '{}'; allowed are source and detector", half_angle.name));
    if (!(half_angle.value > 0 && half_angle.value <= kMostHalfAngle && half_angle.prior > 0)) {
      reader.Fail(
          fmt::format("the half angle of the {} is {:g} degrees with a prior of {:g}; allowed are above 0 to 30 "
                      "and a prior above 0",
                      half_angle.name, half_angle.value * 180 / kPi, half_angle.prior * 180 / kPi));
    }
  }
  if (instrument.mean != "flux" && instrument.mean != "plain")
    reader.Fail(fmt::format("the mean of the instrument is '{}'; allowed are flux and plain", instrument.mean));
  for (const IncidenceGain& gain : instrument.gains) {
    if (!(gain.gain > 0)) reader.Fail(fmt::format("a gain of the instrument is {:g}; gains are positive", gain.gain));
  }
  for (const InstrumentAngle& angle : instrument.alignment) {
    if (!(std::fabs(angle.value) <= kMostAngle))
      reader.Fail(fmt::format("the alignment's {} is {:g} degrees; allowed are -10 to 10", angle.name,
                              angle.value * 180 / kPi));
  }
  const std::size_t turns = instrument.azimuths.size();
  if (instrument.alignment.size() != (turns == 0 ? 0 : turns + 1))
    reader.Fail(fmt::format("the alignment has {} angles, {} belong to {} turns of the sample",
                            instrument.alignment.size(), turns == 0 ? 0 : turns + 1, turns));
  if (!instrument.offset.empty() && instrument.offset.size() != channels)
    reader.Fail(
        fmt::format("the instrument has {} offsets, the document {} channels", instrument.offset.size(), channels));
}

}  // namespace

InstrumentUsed ReadInstrument(const JsonReader& reader, const Json& json, std::size_t channels) {
  InstrumentUsed instrument;
  instrument.source = DegreesToRadians(reader.Get<double>(json, "source_deg"));
  instrument.detector = DegreesToRadians(reader.Get<double>(json, "detector_deg"));
  instrument.mean = reader.Get<std::string>(json, "mean");
  if (json.contains("detector_across_deg"))
    instrument.across = DegreesToRadians(reader.Get<double>(json, "detector_across_deg"));
  if (json.contains("half_angles")) {
    for (const Json& half_angle : reader.Member(json, "half_angles")) {
      instrument.half_angles.push_back(
          {reader.Get<std::string>(half_angle, "name"), DegreesToRadians(reader.Get<double>(half_angle, "value_deg")),
           reader.GetNumbers(half_angle, "stderr_deg", kPi / 180)[0],
           DegreesToRadians(reader.Get<double>(half_angle, "given_deg")),
           DegreesToRadians(reader.Get<double>(half_angle, "prior_deg")), reader.Get<bool>(half_angle, "determined")});
    }
  }
  if (json.contains("drift")) {
    const Json& drift = reader.Member(json, "drift");
    instrument.drift = {reader.GetWithin(drift, "sd", 0, std::numeric_limits<double>::max()),
                        reader.Get<bool>(drift, "estimated")};
  }
  if (json.contains("gains")) {
    for (const Json& gain : reader.Member(json, "gains")) {
      instrument.gains.push_back({DegreesToRadians(reader.Get<double>(gain, "theta_i_deg")),
                                  DegreesToRadians(reader.Get<double>(gain, "phi_i_deg")),
                                  reader.Get<double>(gain, "gain"), reader.GetNumbers(gain, "stderr", 1)[0]});
    }
  }
  if (json.contains("alignment")) {
    for (const Json& angle : reader.Member(json, "alignment")) {
      instrument.alignment.push_back({reader.Get<std::string>(angle, "name"),
                                      DegreesToRadians(reader.Get<double>(angle, "value_deg")),
                                      reader.GetNumbers(angle, "stderr_deg", kPi / 180)[0],
                                      DegreesToRadians(reader.Get<double>(angle, "prior_deg")),
                                      reader.GetNumbers(angle, "tilt_correlation", 1)[0]});
    }
  }
  if (json.contains("alignment_correlation"))
    instrument.alignment_correlation = reader.GetWithin(json, "alignment_correlation", -1, 1);
  if (json.contains("sample_azimuths_deg"))
    instrument.azimuths = reader.GetNumbers(json, "sample_azimuths_deg", kPi / 180);
  if (json.contains("told_from_tilt")) instrument.told_from_tilt = reader.Get<bool>(json, "told_from_tilt");
  if (json.contains("offset")) {
    for (const Json& offset : reader.Member(json, "offset"))
      instrument.offset.push_back({reader.Get<double>(offset, "value"), reader.GetNumbers(offset, "stderr", 1)[0]});
  }
  // Documents of a single turn need not say its azimuth.
  if (!instrument.alignment.empty() && instrument.azimuths.empty()) instrument.azimuths = {0};
  CheckInstrument(reader, instrument, channels);
  return instrument;
}

}  // namespace lobefit

// One run of a reader on arbitrary bytes: it reads or throws InputError, and what it reads keeps the promises of a
// measurement. The options depend on the number of bytes, so that an input repeats its run.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "lobefit/base/error.h"
#include "lobefit/io/formats.h"
#include "lobefit/measurement/prepare/incomplete.h"

namespace lobefit {

inline void Require(bool holds) {
  if (!holds) std::abort();
}

inline void CheckPromises(const Measurement& measurement) {
  const Samples& samples = measurement.samples;
  const std::size_t count = samples.size();
  Require(samples.values.size() == measurement.channels.size());
  Require(measurement.channels.wavelengths_nm.empty() ||
          measurement.channels.wavelengths_nm.size() == measurement.channels.size());
  Require(samples.origin.size() == count);
  Require(samples.weight.empty() || samples.weight.size() == count);
  Require(samples.solid_angle.empty() || samples.solid_angle.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    Require(std::fabs(Norm(samples.wi(i)) - 1) < 1e-9 && samples.wi_z[i] > 0);
    Require(std::fabs(Norm(samples.wo(i)) - 1) < 1e-9 && samples.wo_z[i] > 0);
    for (const std::vector<double>& channel : samples.values)
      Require(channel.size() == count && std::isfinite(channel[i]));
    if (!samples.weight.empty()) Require(samples.weight[i] > 0 && std::isfinite(samples.weight[i]));
    if (!samples.solid_angle.empty()) Require(samples.solid_angle[i] > 0 && std::isfinite(samples.solid_angle[i]));
  }
}

inline int FuzzReader(bool (*recognise)(std::string_view), Measurement (*read)(const InputFile&, const ReadOptions&),
                      const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ReadOptions options;
  if (size % 2 == 1) {
    options.side = Side::kBack;
    options.zemax_rotation_sign = -1;
    options.mountain_azimuth = MountainAzimuth::kUp;
    options.value_kind = ValueKind::kBrdfCosO;
    options.incident_sense = IncidentSense::kPropagation;
    options.angle_unit = AngleUnit::kDegrees;
    options.alta_interval = size % 4 == 1 ? IntervalKind::kBounds : IntervalKind::kOffsets;
    options.repeated = RepeatedRows::kMean;
    options.merl_cell = options.mit_cell = CellPosition::kEdge;
    options.utia_encoding = UtiaEncoding::kSrgb;
    options.exr_theta_i_deg = 30;
    options.exr_axes = size % 4 == 1 ? ExrAxes::kHemisphere : ExrAxes::kSliceSqrt;
    if (size % 8 == 1) options.xml_naming = XmlNaming::kPlain;
  }
  recognise(bytes);
  try {
    Measurement measurement = read(InputFile{"fuzz", bytes}, options);
    DropIncomplete(&measurement);
    CheckPromises(measurement);
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace lobefit

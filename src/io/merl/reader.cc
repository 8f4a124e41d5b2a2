// MERL `.binary`: three int32 dims (theta_h, theta_d, phi_d), then one plane of float64 a channel, phi_d fastest.
// Values are f_r / scale without a cosine. Layout from the database's reader as described by several independent
// programs.
#include "lobefit/io/merl/reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/io/merl/table.h"

namespace lobefit {
namespace {

constexpr std::size_t kHeaderBytes = 12;

MerlDims ReadDims(std::string_view bytes) {
  MerlDims dims = {};
  std::memcpy(&dims, bytes.data(), kHeaderBytes);
  return dims;
}

// Below this number of cells a thread costs more than it does.
constexpr std::uint64_t kFewCells = 1 << 16;

// The database has 90 x 90 x 180 cells: phi_d in [0, 180) degrees, the other half by reciprocity. A non-reciprocal set
// (LIRIS PQBA) has 360 cells over the full turn.
bool AreKnown(const MerlDims& dims) {
  return dims.theta_h == 90 && dims.theta_d == 90 && (dims.phi_d == 180 || dims.phi_d == 360);
}

std::string Text(const MerlDims& dims) {
  return std::to_string(dims.theta_h) + " x " + std::to_string(dims.theta_d) + " x " + std::to_string(dims.phi_d);
}

void CheckSize(const InputFile& file) {
  const std::string name = file.path.string();
  if (file.bytes.size() < kHeaderBytes) {
    throw InputError(name + ": byte 0: a MERL file begins with three 4-byte dims, but the file has only " +
                     std::to_string(file.bytes.size()) + " bytes; fetch the file again");
  }
  const MerlDims dims = ReadDims(file.bytes);
  if (!AreKnown(dims)) {
    throw InputError(name + ": byte 0: the dims are " + Text(dims) +
                     "; a MERL table has 90 x 90 x 180 (or 90 x 90 x 360 without reciprocity) cells");
  }
  const std::uint64_t expected = MerlBytes(dims);
  if (file.bytes.size() != expected) {
    throw InputError(name + ": byte " + std::to_string(std::min<std::uint64_t>(file.bytes.size(), expected)) + ": " +
                     (file.bytes.size() < expected ? "the file ends" : "the table ends") + ", but a table of " +
                     Text(dims) + " cells x 3 channels has exactly " + std::to_string(expected) +
                     " bytes and the file has " + std::to_string(file.bytes.size()) + "; fetch the file again");
  }
}

// Cosines and sines of one axis of the table, and the measure of each of its cells.
struct Axis {
  std::vector<double> cos, sin;

  void Add(double angle) {
    cos.push_back(std::cos(angle));
    sin.push_back(std::sin(angle));
  }
};

class MerlTable {
 public:
  MerlTable(std::string_view bytes, const MerlDims& dims, bool whole_turn, CellPosition position)
      : dims_(dims), cells_(dims.cells()) {
    data_ = bytes.data() + kHeaderBytes;
    const double shift = position == CellPosition::kCentre ? 0.5 : 0.0;
    for (int i = 0; i < dims_.theta_h; ++i) theta_h_.Add(ThetaH(i + shift));
    for (int i = 0; i < dims_.theta_d; ++i) theta_d_.Add((i + shift) / dims_.theta_d * kPi / 2);
    const double turn = whole_turn ? 2 * kPi : kPi;
    for (int i = 0; i < dims_.phi_d; ++i) phi_d_.Add((i + shift) / dims_.phi_d * turn);
    // On the lower edge theta_d = 0 all azimuths are one pair of directions.
    edge_ = position == CellPosition::kEdge;
  }

  std::size_t rows() const { return static_cast<std::size_t>(dims_.theta_h) * static_cast<std::size_t>(dims_.theta_d); }

  // The cells of one (theta_h, theta_d): calls take(cell, wi, wo, values) for the usable ones, counts the others.
  template <class Take>
  void ForRow(std::size_t row, SetAside* set_aside, Take&& take) const {
    const std::size_t h = row / static_cast<std::size_t>(dims_.theta_d),
                      d = row % static_cast<std::size_t>(dims_.theta_d);
    const std::size_t count = static_cast<std::size_t>(dims_.phi_d);
    const double cos_h = theta_h_.cos[h], sin_h = theta_h_.sin[h];
    const double cos_d = theta_d_.cos[d], sin_d = theta_d_.sin[d];
    std::size_t below = 0, holes = 0, not_finite = 0, duplicates = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double dx = sin_d * phi_d_.cos[k], dy = sin_d * phi_d_.sin[k];
      const double wi_z = cos_h * cos_d - sin_h * dx, wo_z = cos_h * cos_d + sin_h * dx;
      if (!(wi_z > kHorizon) || !(wo_z > kHorizon)) {
        ++below;
        continue;
      }
      if (edge_ && d == 0 && k > 0) {
        ++duplicates;
        continue;
      }
      const std::size_t cell = row * count + k;
      const std::array<double, 3> value = {Load(cell, 0), Load(cell, 1), Load(cell, 2)};
      if (value[0] < 0 || value[1] < 0 || value[2] < 0) {
        ++holes;
        continue;
      }
      if (!std::isfinite(value[0] + value[1] + value[2])) {
        ++not_finite;
        continue;
      }
      take(cell, Vec3{cos_h * dx + sin_h * cos_d, dy, wi_z}, Vec3{-cos_h * dx + sin_h * cos_d, -dy, wo_z}, value);
    }
    set_aside->Add(SetAsideReason::kBelowHorizon, below);
    set_aside->Add(SetAsideReason::kHole, holes);
    set_aside->Add(SetAsideReason::kNotFinite, not_finite);
    set_aside->Add(SetAsideReason::kDuplicate, duplicates);
  }

  // d(wi) d(wo) = 4 cos(theta_d) d(wh) d(wd): measure of each cell of the row, taken at its centre.
  double CellMeasure(std::size_t row) const {
    const int h = static_cast<int>(row) / dims_.theta_d, d = static_cast<int>(row) % dims_.theta_d;
    const double theta_d = (d + 0.5) / dims_.theta_d * kPi / 2;
    const double step_h = ThetaH(h + 1) - ThetaH(h);
    return 4 * std::cos(theta_d) * std::sin(ThetaH(h + 0.5)) * std::sin(theta_d) * step_h;
  }

 private:
  static constexpr double kHorizon = 1e-9;

  double ThetaH(double index) const { return MerlThetaH(index * 90 / dims_.theta_h); }

  double Load(std::size_t cell, std::size_t channel) const {
    double stored = 0;
    std::memcpy(&stored, data_ + sizeof(double) * (cell + channel * cells_), sizeof(double));
    return stored * kMerlScale[channel];
  }

  MerlDims dims_;
  std::size_t cells_;
  const char* data_;
  bool edge_;
  Axis theta_h_, theta_d_, phi_d_;
};

}  // namespace

bool IsMerl(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  const MerlDims dims = ReadDims(bytes);
  if (AreKnown(dims)) return true;
  // A file of a table's size with other dims, or dims like a table's with another size, is a damaged MERL file: the
  // reader says so.
  return bytes.size() == MerlBytes({90, 90, 180}) || (dims.theta_h == 90 && dims.theta_d == 90);
}

Measurement ReadMerl(const InputFile& file, const ReadOptions& options) {
  CheckSize(file);
  const MerlDims dims = ReadDims(file.bytes);
  return ReadMerlTable(file.bytes, dims, dims.phi_d == 360, options.merl_cell);
}

Measurement ReadMerlTable(std::string_view bytes, const MerlDims& dims, bool whole_turn, CellPosition position) {
  const MerlTable table(bytes, dims, whole_turn, position);
  ThreadPool pool(dims.cells() < kFewCells ? 1 : HardwareThreads());
  const std::size_t rows = table.rows();
  const std::size_t rows_a_piece = static_cast<std::size_t>(dims.theta_d), pieces = rows / rows_a_piece;

  std::vector<std::size_t> first(rows + 1, 0);
  std::vector<SetAside> set_aside(pieces);
  pool.Run(pieces, [&](std::size_t piece) {
    for (std::size_t row = piece * rows_a_piece; row < (piece + 1) * rows_a_piece; ++row) {
      std::size_t usable = 0;
      table.ForRow(row, &set_aside[piece], [&](std::size_t, const Vec3&, const Vec3&, const auto&) { ++usable; });
      first[row + 1] = usable;
    }
  });
  double measure_sum = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    measure_sum += table.CellMeasure(row) * static_cast<double>(first[row + 1]);
    first[row + 1] += first[row];
  }
  const std::size_t total = first[rows];
  const double measure_scale = measure_sum > 0 ? static_cast<double>(total) / measure_sum : 1.0;

  Measurement measurement;
  measurement.channels.names = {"R", "G", "B"};
  measurement.isotropic = true;
  measurement.conventions["merl-cell"] = position == CellPosition::kCentre ? "centre" : "edge";
  for (const SetAside& counts : set_aside) {
    for (int i = 0; i < kSetAsideReasons; ++i) {
      const auto reason = static_cast<SetAsideReason>(i);
      measurement.set_aside.Add(reason, counts[reason]);
    }
  }
  Samples& samples = measurement.samples;
  samples.values.resize(3);
  const std::array<std::vector<double>*, 10> arrays = {
      &samples.wi_x, &samples.wi_y,      &samples.wi_z,      &samples.wo_x,      &samples.wo_y,
      &samples.wo_z, &samples.values[0], &samples.values[1], &samples.values[2], &samples.solid_angle};
  // Touching 100 MB of fresh memory takes as long as filling it: done by all threads.
  pool.Run(arrays.size() + 1, [&](std::size_t i) {
    if (i < arrays.size()) {
      arrays[i]->resize(total);
    } else {
      samples.origin.resize(total);
    }
  });
  pool.Run(pieces, [&](std::size_t piece) {
    SetAside ignored;
    for (std::size_t row = piece * rows_a_piece; row < (piece + 1) * rows_a_piece; ++row) {
      std::size_t at = first[row];
      const double measure = table.CellMeasure(row) * measure_scale;
      table.ForRow(row, &ignored, [&](std::size_t cell, const Vec3& wi, const Vec3& wo, const auto& value) {
        samples.wi_x[at] = wi.x;
        samples.wi_y[at] = wi.y;
        samples.wi_z[at] = wi.z;
        samples.wo_x[at] = wo.x;
        samples.wo_y[at] = wo.y;
        samples.wo_z[at] = wo.z;
        for (std::size_t c = 0; c < 3; ++c) samples.values[c][at] = value[c];
        samples.solid_angle[at] = measure;
        samples.origin[at] = static_cast<std::uint32_t>(cell);
        ++at;
      });
    }
  });
  return measurement;
}

}  // namespace lobefit

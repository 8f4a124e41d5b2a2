// MERL `.binary`: three int32 dims (theta_h, theta_d, phi_d), then one plane of float64 a channel, phi_d fastest.
// Values are f_r / scale without a cosine. Layout from the database's reader as described by several independent
// programs.
#include "lobefit/io/merl/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/process/memory.h"
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

// Cosines and sines of one axis of the table.
struct Axis {
  std::vector<double> cos, sin;

  void Add(double angle) {
    cos.push_back(std::cos(angle));
    sin.push_back(std::sin(angle));
  }
};

// What becomes of a cell.
enum Fate : std::uint8_t { kUsable, kBelow, kSameAgain, kHole, kNotFinite, kFates };

class MerlTable {
 public:
  MerlTable(std::string_view bytes, const MerlDims& dims, bool whole_turn, CellPosition position)
      : dims_(dims), columns_(static_cast<std::size_t>(dims.phi_d)), cells_(dims.cells()) {
    data_ = bytes.data() + kHeaderBytes;
    const double shift = position == CellPosition::kCentre ? 0.5 : 0.0;
    for (int i = 0; i < dims_.theta_h; ++i) theta_h_.Add(ThetaH(i + shift));
    for (int i = 0; i < dims_.theta_d; ++i) theta_d_.Add((i + shift) / dims_.theta_d * kPi / 2);
    const double turn = whole_turn ? 2 * kPi : kPi;
    for (int i = 0; i < dims_.phi_d; ++i) phi_d_.Add((i + shift) / dims_.phi_d * turn);
    // On the lower edge theta_d = 0 all azimuths are one pair of directions.
    edge_ = position == CellPosition::kEdge;
  }

  // A row holds the cells of one (theta_h, theta_d), by phi_d.
  std::size_t rows() const { return static_cast<std::size_t>(dims_.theta_h) * static_cast<std::size_t>(dims_.theta_d); }
  std::size_t columns() const { return columns_; }

  void Judge(std::size_t row, Fate* fates) const {
    const Frame f = FrameOf(row);
    const std::size_t first = row * columns_;
    for (std::size_t k = 0; k < columns_; ++k) {
      const double dx = f.sin_d * phi_d_.cos[k];
      const double red = Load(first + k, 0), green = Load(first + k, 1), blue = Load(first + k, 2);
      const bool above = std::min(Wz(f, dx), Wz(f, -dx)) > kHorizon;
      const bool hole = (red < 0) | (green < 0) | (blue < 0);
      fates[k] = !above ? kBelow : hole ? kHole : !std::isfinite(red + green + blue) ? kNotFinite : kUsable;
    }
    if (!edge_ || row % static_cast<std::size_t>(dims_.theta_d) != 0) return;
    for (std::size_t k = 1; k < columns_; ++k) fates[k] = fates[k] == kBelow ? kBelow : kSameAgain;
  }

  // One number of each cell of a row.
  enum class Number { kWiX, kWiY, kWiZ, kWoX, kWoY, kWoZ, kRed, kGreen, kBlue };
  void Evaluate(std::size_t row, Number number, double* values) const {
    const Frame f = FrameOf(row);
    const auto fill = [&](const auto& value) {
      for (std::size_t k = 0; k < columns_; ++k) values[k] = value(k);
    };
    const auto dx = [&](std::size_t k) { return f.sin_d * phi_d_.cos[k]; };
    const auto dy = [&](std::size_t k) { return f.sin_d * phi_d_.sin[k]; };
    switch (number) {
      case Number::kWiX:
        return fill([&](std::size_t k) { return f.cos_h * dx(k) + f.sin_h * f.cos_d; });
      case Number::kWiY:
        return fill(dy);
      case Number::kWiZ:
        return fill([&](std::size_t k) { return Wz(f, dx(k)); });
      case Number::kWoX:
        return fill([&](std::size_t k) { return -f.cos_h * dx(k) + f.sin_h * f.cos_d; });
      case Number::kWoY:
        return fill([&](std::size_t k) { return -dy(k); });
      case Number::kWoZ:
        return fill([&](std::size_t k) { return Wz(f, -dx(k)); });
      case Number::kRed:
      case Number::kGreen:
      case Number::kBlue:
        break;
    }
    const std::size_t channel = static_cast<std::size_t>(number) - static_cast<std::size_t>(Number::kRed);
    fill([&](std::size_t k) { return Load(row * columns_ + k, channel); });
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

  struct Frame {
    double cos_h, sin_h, cos_d, sin_d;
  };
  Frame FrameOf(std::size_t row) const {
    const std::size_t h = row / static_cast<std::size_t>(dims_.theta_d),
                      d = row % static_cast<std::size_t>(dims_.theta_d);
    return {theta_h_.cos[h], theta_h_.sin[h], theta_d_.cos[d], theta_d_.sin[d]};
  }
  // z of wi; of wo for -dx.
  static double Wz(const Frame& f, double dx) { return f.cos_h * f.cos_d - f.sin_h * dx; }

  double ThetaH(double index) const { return MerlThetaH(index * 90 / dims_.theta_h); }

  double Load(std::size_t cell, std::size_t channel) const {
    double stored = 0;
    std::memcpy(&stored, data_ + sizeof(double) * (cell + channel * cells_), sizeof(double));
    return stored * kMerlScale[channel];
  }

  MerlDims dims_;
  std::size_t columns_, cells_;
  const char* data_;
  bool edge_;
  Axis theta_h_, theta_d_, phi_d_;
};

// The fates of all cells, and what follows from them.
struct Verdicts {
  std::vector<Fate> fates;
  std::vector<std::uint32_t> usable;  // of each row
  std::size_t total = 0;              // usable
  SetAside set_aside;
};

Verdicts JudgeCells(const MerlTable& table, ThreadPool* pool) {
  const std::size_t rows = table.rows(), columns = table.columns();
  constexpr std::size_t kRowsAPiece = 90;
  Verdicts verdicts;
  verdicts.fates.resize(rows * columns);
  verdicts.usable.resize(rows);
  std::vector<std::array<std::size_t, kFates>> counts((rows + kRowsAPiece - 1) / kRowsAPiece);
  pool->Run(counts.size(), [&](std::size_t piece) {
    for (std::size_t row = piece * kRowsAPiece; row < std::min(rows, (piece + 1) * kRowsAPiece); ++row) {
      Fate* const fates = &verdicts.fates[row * columns];
      table.Judge(row, fates);
      std::array<std::uint32_t, kFates> of_row = {};
      for (std::size_t k = 0; k < columns; ++k) ++of_row[fates[k]];
      verdicts.usable[row] = of_row[kUsable];
      for (std::size_t fate = 0; fate < kFates; ++fate) counts[piece][fate] += of_row[fate];
    }
  });
  for (const auto& of_piece : counts) {
    verdicts.total += of_piece[kUsable];
    verdicts.set_aside.Add(SetAsideReason::kBelowHorizon, of_piece[kBelow]);
    verdicts.set_aside.Add(SetAsideReason::kDuplicate, of_piece[kSameAgain]);
    verdicts.set_aside.Add(SetAsideReason::kHole, of_piece[kHole]);
    verdicts.set_aside.Add(SetAsideReason::kNotFinite, of_piece[kNotFinite]);
  }
  return verdicts;
}

// Appends the usable cells of all rows; evaluate(row, values) gives one number of each cell of a row. Clearing 100 MB
// before they are written would take as long as writing them.
template <class T, class Evaluate>
void AppendUsable(const MerlTable& table, const Verdicts& verdicts, const Evaluate& evaluate, std::vector<T>* array) {
  array->reserve(verdicts.total);
  AdviseLargePages(array->data(), verdicts.total * sizeof(T));
  const std::size_t columns = table.columns();
  std::vector<T> values(columns);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t usable = verdicts.usable[row];
    if (usable == 0) continue;
    evaluate(row, values.data());
    if (usable < columns) {
      const Fate* const fates = &verdicts.fates[row * columns];
      std::size_t kept = 0;
      for (std::size_t k = 0; k < columns; ++k) {
        values[kept] = values[k];
        kept += fates[k] == kUsable ? 1 : 0;
      }
    }
    array->insert(array->end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(usable));
  }
}

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
  const Verdicts verdicts = JudgeCells(table, &pool);
  double measure_sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    measure_sum += table.CellMeasure(row) * static_cast<double>(verdicts.usable[row]);
  const double measure_scale = measure_sum > 0 ? static_cast<double>(verdicts.total) / measure_sum : 1.0;

  Measurement measurement;
  measurement.channels.names = {"R", "G", "B"};
  measurement.isotropic = true;
  measurement.conventions["merl-cell"] = position == CellPosition::kCentre ? "centre" : "edge";
  measurement.set_aside = verdicts.set_aside;
  Samples& samples = measurement.samples;
  samples.values.resize(3);
  // In the order of MerlTable::Number.
  const std::array<std::vector<double>*, 9> arrays = {&samples.wi_x,      &samples.wi_y,      &samples.wi_z,
                                                      &samples.wo_x,      &samples.wo_y,      &samples.wo_z,
                                                      &samples.values[0], &samples.values[1], &samples.values[2]};
  // An array a piece: each is written from its beginning, by the thread that is free.
  pool.Run(arrays.size() + 2, [&](std::size_t i) {
    if (i < arrays.size()) {
      const auto evaluate = [&](std::size_t row, double* values) {
        table.Evaluate(row, static_cast<MerlTable::Number>(i), values);
      };
      AppendUsable(table, verdicts, evaluate, arrays[i]);
    } else if (i == arrays.size()) {
      const auto evaluate = [&](std::size_t row, double* values) {
        std::fill_n(values, table.columns(), table.CellMeasure(row) * measure_scale);
      };
      AppendUsable(table, verdicts, evaluate, &samples.solid_angle);
    } else {
      const auto evaluate = [&](std::size_t row, std::uint32_t* cells) {
        std::iota(cells, cells + table.columns(), static_cast<std::uint32_t>(row * table.columns()));
      };
      AppendUsable(table, verdicts, evaluate, &samples.origin);
    }
  });
  return measurement;
}

}  // namespace lobefit

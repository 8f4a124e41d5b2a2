// MIT / Ngan anisotropic `.dat`: 16 int32, then float32 planes R, G, B over (theta_i, theta_o, phi_diff, phi_i), phi_i
// fastest. Negative is not measured. The reader of the database multiplies by 10; the unit is not documented. phi_diff
// is taken as phi_o - phi_i.
#include "lobefit/io/mit/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using Head16 = std::array<std::int32_t, 16>;
constexpr std::size_t kHeaderBytes = sizeof(Head16);
// A measurement in memory takes 80 bytes a sample.
constexpr std::size_t kMostCells = 4000000;
constexpr std::int32_t kMostBins = 4096;

Head16 ReadHead(std::string_view bytes) {
  Head16 head = {};
  std::memcpy(head.data(), bytes.data(), kHeaderBytes);
  return head;
}

std::string SizeText(const Head16& head) {
  return std::to_string(head[0]) + " x " + std::to_string(head[1]) + " x " + std::to_string(head[2]) + " x " +
         std::to_string(head[3]);
}

bool BinsAreSane(const Head16& head) {
  return std::all_of(head.begin(), head.begin() + 4, [](std::int32_t n) { return n >= 1 && n <= kMostBins; });
}

std::size_t Cells(const Head16& head) {  // at most 2^48
  return static_cast<std::size_t>(head[0]) * static_cast<std::size_t>(head[1]) * static_cast<std::size_t>(head[2]) *
         static_cast<std::size_t>(head[3]);
}

void CheckHead(const InputFile& file, const Head16& head) {
  if (!BinsAreSane(head)) {
    FailAtByte(file, 0,
               "the numbers of bins are " + SizeText(head) + "; each must be 1 to " + std::to_string(kMostBins));
  }
  if (head[6] != 1 || head[7] != 0) {
    FailAtByte(file, 24,
               "parameter type " + std::to_string(head[6]) + " and bin type " + std::to_string(head[7]) +
                   "; only 1 (standard) and 0 (uniform) are known");
  }
  if (head[9] != 0 && head[9] != 1) {
    FailAtByte(file, 36,
               "half_data is " + std::to_string(head[9]) + "; 0 (phi_diff over 360 degrees) or 1 (180) is allowed");
  }
  if (head[10] != 3) FailAtByte(file, 40, "has " + std::to_string(head[10]) + " channels; 3 are allowed");
  const std::size_t expected = kHeaderBytes + 3 * sizeof(float) * Cells(head);
  if (file.bytes.size() != expected) {
    FailAtByte(file, std::min(file.bytes.size(), expected),
               "a table of " + SizeText(head) + " cells x 3 channels has " + std::to_string(expected) +
                   " bytes, but the file has " + std::to_string(file.bytes.size()) + "; fetch the file again");
  }
}

// Steps along phi_diff and phi_i that keep at most kMostCells.
std::size_t StrideFor(const Head16& head) {
  std::size_t stride = 1;
  while (Cells(head) / (stride * stride) > kMostCells) ++stride;
  return stride;
}

}  // namespace

bool IsMit(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  const Head16 head = ReadHead(bytes);
  if (!BinsAreSane(head)) return false;
  const bool plausible =
      head[6] >= 0 && head[6] < 16 && head[7] >= 0 && head[7] < 16 && head[10] >= 1 && head[10] <= 16;
  return plausible &&
         (bytes.size() == kHeaderBytes + 3 * sizeof(float) * Cells(head) || (head[10] == 3 && head[6] == 1));
}

Measurement ReadMit(const InputFile& file, const ReadOptions& options) {
  if (file.bytes.size() < kHeaderBytes) {
    FailAtByte(file, file.bytes.size(), "the file ends in its header of 64 bytes; fetch the file again");
  }
  const Head16 head = ReadHead(file.bytes);
  CheckHead(file, head);
  const std::size_t n_ti = static_cast<std::size_t>(head[0]), n_to = static_cast<std::size_t>(head[1]);
  const std::size_t n_diff = static_cast<std::size_t>(head[2]), n_pi = static_cast<std::size_t>(head[3]);
  const std::size_t cells = Cells(head);
  const std::size_t stride = options.mit_stride ? static_cast<std::size_t>(*options.mit_stride) : StrideFor(head);
  const double scale = options.mit_scale.value_or(10.0);
  const double shift = options.mit_cell == CellPosition::kCentre ? 0.5 : 0.0;
  const double diff_span = head[9] == 1 ? kPi : 2 * kPi;

  MeasurementBuilder builder({{"R", "G", "B"}, {}});
  std::vector<double>& solid_angle = builder.measurement().samples.solid_angle;
  const auto at = [&](std::size_t i, std::size_t n, double span) {
    return (static_cast<double>(i) + shift) / static_cast<double>(n) * span;
  };
  std::array<double, 3> values = {};
  for (std::size_t ti = 0; ti < n_ti; ++ti) {
    for (std::size_t to = 0; to < n_to; ++to) {
      const double theta_i = at(ti, n_ti, kPi / 2), theta_o = at(to, n_to, kPi / 2);
      const double measure = std::sin((static_cast<double>(ti) + 0.5) / static_cast<double>(n_ti) * kPi / 2) *
                             std::sin((static_cast<double>(to) + 0.5) / static_cast<double>(n_to) * kPi / 2);
      for (std::size_t d = 0; d < n_diff; d += stride) {
        for (std::size_t p = 0; p < n_pi; p += stride) {
          const std::size_t cell = p + n_pi * (d + n_diff * (to + n_to * ti));
          bool hole = false;
          for (std::size_t c = 0; c < 3; ++c) {
            float stored = 0;
            std::memcpy(&stored, file.bytes.data() + kHeaderBytes + sizeof(float) * (cell + c * cells), sizeof(float));
            values[c] = scale * static_cast<double>(stored);
            hole = hole || stored < 0;
          }
          if (hole) {
            builder.Skip(SetAsideReason::kHole);
            continue;
          }
          const double phi_i = at(p, n_pi, 2 * kPi);
          if (builder.Add(FromSpherical(theta_i, phi_i), FromSpherical(theta_o, phi_i + at(d, n_diff, diff_span)),
                          values.data(), static_cast<std::uint32_t>(std::min<std::size_t>(cell, UINT32_MAX)))) {
            solid_angle.push_back(measure);
          }
        }
      }
    }
  }
  Measurement measurement = builder.Finish();
  ScaleToMeanOne(&measurement.samples.solid_angle);
  measurement.isotropic = n_pi == 1;
  measurement.conventions["mit-cell"] = Name(options.mit_cell);
  measurement.conventions["mit-scale"] = FormatDouble(scale) + (options.mit_scale ? " (option)" : " (default)");
  measurement.conventions["mit-stride"] = std::to_string(stride) + (options.mit_stride ? " (option)" : " (automatic)");
  if (stride > 1) {
    measurement.remarks.push_back("every " + std::to_string(stride) + ". azimuth of the " + std::to_string(cells) +
                                  " cells was read (--mit-stride 1 reads all)");
  }
  return measurement;
}

}  // namespace lobefit

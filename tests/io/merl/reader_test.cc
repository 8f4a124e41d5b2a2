#include <array>
#include <cmath>
#include <cstring>

#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr std::array<std::int32_t, 3> kDims = {90, 90, 180};
constexpr std::size_t kCells = 90 * 90 * 180;

std::string Table(const std::function<double(std::size_t cell, std::size_t channel)>& stored) {
  std::string bytes(12 + 24 * kCells, '\0');
  std::memcpy(bytes.data(), kDims.data(), 12);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < kCells; ++i) {
      const double value = stored(i, c);
      std::memcpy(bytes.data() + 12 + 8 * (i + c * kCells), &value, 8);
    }
  }
  return bytes;
}

TEST(Merl, EveryCellStandsAtItsAngles) {
  const TemporaryFile file(Table([](std::size_t cell, std::size_t channel) {
    return static_cast<double>(cell) + 0.25 * static_cast<double>(channel);
  }));
  for (const CellPosition position : {CellPosition::kCentre, CellPosition::kEdge}) {
    ReadOptions options;
    options.merl_cell = position;
    const Measurement m = ReadMeasurement(file.path(), options);
    const double shift = position == CellPosition::kCentre ? 0.5 : 0.0;
    EXPECT_EQ(m.format, "merl");
    EXPECT_TRUE(m.isotropic);
    EXPECT_EQ(m.samples.size() + m.set_aside.total(), kCells);
    double measure = 0;
    std::size_t checked = 0;
    for (std::size_t i = 0; i < m.samples.size(); i += 997, ++checked) {
      const std::size_t cell = m.samples.origin[i];
      const double ih = static_cast<double>(cell / (90 * 180)), id = static_cast<double>(cell / 180 % 90),
                   ip = static_cast<double>(cell % 180);
      const double h = (ih + shift) / 90;
      Vec3 wi, wo;
      FromHalfDifference({h * h * kPi / 2, 0, (id + shift) / 90 * kPi / 2, (ip + shift) / 180 * kPi}, &wi, &wo);
      ASSERT_NEAR(Norm(wi - m.samples.wi(i)), 0, 1e-13) << cell;
      ASSERT_NEAR(Norm(wo - m.samples.wo(i)), 0, 1e-13) << cell;
      const double stored = static_cast<double>(cell);
      ASSERT_NEAR(m.samples.values[0][i], stored / 1500, 1e-9);
      ASSERT_NEAR(m.samples.values[1][i], (stored + 0.25) * 1.15 / 1500, 1e-9);
      ASSERT_NEAR(m.samples.values[2][i], (stored + 0.5) * 1.66 / 1500, 1e-9);
    }
    EXPECT_GT(checked, 1000U);
    for (const double solid_angle : m.samples.solid_angle) measure += solid_angle;
    EXPECT_NEAR(measure / static_cast<double>(m.samples.size()), 1, 1e-9);
  }
}

// The measure of all cells that are pairs of directions, times the turn about the normal, is the measure of all pairs:
// (2 pi)^2.
TEST(Merl, SolidAnglesAddUpToAllPairsOfDirections) {
  const TemporaryFile file(Table([](std::size_t, std::size_t) { return 1.0; }));
  const Measurement m = ReadMeasurement(file.path());
  // cell measure = 4 cos(td) sin(th) sin(td) dth dtd dpd; recover its scale from one cell.
  const std::size_t i = m.samples.size() / 3, cell = m.samples.origin[i];
  const auto edge = [](double k) { return k / 90 * (k / 90) * kPi / 2; };
  const double ih = static_cast<double>(cell / (90 * 180)),
               td = (static_cast<double>(cell / 180 % 90) + 0.5) / 90 * kPi / 2;
  const double true_measure = 4 * std::cos(td) * std::sin(edge(ih + 0.5)) * std::sin(td) * (edge(ih + 1) - edge(ih)) *
                              (kPi / 2 / 90) * (kPi / 180);
  const double scale = true_measure / m.samples.solid_angle[i];
  // phi_d covers half a turn (factor 2), phi_h a whole one (2 pi).
  const double total = scale * static_cast<double>(m.samples.size()) * 2 * 2 * kPi;
  EXPECT_NEAR(total / (4 * kPi * kPi), 1, 2e-3);
}

TEST(Merl, ANegativeChannelIsAHoleInAllAndNanIsCounted) {
  const std::size_t hole = 180 * (10 + 90 * 20) + 90, nan = hole + 5;
  const TemporaryFile file(Table([&](std::size_t cell, std::size_t channel) {
    if (cell == hole && channel == 1) return -1.0;
    if (cell == nan && channel == 2) return std::nan("");
    return 1.0;
  }));
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kNotFinite], 1U);
  for (const std::uint32_t origin : m.samples.origin) ASSERT_NE(origin, hole);
}

}  // namespace
}  // namespace lobefit

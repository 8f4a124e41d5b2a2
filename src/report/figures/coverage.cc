#include "lobefit/report/figures/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/png.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

constexpr int kCells = CoverageDisc::kCells;
constexpr double kWidth = 780, kHeight = 394, kMargin = 20, kGap = 24, kTop = 92, kScaleRoom = 46;
// Room for the legend of what was left out.
constexpr double kLegendRoom = 22;
constexpr std::array<Rgb, kLeftOutWords.size()> kLeftOutColors = {style::kVermilion, style::kOrange, style::kGreen,
                                                                  style::kPurple, style::kRed};
// Up to this many cells are drawn as dots, which a reader sees even where they stand alone.
constexpr std::size_t kMostDots = 500;

// Many samples are dark, as ink is; the palest colours would not show on the paper.
Rgb CountColor(double t) { return SequentialColor(0.85 * (1 - t)); }

double RadiusOf(const Vec3& w) { return std::atan2(std::hypot(w.x, w.y), w.z) / (kPi / 2); }

// -1..1 on the disc.
Point OnDisc(const Vec3& w) {
  const double length = std::hypot(w.x, w.y), scale = length > 0 ? RadiusOf(w) / length : 0;
  return {w.x * scale, w.y * scale};
}

std::size_t CellOf(const Vec3& w) {
  const Point at = OnDisc(w);
  const auto cell = [](double t) { return std::clamp(static_cast<int>((t + 1) / 2 * kCells), 0, kCells - 1); };
  return PixelIndex(cell(at.x), cell(-at.y), kCells);
}

std::array<std::size_t, kLeftOutWords.size()> CountLeftOut(const std::vector<LeftOut>& left_out) {
  std::array<std::size_t, kLeftOutWords.size()> counts = {};
  for (const LeftOut& one : left_out) ++counts[static_cast<std::size_t>(one.reason)];
  return counts;
}

// Rings in the colours of the cells' reasons, and their number.
void DrawLegend(const std::vector<LeftOut>& left_out, Canvas* canvas, double y) {
  const std::array<std::size_t, kLeftOutWords.size()> counts = CountLeftOut(left_out);
  const TextStyle note = style::Note();
  double x = kMargin;
  canvas->Text({x, y}, "left out:", note);
  x += canvas->TextWidth("left out:", note) + 14;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (counts[r] == 0) continue;
    const std::string words = Count(counts[r]) + " " + kLeftOutWords[r];
    canvas->Ring({x, y - 4}, 3, {kLeftOutColors[r], 1.5});
    canvas->Text({x + 8, y}, words, note);
    x += 8 + canvas->TextWidth(words, note) + 16;
  }
}

void DrawDisc(const CoverageDisc& disc, const Range& range, Canvas* canvas, const Box& box, bool names_rings) {
  const Point center = box.center();
  const double radius = box.width / 2;
  canvas->Disc(center, radius, style::kShade);
  for (const double theta : {30.0, 60.0}) canvas->Ring(center, radius * theta / 90, {style::kRule, 1});
  canvas->Line({box.x, center.y}, {box.right(), center.y}, {style::kRule, 1});
  canvas->Line({center.x, box.y}, {center.x, box.bottom()}, {style::kRule, 1});
  const auto filled = static_cast<std::size_t>(
      std::count_if(disc.counts.begin(), disc.counts.end(), [](std::size_t n) { return n > 0; }));
  const double step = box.width / kCells;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const std::size_t count = disc.counts[PixelIndex(column, row, kCells)];
      if (count == 0) continue;
      const double t = std::log(static_cast<double>(count) / range.low) / std::log(range.high / range.low);
      const Rgb color = CountColor(t);
      const Box cell = {box.x + column * step, box.y + row * step, step, step};
      if (filled <= kMostDots) {
        canvas->Disc(cell.center(), 0.62 * step, color);
      } else {
        canvas->Fill(cell, color);
      }
    }
  }
  for (int row = 0; row < kCells && !disc.left_out.empty(); ++row) {
    for (int column = 0; column < kCells; ++column) {
      const std::optional<LeftOutReason>& reason = disc.left_out[PixelIndex(column, row, kCells)];
      if (!reason) continue;
      const Point at = {box.x + (column + 0.5) * step, box.y + (row + 0.5) * step};
      canvas->Ring(at, 0.42 * step, {kLeftOutColors[static_cast<std::size_t>(*reason)], 1.3});
    }
  }
  canvas->Ring(center, radius, {style::kSecondary, 1});
  // Between the axes, where one plane of directions does not cover them.
  const TextStyle note = {.size = style::kNoteSize, .color = style::kSecondary};
  const double diagonal = std::sqrt(0.5);
  if (names_rings) {
    for (const double theta : {30.0, 60.0}) {
      const double along = radius * theta / 90 * diagonal + 2;
      canvas->Text({center.x + along, center.y - along}, std::to_string(std::lround(theta)) + "°", note);
    }
  }
  TextStyle title = style::Body(style::kInk, Align::kCenter);
  title.weight = Weight::kBold;
  title.markup = true;
  canvas->Text({center.x, box.y - 10}, disc.title, title);
}

}  // namespace

std::vector<CoverageDisc> CountCoverage(const Measurement& measurement) {
  const std::size_t cells = PixelIndex(0, kCells, kCells);
  std::vector<CoverageDisc> discs = {{"incident directions  ω_i", std::vector<std::size_t>(cells), {}},
                                     {"outgoing directions  ω_o", std::vector<std::size_t>(cells), {}},
                                     {"half vectors  ω_h", std::vector<std::size_t>(cells), {}}};
  // The cell of a pair in each disc.
  const auto cells_of = [&](Vec3 wi, Vec3 wo) {
    if (measurement.isotropic) {
      const double turn = -std::atan2(wi.y, wi.x);
      wi = RotateZ(wi, turn);
      wo = RotateZ(wo, turn);
    }
    return std::array<std::size_t, 3>{CellOf(wi), CellOf(wo), CellOf(HalfVector(wi, wo))};
  };
  const Samples& samples = measurement.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::array<std::size_t, 3> at = cells_of(samples.wi(i), samples.wo(i));
    for (std::size_t d = 0; d < discs.size(); ++d) ++discs[d].counts[at[d]];
  }
  if (measurement.left_out.empty()) return discs;
  using Counts = std::array<std::uint32_t, kLeftOutWords.size()>;
  std::array<std::vector<Counts>, 3> left_out;
  for (std::vector<Counts>& disc : left_out) disc.resize(cells);
  for (const LeftOut& one : measurement.left_out) {
    const std::array<std::size_t, 3> at = cells_of(one.wi, one.wo);
    for (std::size_t d = 0; d < discs.size(); ++d) ++left_out[d][at[d]][static_cast<std::size_t>(one.reason)];
  }
  for (std::size_t d = 0; d < discs.size(); ++d) {
    discs[d].left_out.resize(cells);
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const Counts& counts = left_out[d][cell];
      const auto most = std::max_element(counts.begin(), counts.end());
      if (*most > 0) discs[d].left_out[cell] = static_cast<LeftOutReason>(most - counts.begin());
    }
  }
  return discs;
}

void WriteCoveragePng(const Measurement& measurement, const std::filesystem::path& path, const ReportOptions& options) {
  if (measurement.samples.size() == 0) throw InputError(measurement.source + ": no sample to draw");
  const std::vector<CoverageDisc> discs = CountCoverage(measurement);
  std::size_t most = 2;
  for (const CoverageDisc& disc : discs)
    most = std::max(most, *std::max_element(disc.counts.begin(), disc.counts.end()));
  const Range range = {1, static_cast<double>(most), true};
  const double height = kHeight + (measurement.left_out.empty() ? 0 : kLegendRoom);
  Canvas canvas(kWidth, height, options.scale, std::make_shared<Fonts>(options.font_folders));
  const double inner = kWidth - 2 * kMargin, side = (inner - 2 * kGap) / 3;
  TextStyle title = {.size = 16, .color = style::kInk, .weight = Weight::kBold};
  canvas.Text({kMargin, kMargin + 14}, canvas.Shorten(measurement.source, title, inner, true), title);
  std::string words = measurement.format + "  ·  " + Count(measurement.samples.size()) + " samples";
  if (measurement.isotropic) words += "  ·  isotropic: turned so that the light is at azimuth 0";
  canvas.Text({kMargin, kMargin + 34}, words, style::Note());
  for (std::size_t k = 0; k < discs.size(); ++k)
    DrawDisc(discs[k], range, &canvas, {kMargin + static_cast<double>(k) * (side + kGap), kTop, side, side}, k == 0);
  if (!measurement.left_out.empty()) DrawLegend(measurement.left_out, &canvas, height - 14);
  DrawColorScale(&canvas, {kMargin + 4, kHeight - kScaleRoom + 2, 220, 9}, CountColor, range,
                 LogTicks(range.low, range.high, 5), "samples a cell");
  canvas.Text({kWidth - kMargin, kHeight - kScaleRoom + 11},
              "radius: polar angle, azimuth from the right, counter-clockwise",
              style::Note(style::kSecondary, Align::kRight));
  WritePng(canvas.pixels(), 96 * options.scale, path, options.threads);
}

}  // namespace lobefit

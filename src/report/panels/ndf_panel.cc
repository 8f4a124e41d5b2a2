// The fitted normal distribution in slope space: contours, mean and axes, over the density that the samples imply.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr int kCells = 72;
constexpr double kDecades = 3;
// Contours where the density is this share of its peak.
constexpr std::array<double, 3> kLevels = {0.5, 0.1, 0.01};

// Density of slopes at a normal.
double SlopeDensity(const NormalDistribution& distribution, const Vec3& m) {
  return distribution.D(m) * m.z * m.z * m.z * m.z;
}

Vec3 NormalAt(double slope_x, double slope_y) { return Normalized(Vec3{-slope_x, -slope_y, 1.0}); }

// The share of the peak at rho widths from the mean, which all lobes of slope space have in common, inverted.
double Radius(const Lobe& lobe, const LobeShape& shape, double level) {
  LobeShape centred = shape;
  centred.slope = {{0, 0, shape.slope.v[2], 0, shape.slope.v[2]}};
  const std::unique_ptr<NormalDistribution> distribution = DistributionOf(lobe, centred, nullptr);
  const double a = std::exp(shape.slope.v[2]), peak = SlopeDensity(*distribution, {0, 0, 1});
  double low = 0, high = 100;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (SlopeDensity(*distribution, NormalAt(a * middle, 0)) > level * peak ? low : high) = middle;
  }
  return low;
}

struct NdfPicture {
  const ReportData& data;
  double center_x = 0, center_y = 0, half = 1;  // what is drawn of slope space
  std::vector<float> density;                   // of kCells x kCells, share of the fitted peak; NaN: no sample
};

Point OnEllipse(const SlopeFrame& frame, double rho, double t) {
  const double c = rho * std::cos(t), s = rho * std::sin(t);
  return {frame.slope_x + frame.a * c, frame.slope_y + frame.b * c + frame.c * s};
}

// Empty cells take the mean of the nearest filled ones up to three away, so that a grid of directions leaves no holes
// and a plane of them is an even stripe.
void FillGaps(std::vector<float>* density) {
  constexpr int kReach = 3, kReach2 = 12;  // and its square, of a round disc of cells
  const std::vector<float> before = *density;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      if (!std::isnan(before[PixelIndex(column, row, kCells)])) continue;
      float sum = 0;
      int count = 0, nearest = kReach2;
      for (int y = std::max(0, row - kReach); y <= std::min(kCells - 1, row + kReach); ++y) {
        for (int x = std::max(0, column - kReach); x <= std::min(kCells - 1, column + kReach); ++x) {
          const float d = before[PixelIndex(x, y, kCells)];
          const int away = (x - column) * (x - column) + (y - row) * (y - row);
          if (std::isnan(d) || away > nearest) continue;
          if (away < nearest) sum = 0, count = 0, nearest = away;
          sum += d, ++count;
        }
      }
      if (count > 0) (*density)[PixelIndex(column, row, kCells)] = sum / static_cast<float>(count);
    }
  }
}

// The density at a sample's half vector: the fitted one, corrected by how much the sample's specular part differs from
// the fit's.
void FindDensity(NdfPicture* ndf) {
  const ReportData& data = ndf->data;
  const Samples& samples = data.measurement.samples;
  const SlopeCoordinates& shape = data.fitted.lobe_shapes()[0];
  const std::unique_ptr<NormalDistribution> distribution =
      DistributionOf(data.material.model.lobes[0], data.fitted.shapes()[0], nullptr);
  const double peak = SlopeDensity(*distribution, NormalAt(shape.v[0], shape.v[1]));
  std::vector<double> diffuse(data.channels(), 0.0);
  if (data.material.model.diffuse != Diffuse::kNone) diffuse = data.material.Values().back();
  std::vector<double> sums(kCells * kCells), counts(kCells * kCells);
  std::vector<double> radial(kCells), radial_counts(kCells);
  constexpr std::size_t kTaken = 400000;
  const std::size_t step = 1 + samples.size() / kTaken;
  std::vector<double> f(data.channels());
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const Vec3 h = HalfVector(samples.wi(i), samples.wo(i));
    const double x = -h.x / h.z, y = -h.y / h.z;
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = static_cast<double>(data.fitted_values[c][i]);
    const double lambert = data.Display(diffuse) * kInvPi, specular = data.Display(f) - lambert;
    if (!(specular > 0)) continue;
    const double d = SlopeDensity(*distribution, h) * (data.Display(samples.values, i) - lambert) / specular / peak;
    if (data.measurement.isotropic) {
      const auto bin = static_cast<std::size_t>(std::hypot(x, y) / ndf->half * (kCells / 2.0));
      if (bin < radial.size()) radial[bin] += d, radial_counts[bin] += 1;
      continue;
    }
    const int column = static_cast<int>(std::floor(((x - ndf->center_x) / ndf->half + 1) * kCells / 2));
    const int row = static_cast<int>(std::floor((1 - (y - ndf->center_y) / ndf->half) * kCells / 2));
    if (column < 0 || row < 0 || column >= kCells || row >= kCells) continue;
    sums[PixelIndex(column, row, kCells)] += d;
    counts[PixelIndex(column, row, kCells)] += 1;
  }
  ndf->density.assign(sums.size(), std::numeric_limits<float>::quiet_NaN());
  const auto mean_near = [](const std::vector<double>& sum, const std::vector<double>& count, int at, int size,
                            int reach) {
    // Of the nearest cells that hold samples, in one dimension.
    for (int r = 0; r <= reach; ++r) {
      double total = 0, number = 0;
      for (const int k : {at - r, at + r}) {
        if (k < 0 || k >= size) continue;
        total += sum[static_cast<std::size_t>(k)], number += count[static_cast<std::size_t>(k)];
      }
      if (number > 0) return total / number;
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const std::size_t i = PixelIndex(column, row, kCells);
      if (data.measurement.isotropic) {
        const int bin = static_cast<int>(std::hypot(column + 0.5 - kCells / 2.0, row + 0.5 - kCells / 2.0));
        if (bin < kCells) ndf->density[i] = static_cast<float>(mean_near(radial, radial_counts, bin, kCells, 3));
      } else if (counts[i] > 0) {
        ndf->density[i] = static_cast<float>(sums[i] / counts[i]);
      }
    }
  }
  if (!data.measurement.isotropic) FillGaps(&ndf->density);
}

// Light to dark, so that the contours stand out.
Rgb Shade(double t) {
  const auto mix = [t](int a, int b) {
    return static_cast<std::uint8_t>(std::lround(a + std::clamp(t, 0.0, 1.0) * (b - a)));
  };
  return {mix(240, 64), mix(244, 124), mix(248, 176)};
}

double ColorOf(double density) { return density > 0 ? 1 + std::log10(density) / kDecades : 0; }

void Draw(const NdfPicture& ndf, Canvas* canvas, const Box& content) {
  const ReportData& data = ndf.data;
  const double size = std::min(content.width - 56, content.height - 100);
  const Box frame = {content.x + 52, content.y + 4, size, size};
  const Axes axes(frame, {ndf.center_x - ndf.half, ndf.center_x + ndf.half, false},
                  {ndf.center_y - ndf.half, ndf.center_y + ndf.half, false});
  const std::vector<Tick> x_ticks = LinearTicks(ndf.center_x - ndf.half, ndf.center_x + ndf.half, 5);
  const std::vector<Tick> y_ticks = LinearTicks(ndf.center_y - ndf.half, ndf.center_y + ndf.half, 5);
  if (!ndf.density.empty()) {
    cv::Mat picture(kCells, kCells, CV_8UC3);
    for (int row = 0; row < kCells; ++row) {
      for (int column = 0; column < kCells; ++column) {
        const float d = ndf.density[PixelIndex(column, row, kCells)];
        const Rgb c = std::isnan(d) ? Rgb{255, 255, 255} : Shade(ColorOf(static_cast<double>(d)));
        picture.at<cv::Vec3b>(row, column) = {c.r, c.g, c.b};
      }
    }
    canvas->Image(picture, frame, false);
  }
  {
    const Canvas::Clip clip(canvas, frame);
    // Slope zero: the macroscopic normal.
    canvas->Line({axes.MapX(0), frame.y}, {axes.MapX(0), frame.bottom()}, {style::kFaint, 0.5, 1, 4, 3});
    canvas->Line({frame.x, axes.MapY(0)}, {frame.right(), axes.MapY(0)}, {style::kFaint, 0.5, 1, 4, 3});
    const std::array<Rgb, 3> colors = {style::kInk, style::kVermilion, style::kPurple};
    for (std::size_t lobe = 0; lobe < data.fitted.lobe_shapes().size(); ++lobe) {
      const SlopeCoordinates& coordinates = data.fitted.lobe_shapes()[lobe];
      const Lobe& kind = data.material.model.lobes[lobe];
      const SlopeFrame shape(coordinates);
      const Rgb color = colors[lobe % colors.size()];
      for (const double level : kLevels) {
        const double radius = Radius(kind, data.fitted.shapes()[lobe], level);
        std::vector<Point> line;
        for (int k = 0; k <= 180; ++k) {
          const Point s = OnEllipse(shape, radius, k * kPi / 90);
          line.push_back(axes.Map(s.x, s.y));
        }
        canvas->Polyline(line, {color, 1});
      }
      // Principal axes of the contours: eigenvectors of L L^T.
      const double q11 = shape.a * shape.a, q12 = shape.a * shape.b, q22 = shape.b * shape.b + shape.c * shape.c;
      const double turn = 0.5 * std::atan2(2 * q12, q11 - q22), mean = (q11 + q22) / 2,
                   part = std::hypot((q11 - q22) / 2, q12);
      for (int k = 0; k < 2; ++k) {
        const double length = Radius(kind, data.fitted.shapes()[lobe], kLevels[1]) *
                              std::sqrt(std::max(0.0, mean + (k == 0 ? part : -part))),
                     angle = turn + k * kPi / 2;
        const double dx = length * std::cos(angle), dy = length * std::sin(angle);
        canvas->Line(axes.Map(shape.slope_x - dx, shape.slope_y - dy), axes.Map(shape.slope_x + dx, shape.slope_y + dy),
                     {style::kVermilion, 1});
      }
      canvas->Disc(axes.Map(shape.slope_x, shape.slope_y), 3.5, style::kVermilion);
    }
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "slope  −m_x / m_z");
  axes.DrawYLabel(canvas, "slope  −m_y / m_z", ndf.half < 0.02 ? 47 : 38);  // small numbers are longer
  double y = frame.bottom() + 58;
  const auto line = [&](const std::string& text) {
    canvas->Text({content.x, y}, text, {.size = style::kNoteSize, .color = style::kSecondary, .markup = true});
    y += 16;
  };
  line("Contours: fitted density at 1/2, 1/10, 1/100 of its peak.");
  line(ndf.density.empty() ? "Axes and mean slope in vermilion."
                           : "Axes and mean slope in vermilion. Shade: density from the samples.");
}

}  // namespace

std::optional<Panel> NdfPanel(const ReportData& data) {
  const std::vector<SlopeCoordinates>& shapes = data.fitted.lobe_shapes();
  if (shapes.empty()) return std::nullopt;
  const auto ndf = std::make_shared<NdfPicture>(NdfPicture{data, 0, 0, 1, {}});
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0;  // the normal is in the picture
  for (std::size_t lobe = 0; lobe < shapes.size(); ++lobe) {
    const SlopeFrame shape(shapes[lobe]);
    const double reach = 1.08 * Radius(data.material.model.lobes[lobe], data.fitted.shapes()[lobe], kLevels[2]);
    const double reach_x = reach * shape.a, reach_y = reach * std::hypot(shape.b, shape.c);
    low_x = std::min(low_x, shape.slope_x - reach_x), high_x = std::max(high_x, shape.slope_x + reach_x);
    low_y = std::min(low_y, shape.slope_y - reach_y), high_y = std::max(high_y, shape.slope_y + reach_y);
  }
  ndf->center_x = (low_x + high_x) / 2;
  ndf->center_y = (low_y + high_y) / 2;
  ndf->half = std::max(high_x - low_x, high_y - low_y) / 2;
  if (shapes.size() == 1) FindDensity(ndf.get());
  Panel panel;
  panel.id = "ndf";
  panel.title = "Normal distribution";
  panel.wide = false;
  panel.height = [](Canvas*, double width) { return std::min(width, 420.0) - 56 + 100; };
  panel.draw = [ndf](Canvas* canvas, const Box& content) { Draw(*ndf, canvas, content); };
  return panel;
}

}  // namespace lobefit

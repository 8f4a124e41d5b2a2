#include "text/terminal_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/math/directions.h"
#include "lobefit/report/figures/slices.h"

namespace lobefit {
namespace {

constexpr int kRows = 12, kMostColumns = 100, kLeft = 10;
constexpr double kMostDecades = 5;

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double MeanMeasured(const Samples& samples, std::size_t i) {
  double sum = 0;
  for (const auto& channel : samples.values) sum += channel[i];
  return sum / static_cast<double>(samples.values.size());
}

// Root mean square of ln(measured / fitted) over the samples and channels where both are positive.
double Miss(const Reflectance& fitted, const Measurement& measurement, const Slice& slice) {
  const Samples& samples = measurement.samples;
  std::vector<double> f_r(fitted.channels());
  double sum = 0;
  std::size_t count = 0;
  for (const SlicePoint& point : slice.points) {
    fitted.Evaluate(samples.wi(point.sample), samples.wo(point.sample), f_r.data());
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      const double measured = samples.values[c][point.sample];
      if (!(measured > 0) || !(f_r[c] > 0)) continue;
      const double ratio = std::log(measured / f_r[c]);
      sum += ratio * ratio;
      ++count;
    }
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

class Grid {
 public:
  Grid(int columns, double low, double high)
      : width_(columns - kLeft - 1),
        low_(std::log10(low)),
        high_(std::log10(high)),
        rows_(kRows, std::string(static_cast<std::size_t>(width_), ' ')) {}

  int width() const { return width_; }
  double AngleAt(int column) const { return -90 + 180 * (column + 0.5) / width_; }

  void Mark(double degrees, double value, char mark) {
    if (!(value > 0)) return;
    const int column = static_cast<int>((degrees + 90) / 180 * width_);
    const int row = static_cast<int>(std::floor((high_ - std::log10(value)) / (high_ - low_) * kRows));
    if (column < 0 || column >= width_ || row < 0 || row >= kRows) return;
    char& place = rows_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    place = place == ' ' || place == mark ? mark : '@';
  }

  std::string Text() const {
    std::string text;
    for (int row = 0; row < kRows; ++row) {
      const double top = high_ - (high_ - low_) * row / kRows;
      text += row % 3 == 0 ? fmt::format("{:>{}.2g} |", std::pow(10, top), kLeft - 2)
                           : fmt::format("{:>{}} |", "", kLeft - 2);
      const std::string& line = rows_[static_cast<std::size_t>(row)];
      text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    std::string axis(static_cast<std::size_t>(width_), '-'), labels(static_cast<std::size_t>(width_) + 4, ' ');
    for (int degrees = -60; degrees <= 60; degrees += 30) {
      const auto at = static_cast<std::size_t>((degrees + 90) / 180.0 * width_);
      axis[at] = '+';
      const std::string label = std::to_string(degrees);
      labels.replace(at - label.size() / 2, label.size(), label);
    }
    text += fmt::format("{:>{}}+{}\n", "", kLeft - 1, axis);
    return text + fmt::format("{:>{}}{}\n", "", kLeft, labels.substr(0, labels.find_last_not_of(' ') + 1));
  }

 private:
  int width_;
  double low_, high_;  // of log10 f_r
  std::vector<std::string> rows_;
};

}  // namespace

int TerminalColumns() {
  if (isatty(STDOUT_FILENO) == 0) return 0;
  winsize size = {};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

std::string WorstSlicePlot(const Material& material, const Measurement& measurement, int columns) {
  if (columns < kLeastPlotColumns) return "";
  const Slices slices = GatherSlices(measurement, GroupByStayingDirection(measurement), 8);
  const Reflectance fitted(material.model, material.Values(), measurement.channels.size());
  const Slice* worst = nullptr;
  double most = 0;
  for (const Slice& slice : slices.slices) {
    const double miss = Miss(fitted, measurement, slice);
    if (miss > most) {
      most = miss;
      worst = &slice;
    }
  }
  if (worst == nullptr) return "";

  const Samples& samples = measurement.samples;
  double low = HUGE_VAL, high = 0;
  for (const SlicePoint& point : worst->points) {
    const double value = MeanMeasured(samples, point.sample);
    if (value > 0) low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(high > 0)) return "";
  high *= 1.5;
  low = std::max(low / 1.5, high * std::pow(10, -kMostDecades));
  Grid grid(std::min(columns, kMostColumns), low, high);
  std::vector<double> f_r(fitted.channels());
  for (int column = 0; column < grid.width(); ++column) {
    Vec3 wi, wo;
    SliceDirections(slices, *worst, DegreesToRadians(grid.AngleAt(column)), &wi, &wo);
    fitted.Evaluate(wi, wo, f_r.data());
    grid.Mark(grid.AngleAt(column), Mean(f_r), '-');
  }
  for (const SlicePoint& point : worst->points)
    grid.Mark(RadiansToDegrees(point.theta), MeanMeasured(samples, point.sample), 'o');
  const char side = slices.outgoing_stays ? 'o' : 'i';
  std::string head = fmt::format("Worst slice: theta_{} = {:.4g}", side, RadiansToDegrees(worst->theta));
  if (!measurement.isotropic) head += fmt::format(", phi_{} = {:.4g}", side, RadiansToDegrees(worst->phi));
  return head +
         fmt::format(" degrees, off by {:.3g} % (rms)\n  o measured  - fitted  @ both;  f_r over theta_{}\n",
                     100 * std::expm1(most), slices.outgoing_stays ? 'i' : 'o') +
         grid.Text();
}

}  // namespace lobefit

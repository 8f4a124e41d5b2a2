#include "lobefit/io/rgl/warp.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

double Mix(double a, double b, double t) { return (1 - t) * a + t * b; }

// Largest i in [0, size - 2] with value(i) <= target (value increases); 0 where there is none.
template <class Value>
std::size_t FindInterval(std::size_t size, double target, Value&& value) {
  std::size_t low = 0, high = size - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (value(middle) < target ? low : high) = middle;
  }
  return low;
}

struct Cell {
  std::size_t index;
  double fraction;
};

Cell Locate(double x, std::size_t size) {
  const double position = std::clamp(x, 0.0, 1.0) * static_cast<double>(size - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(position), size - 2);
  return {index, position - static_cast<double>(index)};
}

// Inverts the integral of the linear function from a (at 0) to b (at 1) on [0, 1].
double InvertLinear(double a, double b, double integral) {
  if (std::fabs(a - b) < 1e-4 * (a + b)) return a + b > 0 ? std::min(2 * integral / (a + b), 1.0) : 0.5;
  const double root = std::sqrt(std::max(0.0, a * a - 2 * integral * (a - b)));
  return std::clamp((a - root) / (a - b), 0.0, 1.0);
}

}  // namespace

BilinearWarp::BilinearWarp(const float* values, std::size_t width, std::size_t height)
    : width_(width),
      height_(height),
      data_(values, values + width * height),
      conditional_(width * height, 0.0),
      marginal_(height, 0.0) {
  for (std::size_t y = 0; y < height; ++y) {
    const double* row = &data_[y * width];
    double* cdf = &conditional_[y * width];
    for (std::size_t x = 0; x + 1 < width; ++x) cdf[x + 1] = cdf[x] + 0.5 * (row[x] + row[x + 1]);
  }
  const auto row_sum = [&](std::size_t y) { return conditional_[y * width + width - 1]; };
  for (std::size_t y = 0; y + 1 < height; ++y) marginal_[y + 1] = marginal_[y] + 0.5 * (row_sum(y) + row_sum(y + 1));
  const double scale = 1 / marginal_.back();
  for (double& value : data_) value *= scale;
  for (double& value : conditional_) value *= scale;
  for (double& value : marginal_) value *= scale;
}

Vec2 BilinearWarp::Sample(const Vec2& u, double* pdf) const {
  const std::size_t row = FindInterval(height_, u.y, [&](std::size_t i) { return marginal_[i]; });
  const double* cdf0 = &conditional_[row * width_];
  const double* cdf1 = cdf0 + width_;
  const double r0 = cdf0[width_ - 1], r1 = cdf1[width_ - 1];
  const double y = InvertLinear(r0, r1, u.y - marginal_[row]);

  const auto cdf = [&](std::size_t i) { return Mix(cdf0[i], cdf1[i], y); };
  const double target = u.x * Mix(r0, r1, y);
  const std::size_t column = FindInterval(width_, target, cdf);
  const double* v0 = &data_[row * width_ + column];
  const double* v1 = v0 + width_;
  const double c0 = Mix(v0[0], v1[0], y), c1 = Mix(v0[1], v1[1], y);
  const double x = InvertLinear(c0, c1, target - cdf(column));

  const double columns = static_cast<double>(width_ - 1), rows = static_cast<double>(height_ - 1);
  *pdf = Mix(c0, c1, x) * columns * rows;
  return {(static_cast<double>(column) + x) / columns, (static_cast<double>(row) + y) / rows};
}

template <class Tables>
Vec2 BilinearWarp::InvertIn(const Tables& tables, std::size_t width, std::size_t height, const Vec2& point,
                            double* pdf) {
  const Cell x = Locate(point.x, width), y = Locate(point.y, height);
  const std::size_t row0 = y.index * width, row1 = row0 + width;
  const double c0 = Mix(tables.data(row0 + x.index), tables.data(row1 + x.index), y.fraction);
  const double c1 = Mix(tables.data(row0 + x.index + 1), tables.data(row1 + x.index + 1), y.fraction);
  const double r0 = tables.conditional(row0 + width - 1), r1 = tables.conditional(row1 + width - 1);

  const double columns = static_cast<double>(width - 1), rows = static_cast<double>(height - 1);
  *pdf = Mix(c0, c1, x.fraction) * columns * rows;
  const double along_row = Mix(tables.conditional(row0 + x.index), tables.conditional(row1 + x.index), y.fraction) +
                           x.fraction * (c0 + 0.5 * x.fraction * (c1 - c0));
  const double row_total = Mix(r0, r1, y.fraction);
  return {row_total > 0 ? std::min(along_row / row_total, 1.0) : x.fraction,
          std::min(tables.marginal(y.index) + y.fraction * (r0 + 0.5 * y.fraction * (r1 - r0)), 1.0)};
}

Vec2 BilinearWarp::Invert(const Vec2& point, double* pdf) const {
  struct Tables {
    const BilinearWarp& warp;
    double data(std::size_t i) const { return warp.data_[i]; }
    double conditional(std::size_t i) const { return warp.conditional_[i]; }
    double marginal(std::size_t i) const { return warp.marginal_[i]; }
  };
  return InvertIn(Tables{*this}, width_, height_, point, pdf);
}

Vec2 BilinearWarp::Invert(std::span<const Part> parts, const Vec2& point, double* pdf) {
  struct Tables {
    std::span<const Part> parts;
    double Sum(std::vector<double> BilinearWarp::*table, std::size_t i) const {
      double sum = 0;
      for (const Part& part : parts) sum += part.share * (part.warp->*table)[i];
      return sum;
    }
    double data(std::size_t i) const { return Sum(&BilinearWarp::data_, i); }
    double conditional(std::size_t i) const { return Sum(&BilinearWarp::conditional_, i); }
    double marginal(std::size_t i) const { return Sum(&BilinearWarp::marginal_, i); }
  };
  return InvertIn(Tables{parts}, parts[0].warp->width_, parts[0].warp->height_, point, pdf);
}

double Bilinear(const float* values, std::size_t width, std::size_t height, const Vec2& point) {
  const Cell x = Locate(point.x, width), y = Locate(point.y, height);
  const float* row0 = values + y.index * width + x.index;
  const float* row1 = row0 + width;
  return Mix(Mix(static_cast<double>(row0[0]), static_cast<double>(row0[1]), x.fraction),
             Mix(static_cast<double>(row1[0]), static_cast<double>(row1[1]), x.fraction), y.fraction);
}

}  // namespace lobefit

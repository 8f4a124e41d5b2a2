#include "lobefit/report/figures/field_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "lobefit/plot/circular_band.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/report_data.h"

namespace lobefit {

FieldImage::FieldImage(int columns, int rows)
    : width(columns),
      height(rows),
      measured(PixelIndex(0, rows, columns), std::numeric_limits<float>::quiet_NaN()),
      fitted(measured),
      log_ratio(measured) {}

int KeepNear(const std::vector<std::uint8_t>& near, FieldImage* image) {
  constexpr int kGap = 9;
  cv::Mat mask(image->height, image->width, CV_8U), closed;
  for (int row = 0; row < image->height; ++row) {
    for (int column = 0; column < image->width; ++column)
      mask.at<std::uint8_t>(row, column) = near[image->At(column, row)] != 0 ? 255 : 0;
  }
  cv::morphologyEx(mask, closed, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kGap, kGap}));
  int left = 0;
  for (int row = 0; row < image->height; ++row) {
    for (int column = 0; column < image->width; ++column) {
      const std::size_t i = image->At(column, row);
      if (closed.at<std::uint8_t>(row, column) == 0)
        image->measured[i] = image->log_ratio[i] = std::numeric_limits<float>::quiet_NaN();
      left += std::isnan(image->measured[i]) ? 0 : 1;
    }
  }
  return left;
}

float LogRatioOf(double measured, double fitted) {
  if (!(measured > 0) || !(fitted > 0)) return -kMostLogRatio;
  return std::clamp(static_cast<float>(std::log(measured / fitted)), -kMostLogRatio, kMostLogRatio);
}

FieldScale::FieldScale(const std::vector<const FieldImage*>& images) {
  std::vector<double> values, ratios;
  std::vector<double> highs;
  for (const FieldImage* image : images) {
    for (std::size_t i = 0; i < image->measured.size(); i += 3) {
      const float m = image->measured[i], f = image->fitted[i];
      if (!(m > 0) || !(f > 0)) continue;
      values.push_back(static_cast<double>(m));
      highs.push_back(static_cast<double>(std::max(m, f)));
      ratios.push_back(static_cast<double>(std::fabs(image->log_ratio[i])));
    }
  }
  if (values.empty()) return;
  // A few pixels at the tip of a peak, or at grazing angles, must not darken all others.
  const double high = Quantile(&highs, 0.998);
  values_ = {std::clamp(Quantile(&values, 0.03), high * 1e-5, high / 5), high, true};
  const double spread = Quantile(&ratios, 0.9);
  ratio_ = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05}) {
    if (std::log(nice) >= spread) ratio_ = nice;
  }
}

Rgb FieldScale::ValueColor(float value) const {
  if (std::isnan(value)) return style::kGrid;
  return SequentialColor(
      value > 0 ? std::log(static_cast<double>(value) / values_.low) / std::log(values_.high / values_.low) : 0);
}

Rgb FieldScale::RatioColor(float log_ratio) const {
  if (std::isnan(log_ratio)) return style::kGrid;
  return DivergingColor(0.5 + static_cast<double>(log_ratio) / (2 * std::log(ratio_)));
}

namespace {

double ScaleWidth(double left, double right) { return std::min(300.0, (right - left - 80) / 2); }

}  // namespace

void FieldScale::Draw(Canvas* canvas, double left, double right, double y) const {
  DrawColorScale(canvas, {left + 14, y + 14, ScaleWidth(left, right), 9}, SequentialColor, values_,
                 LogTicks(values_.low, values_.high, 5), "f_r  (1/sr)");
  DrawRatios(canvas, left, right, y);
}

void FieldScale::DrawRatios(Canvas* canvas, double left, double right, double y) const {
  const double width = ScaleWidth(left, right), inner = std::sqrt(ratio_);
  const std::vector<Tick> ticks = {
      {1 / ratio_, RatioText(1 / ratio_)}, {1 / inner, ""}, {1, "1"}, {inner, ""}, {ratio_, RatioText(ratio_)}};
  DrawColorScale(canvas, {right - width - 18, y + 14, width, 9}, DivergingColor, {1 / ratio_, ratio_, true}, ticks,
                 "measured / fitted");
}

cv::Mat Picture(const std::vector<float>& values, int width, int height, const std::function<Rgb(float)>& color) {
  cv::Mat picture(height, width, CV_8UC4);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Rgb c = color(values[PixelIndex(column, row, width)]);
      picture.at<cv::Vec4b>(row, column) = {c.r, c.g, c.b, 255};
    }
  }
  return picture;
}

std::array<cv::Mat, 3> Pictures(const FieldImage& image, const FieldScale& scale) {
  const auto value = [&scale](float v) { return scale.ValueColor(v); };
  const auto ratio = [&scale](float v) { return scale.RatioColor(v); };
  return {Picture(image.measured, image.width, image.height, value),
          Picture(image.fitted, image.width, image.height, value),
          Picture(image.log_ratio, image.width, image.height, ratio)};
}

cv::Mat RoundPicture(const cv::Mat& picture, int pixels) {
  cv::Mat large;
  cv::resize(picture, large, {pixels, pixels}, 0, 0, cv::INTER_LINEAR);
  const double radius = pixels / 2.0;
  const CircularBand disc(-1, radius);
  for (int row = 0; row < pixels; ++row) {
    auto* const line = large.ptr<cv::Vec4b>(row);
    for (int column = 0; column < pixels; ++column) line[column][3] = 0;
    disc.ForEach(radius, row + 0.5 - radius, 0, pixels,
                 [line](int column, std::uint8_t coverage) { line[column][3] = coverage; });
  }
  return large;
}

}  // namespace lobefit

// Pictures of f_r over two angles, measured, fitted and their ratio, in common colour scales.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/plot/axes.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {

// The logarithm of measured / fitted is kept within these bounds.
inline constexpr float kMostLogRatio = 4;

// Row-major pictures of one size; NaN where nothing is known.
struct FieldImage {
  int width = 0, height = 0;
  std::vector<float> measured, fitted, log_ratio;

  FieldImage() = default;
  FieldImage(int columns, int rows);
  std::size_t At(int column, int row) const { return PixelIndex(column, row, width); }
};

struct NamedField {
  std::string name;   // fit for a file: "maps.theta_i_30.phi_i_0"
  std::string title;  // for people, with markup
  std::shared_ptr<const FieldImage> image;
};

// Empties measured and log_ratio where `near` is 0, but for gaps of a few pixels between places where it is not.
// Returns the number left.
int KeepNear(const std::vector<std::uint8_t>& near, FieldImage* image);

float LogRatioOf(double measured, double fitted);

class FieldScale {
 public:
  // Scales that hold most of what the pictures show: at most five decades; ratios to their 90 % quantile.
  explicit FieldScale(const std::vector<const FieldImage*>& images);

  Rgb ValueColor(float value) const;
  Rgb RatioColor(float log_ratio) const;
  // Both scales side by side below y, between left and right.
  void Draw(Canvas* canvas, double left, double right, double y) const;
  // The ratios' scale alone.
  void DrawRatios(Canvas* canvas, double left, double right, double y) const;
  static constexpr double kHeight = 46;

 private:
  Range values_ = {0.1, 1, true};
  double ratio_ = 2;
};

// RGBA; light grey where nothing is known.
cv::Mat Picture(const std::vector<float>& values, int width, int height, const std::function<Rgb(float)>& color);

// Of what is measured, what is fitted and their ratio.
std::array<cv::Mat, 3> Pictures(const FieldImage& image, const FieldScale& scale);

// `picture` enlarged to `pixels` a side, transparent outside the disc that fills it.
cv::Mat RoundPicture(const cv::Mat& picture, int pixels);

}  // namespace lobefit

// The values of a stack, a band of rows at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "lobefit/maps/stack/exr_parts.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// values[((row width + column) channels + channel) lights + light]: f_r cos_theta_i (stack.h); NaN where a pixel is no
// number, infinite where it is saturated.
// With photographs of a white board a pixel over the board's is the ratio of what both reflect; the lights' intensities
// drop out.
struct StackBand {
  std::size_t first_row = 0, rows = 0;
  std::vector<float> values;
  std::vector<Vec3> normals;  // a texel; of a stack with a map of normals (normal_map.h)
};

// The images of a stack one by one, or side by side; one open file an image, or one for all parts.
class StackImages {
 public:
  explicit StackImages(const Stack& stack) : stack_(stack) {}
  // Throws InputError.
  std::unique_ptr<ImageRows> Open(std::size_t image);

 private:
  const Stack& stack_;
  std::optional<ExrParts> parts_;
};

// Decodes all images together, from the top; memory: one row and the decoder's state an image. One file an image is
// open.
class StackReader {
 public:
  // Raises this process' limit of open files as far as it may. Throws InputError.
  explicit StackReader(const Stack& stack);
  std::size_t next_row() const { return next_row_; }
  // The rows up to `first_row` are decoded and dropped. Domain: first_row >= next_row(), within the picture. Throws
  // InputError.
  StackBand Read(std::size_t first_row, std::size_t rows);

 private:
  const Stack& stack_;
  // The next row of a picture, linear; infinite where it is saturated.
  void NextLinear(ImageRows* image, std::vector<float>* row) const;

  std::vector<std::unique_ptr<ImageRows>> images_, white_;
  std::unique_ptr<ImageRows> dark_, normals_;
  std::vector<float> row_, dark_row_, white_row_;
  std::vector<float> table_;  // linear values of 16-bit codes, empty for floating point
  std::size_t next_row_ = 0;
};

}  // namespace lobefit

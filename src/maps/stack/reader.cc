#include "lobefit/maps/stack/reader.h"

#include <cmath>
#include <limits>

#include <sys/resource.h>

#include "lobefit/maps/stack/geometry.h"

namespace lobefit {
namespace {

void AllowFiles(std::size_t count) {
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= count + 64) return;
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? count + 64 : std::min<rlim_t>(limit.rlim_max, count + 64);
  setrlimit(RLIMIT_NOFILE, &limit);
}

// Linear value of a stored one; saturated ones are infinite.
float ValueOf(const Response& response, double stored, bool integer) {
  if (integer && stored >= response.saturation) return std::numeric_limits<float>::infinity();
  return static_cast<float>(Linear(response, stored));
}

}  // namespace

StackReader::StackReader(const Stack& stack) : stack_(stack) {
  AllowFiles(stack.images.size());
  bool integer = false;
  for (const std::filesystem::path& path : stack.images) {
    images_.push_back(OpenImage(path));
    integer = integer || images_.back()->bits() <= 16;
  }
  row_.resize(stack.width * stack.channels);
  if (!integer) return;
  table_.resize(65536);
  for (std::size_t code = 0; code < table_.size(); ++code) {
    table_[code] = ValueOf(stack.response, static_cast<double>(code) / 65535, true);
  }
}

StackBand StackReader::Read(std::size_t first_row, std::size_t rows) {
  StackBand band = {first_row, rows, {}};
  const std::size_t lights = images_.size(), channels = stack_.channels, width = stack_.width;
  band.values.resize(rows * width * channels * lights);
  for (; next_row_ < first_row; ++next_row_) {
    for (const auto& image : images_) image->Next(row_.data());
  }
  for (std::size_t y = 0; y < rows; ++y, ++next_row_) {
    for (std::size_t light = 0; light < lights; ++light) {
      images_[light]->Next(row_.data());
      const bool integer = images_[light]->bits() <= 16;
      for (std::size_t c = 0; c < channels; ++c) {
        const auto scale = static_cast<float>(1 / stack_.lights[light].intensity[c]);
        float* to = band.values.data() + (y * width * channels + c) * lights + light;
        for (std::size_t x = 0; x < width; ++x) {
          const float stored = row_[x * channels + c];
          const float value = integer ? table_[static_cast<std::size_t>(std::lround(stored * 65535.0F))]
                                      : ValueOf(stack_.response, static_cast<double>(stored), false);
          to[x * channels * lights] = value * scale;
        }
      }
      if (!stack_.near) continue;
      for (std::size_t x = 0; x < width; ++x) {
        const auto factor = static_cast<float>(1 / IrradianceAt(stack_, light, next_row_ * width + x));
        float* to = band.values.data() + (y * width + x) * channels * lights + light;
        for (std::size_t c = 0; c < channels; ++c) to[c * lights] *= factor;
      }
    }
  }
  return band;
}

}  // namespace lobefit

#include "lobefit/maps/stack/reader.h"

#include <cmath>
#include <limits>

#include <sys/resource.h>

#include "lobefit/maps/stack/geometry.h"
#include "lobefit/maps/stack/normal_map.h"

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

std::unique_ptr<ImageRows> StackImages::Open(std::size_t image) {
  if (stack_.parts.empty()) return OpenImage(stack_.images[image]);
  if (!parts_) parts_.emplace(stack_.images[image]);
  return parts_->Open(stack_.parts[image]);
}

StackReader::StackReader(const Stack& stack) : stack_(stack) {
  AllowFiles(stack.images.size() + stack.white.size() + 2);
  bool integer = false;
  const auto known = [&](std::unique_ptr<ImageRows> image) {
    integer = integer || image->bits() <= 16;
    return image;
  };
  StackImages images(stack);
  for (std::size_t i = 0; i < stack.images.size(); ++i) images_.push_back(known(images.Open(i)));
  for (const std::filesystem::path& path : stack.white) white_.push_back(known(OpenImage(path)));
  if (!stack.dark.empty()) dark_ = known(OpenImage(stack.dark));
  if (!stack.normal_map.empty()) normals_ = OpenNormalMap(stack);
  row_.resize(stack.width * stack.channels);
  dark_row_.assign(row_.size(), 0), white_row_.resize(row_.size());
  if (!integer) return;
  table_.resize(65536);
  for (std::size_t code = 0; code < table_.size(); ++code) {
    table_[code] = ValueOf(stack.response, static_cast<double>(code) / 65535, true);
  }
}

void StackReader::NextLinear(ImageRows* image, std::vector<float>* row) const {
  image->Next(row->data());
  const bool integer = image->bits() <= 16;
  for (float& value : *row) {
    value = integer ? table_[static_cast<std::size_t>(std::lround(value * 65535.0F))]
                    : ValueOf(stack_.response, static_cast<double>(value), false);
  }
}

StackBand StackReader::Read(std::size_t first_row, std::size_t rows) {
  StackBand band = {first_row, rows, {}, {}};
  const std::size_t lights = images_.size(), channels = stack_.channels, width = stack_.width;
  band.values.resize(rows * width * channels * lights);
  for (; next_row_ < first_row; ++next_row_) {
    for (const auto& image : images_) image->Next(row_.data());
    for (const auto& image : white_) image->Next(row_.data());
    if (dark_ != nullptr) dark_->Next(row_.data());
    if (normals_ != nullptr) normals_->Next(row_.data());
  }
  for (std::size_t y = 0; y < rows; ++y, ++next_row_) {
    if (normals_ != nullptr) ReadNormals(normals_.get(), stack_.normal_map_down, &band.normals);
    if (dark_ != nullptr) NextLinear(dark_.get(), &dark_row_);
    for (std::size_t light = 0; light < lights; ++light) {
      NextLinear(images_[light].get(), &row_);
      if (!white_.empty()) NextLinear(white_[light].get(), &white_row_);
      float* to = band.values.data() + y * width * channels * lights + light;
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t texel = next_row_ * width + x;
        // Of the board: its f_r cos_theta_i; else the light's fall.
        const double known = white_.empty() ? 1 / IrradianceAt(stack_, light, texel)
                                            : stack_.white_albedo * kInvPi * DirectionAt(stack_, light, texel).z;
        for (std::size_t c = 0; c < channels; ++c) {
          const std::size_t k = x * channels + c;
          float value = row_[k] - dark_row_[k];
          if (white_.empty()) {
            value *= static_cast<float>(known / stack_.lights[light].intensity[c]);
          } else {
            const float board = white_row_[k] - dark_row_[k];
            value = board > 0 && std::isfinite(board) ? value * static_cast<float>(known) / board : std::nanf("");
          }
          to[k * lights] = value;
        }
      }
    }
  }
  return band;
}

}  // namespace lobefit

// What the fit gives at the pixels of a field, many at a time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lobefit/math/vec.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/figures/report_data.h"

namespace lobefit {

class FittedPixels {
 public:
  explicit FittedPixels(const ReportData& data) : data_(data) {}

  // Directions above the horizon.
  void Add(std::size_t pixel, const Vec3& wi, const Vec3& wo) {
    pixels_.push_back(pixel);
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t j = 0; j < 6; ++j) d_[j].push_back(all[j]);
  }

  // The fitted values of those that were added since the last time.
  void Write(FieldImage* image) {
    data_.Read({d_[0].data(), d_[1].data(), d_[2].data(), d_[3].data(), d_[4].data(), d_[5].data(), pixels_.size()},
               nullptr, &f_r_);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      image->fitted[pixels_[i]] = static_cast<float>(data_.Display(f_r_, i));
    pixels_.clear();
    for (std::vector<double>& component : d_) component.clear();
  }

 private:
  const ReportData& data_;
  std::vector<std::size_t> pixels_;
  std::array<std::vector<double>, 6> d_;  // wi.x ... wo.z
  std::vector<std::vector<double>> f_r_;
};

}  // namespace lobefit

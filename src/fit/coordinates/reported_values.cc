// What is reported of a point: parameters, and how they move with the coordinates.
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/coordinates/ellipsoid_entry.h"

namespace lobefit {

ParameterValues Layout::Report(const double* u) const {
  ParameterValues values;
  std::size_t next = 0;
  const auto add_linear = [&] {
    std::vector<double> entries;
    for (std::size_t c = 0; c < channels_; ++c) entries.push_back(Value(linear_[c][next], u));
    values.push_back(entries);
    ++next;
  };
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    Ellipsoid ellipsoid = shape.slope ? EllipsoidFromSlopeCoordinates(SlopeAt(shape, u)) : EllipsoidAt(shape, u);
    for (int i = 0; i < 5; ++i) values.push_back({*EllipsoidEntry(&ellipsoid, i)});
    for (const double value : ProfileAt(l, u)) values.push_back({value});
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[l].fresnel); ++k) add_linear();
  }
  for (std::size_t k = 0; k < DiffuseParameters(recipe_.model.diffuse); ++k) add_linear();
  return values;
}

SparseRows Layout::ReportJacobian(const double* u) const {
  std::size_t rows = linear_[0].size() * channels_ + shape_size_ - first_angle_;
  for (const Lobe& lobe : recipe_.model.lobes) rows += ShapeParameters(lobe);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&entries](Eigen::Index row, std::size_t column, double value) {
    if (value != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  Eigen::Index row = 0;
  std::size_t next = 0;
  const auto add_linear = [&] {
    for (std::size_t c = 0; c < channels_; ++c, ++row) {
      if (linear_[c][next].index >= 0) add(row, static_cast<std::size_t>(linear_[c][next].index), 1);
    }
    ++next;
  };
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    double slope_jacobian[25];
    if (shape.slope) EllipsoidFromSlopeCoordinates(SlopeAt(shape, u), slope_jacobian);
    Ellipsoid ellipsoid = EllipsoidAt(shape, u);
    for (std::size_t k = 0; k < shape.entries.size(); ++k) {
      const std::size_t column = shape.first + k;
      const int i = shape.entries[k];
      if (shape.slope) {
        for (int j = 0; j < 5; ++j) add(row + j, column, slope_jacobian[5 * j + i]);
      } else {
        add(row + i, column, i < 2 ? *EllipsoidEntry(&ellipsoid, i) : 1.0);
        if (i == 0 && shape.tied) add(row + 1, column, ellipsoid.alpha_y);
      }
    }
    row += 5;
    std::vector<double> slopes;
    const std::vector<double> profile = ProfileAt(l, u, &slopes);
    for (std::size_t k = 0; k < shape.profile.size(); ++k) {
      add(row + static_cast<Eigen::Index>(shape.profile[k]), shape.first + shape.entries.size() + k, slopes[k]);
    }
    row += static_cast<Eigen::Index>(profile.size());
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[l].fresnel); ++k) add_linear();
  }
  for (std::size_t k = 0; k < DiffuseParameters(recipe_.model.diffuse); ++k) add_linear();
  for (std::size_t k = first_angle_; k < shape_size_; ++k, ++row) add(row, k, 1);
  if (recipe_.instrument.offset) add_linear();
  SparseRows jacobian(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(size()));
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}

}  // namespace lobefit

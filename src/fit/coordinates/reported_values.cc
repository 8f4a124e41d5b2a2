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

Eigen::MatrixXd Layout::ReportJacobian(const double* u) const {
  std::size_t rows = linear_[0].size() * channels_ + shape_size_ - first_angle_;
  for (const Lobe& lobe : recipe_.model.lobes) rows += ShapeParameters(lobe);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(size()));
  Eigen::Index row = 0;
  std::size_t next = 0;
  const auto add_linear = [&] {
    for (std::size_t c = 0; c < channels_; ++c, ++row) {
      if (linear_[c][next].index >= 0) jacobian(row, linear_[c][next].index) = 1;
    }
    ++next;
  };
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    double slope_jacobian[25];
    if (shape.slope) EllipsoidFromSlopeCoordinates(SlopeAt(shape, u), slope_jacobian);
    Ellipsoid ellipsoid = EllipsoidAt(shape, u);
    for (std::size_t k = 0; k < shape.entries.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(shape.first + k);
      const int i = shape.entries[k];
      if (shape.slope) {
        for (int j = 0; j < 5; ++j) jacobian(row + j, column) = slope_jacobian[5 * j + i];
      } else {
        jacobian(row + i, column) = i < 2 ? *EllipsoidEntry(&ellipsoid, i) : 1.0;
        if (i == 0 && shape.tied) jacobian(row + 1, column) = ellipsoid.alpha_y;
      }
    }
    row += 5;
    std::vector<double> slopes;
    const std::vector<double> profile = ProfileAt(l, u, &slopes);
    for (std::size_t k = 0; k < shape.profile.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(shape.first + shape.entries.size() + k);
      jacobian(row + static_cast<Eigen::Index>(shape.profile[k]), column) = slopes[k];
    }
    row += static_cast<Eigen::Index>(profile.size());
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[l].fresnel); ++k) add_linear();
  }
  for (std::size_t k = 0; k < DiffuseParameters(recipe_.model.diffuse); ++k) add_linear();
  for (std::size_t k = first_angle_; k < shape_size_; ++k, ++row) jacobian(row, static_cast<Eigen::Index>(k)) = 1;
  if (recipe_.instrument.offset) add_linear();
  return jacobian;
}

}  // namespace lobefit

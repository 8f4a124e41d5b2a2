// The form of J^T J of many channels: coordinates of one channel (its F0, its albedo) meet those of another only
// through the rest, the border (shapes, and values that channels share). Work and memory are linear in the channels.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lobefit {

class Layout;

// Which coordinates belong to the border, and which to one channel alone.
struct ArrowShape {
  std::vector<int> border;
  std::vector<std::vector<int>> own;  // [channel]
};
ArrowShape ArrowShapeOf(const Layout& layout);
// Where something couples the channels: all is border.
ArrowShape BorderOnly(const Layout& layout);

// A symmetric matrix of that form.
struct ArrowMatrix {
  ArrowShape shape;
  Eigen::MatrixXd border;               // border x border
  std::vector<Eigen::MatrixXd> across;  // [channel] border x own
  std::vector<Eigen::MatrixXd> own;     // [channel] own x own

  explicit ArrowMatrix(const ArrowShape& zero_of = {});
  Eigen::VectorXd Diagonal() const;  // by coordinate
  void AddToDiagonal(const Eigen::VectorXd& values);
  bool AllFinite() const;
  Eigen::MatrixXd Dense() const;
};

}  // namespace lobefit

// Tensor trees of BSDF-XML: a cube of 3 or 4 dimensions, halved along all of them at once where the BSDF varies, and
// the equal-area map between square and disk on which their axes lie.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// Shirley and Chiu's concentric map [Shirley, Chiu 1997]: [0, 1]^2 to the unit disk and back; areas scale by pi
// everywhere, so that a cell of the square is a cell of projected solid angle.
Vec2 SquareToDisk(const Vec2& square);
Vec2 DiskToSquare(const Vec2& disk);
// The direction above a point of the disk.
Vec3 OnHemisphere(const Vec2& disk);

class TensorTree {
 public:
  // The text in braces: "{ child child ... }" with 2^rank children, child n in the upper half of axis i where bit i of
  // n is set; or "{ value value ... }" with 2^(rank k) values, a grid of 2^k cells along each axis, the last axis
  // fastest. `fail` receives a place in `text` and a message, and throws. Trees deeper than 16 halvings are refused.
  TensorTree(std::string_view text, int rank,
             const std::function<void(std::string_view place, const std::string& message)>& fail);

  int rank() const { return rank_; }

  // One cell of a leaf: lowest corner, edge length, value and the number of the cell in the order of the text.
  struct Cell {
    std::array<double, 4> corner;
    double edge;
    double value;
    std::size_t index;
  };
  void ForEachCell(const std::function<void(const Cell&)>& take) const;

  // The value at a position in [0, 1)^rank.
  double At(const std::array<double, 4>& position) const;

 private:
  struct Node {
    int grid_log2 = -1;     // cells of a leaf along an axis; -1: a branch
    std::size_t first = 0;  // first child (of 2^rank that follow each other), or first value
  };
  class Parser;

  void Walk(std::size_t node, const std::array<double, 4>& corner, double edge,
            const std::function<void(const Cell&)>& take) const;

  int rank_;
  std::vector<Node> nodes_;
  std::vector<double> values_;
};

}  // namespace lobefit

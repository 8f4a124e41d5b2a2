// Nearest neighbours among scattered points of two to four dimensions, and values between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lobefit {

// Unused coordinates are zero.
using ScatterPoint = std::array<float, 4>;

// A k-d tree over points; built once, asked from any thread.
class ScatterTree {
 public:
  ScatterTree(std::vector<ScatterPoint> points, int dimensions);

  std::size_t size() const { return points_.size(); }
  const ScatterPoint& point(std::size_t i) const { return points_[i]; }

  static constexpr int kMost = 8;
  struct Neighbour {
    std::uint32_t index = 0;  // of the point as given
    float distance2 = 0;
  };
  // The `count` (at most kMost) nearest points, nearest first; returns how many there are.
  int Nearest(const ScatterPoint& at, int count, std::array<Neighbour, kMost>* found) const;

 private:
  void Build(std::size_t begin, std::size_t end);
  void Search(std::size_t begin, std::size_t end, const ScatterPoint& at, int count, int* have,
              std::array<Neighbour, kMost>* found) const;
  int SplitDimension(std::size_t begin, std::size_t end) const;

  std::vector<ScatterPoint> points_;
  int dimensions_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> split_;  // dimension in which the range with this middle is split
};

// Values between scattered points: inverse squared distance of the four nearest. Nothing where the nearest point is
// farther away than points stand from each other there.
class ScatterField {
 public:
  // `least_reach`: a point speaks for at least this distance around it.
  ScatterField(std::vector<ScatterPoint> points, int dimensions, float least_reach);

  // Weights of at most four points for `at`; returns their number. `near`: false where the nearest point is farther
  // away than points stand from each other there.
  int Find(const ScatterPoint& at, std::array<std::uint32_t, 4>* indices, std::array<float, 4>* weights,
           bool* near) const;

 private:
  ScatterTree tree_;
  std::vector<float> reach2_;
};

}  // namespace lobefit

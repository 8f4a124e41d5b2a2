#include "lobefit/report/figures/scatter.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lobefit {
namespace {

constexpr std::size_t kLeaf = 8;

float Distance2(const ScatterPoint& a, const ScatterPoint& b) {
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

}  // namespace

ScatterTree::ScatterTree(std::vector<ScatterPoint> points, int dimensions)
    : points_(std::move(points)), dimensions_(dimensions), order_(points_.size()), split_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  Build(0, points_.size());
}

int ScatterTree::SplitDimension(std::size_t begin, std::size_t end) const {
  int widest = 0;
  float most = -1;
  for (int d = 0; d < dimensions_; ++d) {
    const auto dim = static_cast<std::size_t>(d);
    float low = points_[order_[begin]][dim], high = low;
    // A few points say well enough which way a range is long.
    const std::size_t step = 1 + (end - begin) / 64;
    for (std::size_t i = begin; i < end; i += step) {
      low = std::min(low, points_[order_[i]][dim]), high = std::max(high, points_[order_[i]][dim]);
    }
    if (high - low > most) most = high - low, widest = d;
  }
  return widest;
}

void ScatterTree::Build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeaf) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto dim = static_cast<std::size_t>(SplitDimension(begin, end));
  const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [&](std::uint32_t a, std::uint32_t b) { return points_[a][dim] < points_[b][dim]; });
  split_[middle] = static_cast<std::uint8_t>(dim);
  Build(begin, middle);
  Build(middle + 1, end);
}

void ScatterTree::Search(std::size_t begin, std::size_t end, const ScatterPoint& at, int count, int* have,
                         std::array<Neighbour, kMost>* found) const {
  const auto offer = [&](std::uint32_t index) {
    const float distance2 = Distance2(points_[index], at);
    if (*have == count && distance2 >= (*found)[static_cast<std::size_t>(count - 1)].distance2) return;
    int place = *have < count ? (*have)++ : count - 1;
    for (; place > 0 && (*found)[static_cast<std::size_t>(place - 1)].distance2 > distance2; --place) {
      (*found)[static_cast<std::size_t>(place)] = (*found)[static_cast<std::size_t>(place - 1)];
    }
    (*found)[static_cast<std::size_t>(place)] = {index, distance2};
  };
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) offer(order_[i]);
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const std::size_t dim = split_[middle];
  const float away = at[dim] - points_[order_[middle]][dim];
  offer(order_[middle]);
  const bool left_first = away < 0;
  Search(left_first ? begin : middle + 1, left_first ? middle : end, at, count, have, found);
  if (*have < count || away * away < (*found)[static_cast<std::size_t>(count - 1)].distance2) {
    Search(left_first ? middle + 1 : begin, left_first ? end : middle, at, count, have, found);
  }
}

int ScatterTree::Nearest(const ScatterPoint& at, int count, std::array<Neighbour, kMost>* found) const {
  int have = 0;
  Search(0, points_.size(), at, std::min(count, kMost), &have, found);
  return have;
}

ScatterField::ScatterField(std::vector<ScatterPoint> points, int dimensions, float least_reach)
    : tree_(std::move(points), dimensions), reach2_(tree_.size()) {
  std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    // Itself, and as many as surround a point of a regular grid on two sides.
    const int have = tree_.Nearest(tree_.point(i), 2 * dimensions, &found);
    reach2_[i] =
        std::max(least_reach * least_reach, have == 0 ? 0 : found[static_cast<std::size_t>(have - 1)].distance2);
  }
}

int ScatterField::Find(const ScatterPoint& at, std::array<std::uint32_t, 4>* indices, std::array<float, 4>* weights,
                       bool* near) const {
  std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
  const int have = tree_.Nearest(at, 4, &found);
  // The farthest reach of the four counts: where dense rows meet sparse ones the nearest alone would leave gaps.
  float reach2 = 0;
  for (int k = 0; k < have; ++k) reach2 = std::max(reach2, reach2_[found[static_cast<std::size_t>(k)].index]);
  *near = have > 0 && found[0].distance2 <= reach2;
  float sum = 0;
  for (int k = 0; k < have; ++k) {
    const auto i = static_cast<std::size_t>(k);
    (*indices)[i] = found[i].index;
    (*weights)[i] = 1 / (found[i].distance2 + 1e-4F * found[0].distance2 + 1e-12F);
    sum += (*weights)[i];
  }
  for (int k = 0; k < have; ++k) (*weights)[static_cast<std::size_t>(k)] /= sum;
  return have;
}

}  // namespace lobefit

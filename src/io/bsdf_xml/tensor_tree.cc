#include "lobefit/io/bsdf_xml/tensor_tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// Cells of 2^-16 are far below any instrument's resolution.
constexpr int kMostHalvings = 16;

bool IsSeparator(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ','; }

}  // namespace

Vec3 OnHemisphere(const Vec2& disk) {
  return {disk.x, disk.y, std::sqrt(std::max(0.0, 1 - disk.x * disk.x - disk.y * disk.y))};
}

Vec2 SquareToDisk(const Vec2& square) {
  const double a = 2 * square.x - 1, b = 2 * square.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool along_x = std::fabs(a) > std::fabs(b);
  const double radius = along_x ? a : b;
  const double phi = along_x ? kPi / 4 * (b / a) : kPi / 2 - kPi / 4 * (a / b);
  return {radius * std::cos(phi), radius * std::sin(phi)};
}

Vec2 DiskToSquare(const Vec2& disk) {
  const double radius = std::hypot(disk.x, disk.y);
  if (radius == 0) return {0.5, 0.5};
  const bool along_x = std::fabs(disk.x) > std::fabs(disk.y);
  double a = 0, b = 0;
  if (along_x) {
    a = std::copysign(radius, disk.x);
    b = a * std::atan(disk.y / disk.x) * 4 / kPi;
  } else {
    b = std::copysign(radius, disk.y);
    a = b * std::atan(disk.x / disk.y) * 4 / kPi;
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

// Recursive descent; the depth is limited.
class TensorTree::Parser {
 public:
  Parser(std::string_view text, TensorTree* tree, const std::function<void(std::string_view, const std::string&)>& fail)
      : text_(text), tree_(tree), fail_(fail) {}

  void ParseAll() {
    tree_->nodes_.emplace_back();
    ParseNode(0, 0);
    if (Peek() != '\0') Fail("text stands after the closing brace of the tensor tree; nothing is allowed there");
  }

 private:
  // The next character that is no separator, not taken; NUL at the end.
  char Peek() {
    while (at_ < text_.size() && IsSeparator(text_[at_])) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  [[noreturn]] void Fail(const std::string& message) const {
    const std::string_view place = text_.substr(std::min(at_, text_.size()));
    fail_(place, message + "; found '" + Excerpt(place.substr(0, place.find('\n')), 24) + "'");
    throw std::logic_error("the failure function of a tensor tree returned");
  }

  void Expect(char brace) {
    if (Peek() != brace) Fail(std::string("the tensor tree should have '") + brace + "' here");
    ++at_;
  }

  void ParseNode(std::size_t node, int halvings) {
    if (halvings > kMostHalvings) {
      Fail("the tensor tree halves its axes more than " + std::to_string(kMostHalvings) + " times");
    }
    Expect('{');
    if (Peek() == '{') {
      const std::size_t children = std::size_t{1} << tree_->rank_;
      const std::size_t first = tree_->nodes_.size();
      tree_->nodes_[node].first = first;
      tree_->nodes_.resize(first + children);
      for (std::size_t n = 0; n < children; ++n) ParseNode(first + n, halvings + 1);
      if (Peek() != '}') Fail("a branch of the tensor tree has more than " + std::to_string(children) + " children");
    } else {
      ParseLeaf(node, halvings);
    }
    Expect('}');
  }

  void ParseLeaf(std::size_t node, int halvings) {
    const std::size_t first = tree_->values_.size();
    while (Peek() != '}' && Peek() != '\0') {
      std::size_t end = at_;
      while (end < text_.size() && !IsSeparator(text_[end]) && text_[end] != '}' && text_[end] != '{') ++end;
      const std::optional<double> value = ParseDouble(text_.substr(at_, end - at_));
      if (!value) Fail("a value of the tensor tree is not a number");
      tree_->values_.push_back(*value);
      at_ = end;
    }
    const std::size_t count = tree_->values_.size() - first;
    int grid_log2 = 0;
    while (grid_log2 + halvings <= kMostHalvings && (std::size_t{1} << (tree_->rank_ * grid_log2)) < count) ++grid_log2;
    if (count == 0 || (std::size_t{1} << (tree_->rank_ * grid_log2)) != count) {
      Fail("a leaf of the tensor tree has " + std::to_string(count) + " values; allowed are 1, " +
           std::to_string(1 << tree_->rank_) + ", " + std::to_string(1 << (2 * tree_->rank_)) + " and further powers");
    }
    tree_->nodes_[node] = {grid_log2, first};
  }

  std::string_view text_;
  TensorTree* tree_;
  const std::function<void(std::string_view, const std::string&)>& fail_;
  std::size_t at_ = 0;
};

TensorTree::TensorTree(std::string_view text, int rank,
                       const std::function<void(std::string_view, const std::string&)>& fail)
    : rank_(rank) {
  Parser(text, this, fail).ParseAll();
}

void TensorTree::ForEachCell(const std::function<void(const Cell&)>& take) const { Walk(0, {0, 0, 0, 0}, 1, take); }

void TensorTree::Walk(std::size_t node, const std::array<double, 4>& corner, double edge,
                      const std::function<void(const Cell&)>& take) const {
  const std::size_t rank = static_cast<std::size_t>(rank_);
  const Node& here = nodes_[node];
  std::array<double, 4> low = corner;
  if (here.grid_log2 < 0) {
    for (std::size_t n = 0; n < std::size_t{1} << rank; ++n) {
      for (std::size_t axis = 0; axis < rank; ++axis) low[axis] = corner[axis] + ((n >> axis) & 1 ? edge / 2 : 0);
      Walk(here.first + n, low, edge / 2, take);
    }
    return;
  }
  const std::size_t bits = static_cast<std::size_t>(here.grid_log2), mask = (std::size_t{1} << bits) - 1;
  const double cell_edge = std::ldexp(edge, -here.grid_log2);
  for (std::size_t n = 0; n < std::size_t{1} << (rank * bits); ++n) {
    for (std::size_t axis = 0; axis < rank; ++axis) {
      low[axis] = corner[axis] + cell_edge * static_cast<double>((n >> (bits * (rank - 1 - axis))) & mask);
    }
    take({low, cell_edge, values_[here.first + n], here.first + n});
  }
}

double TensorTree::At(const std::array<double, 4>& position) const {
  const std::size_t rank = static_cast<std::size_t>(rank_);
  std::array<double, 4> rest = position;
  std::size_t node = 0;
  while (nodes_[node].grid_log2 < 0) {
    std::size_t child = 0;
    for (std::size_t axis = 0; axis < rank; ++axis) {
      rest[axis] *= 2;
      if (rest[axis] >= 1) {
        rest[axis] -= 1;
        child |= std::size_t{1} << axis;
      }
    }
    node = nodes_[node].first + child;
  }
  const std::size_t bits = static_cast<std::size_t>(nodes_[node].grid_log2);
  std::size_t cell = 0;
  for (std::size_t axis = 0; axis < rank; ++axis) {
    cell = (cell << bits) | static_cast<std::size_t>(std::ldexp(rest[axis], nodes_[node].grid_log2));
  }
  return values_[nodes_[node].first + cell];
}

}  // namespace lobefit

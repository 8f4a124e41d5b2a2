#include "lobefit/plot/layout.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lobefit {
namespace {

// Blank area counts this much of the height that it would fill over the whole width: between two pages of about the
// same length the fuller one is taken, a much longer one never.
constexpr double kBlank = 0.5;

// The page is cut into bands, one below the other. A band holds `wide` wide panels in a column of two thirds and
// `narrow` narrow ones in the column beside it; without narrow ones a wide panel takes the whole width, without wide
// ones up to three narrow ones stand side by side.
struct Band {
  std::size_t wide = 0, narrow = 0;
};

class Arranger {
 public:
  Arranger(const std::vector<PanelSize>& panels, double left, double top, double width, double gap)
      : panels_(panels), left_(left), top_(top), width_(width), gap_(gap), third_((width - 2 * gap) / 3) {
    for (std::size_t i = 0; i < panels.size(); ++i) (panels[i].wide ? wide_ : narrow_).push_back(i);
    for (const std::size_t i : wide_) {
      column_heights_.push_back(panels[i].height(two_thirds()));
      full_heights_.push_back(panels[i].height(width));
    }
    for (const std::size_t i : narrow_) {
      column_heights_narrow_.push_back(panels[i].height(third_));
      half_heights_.push_back(panels[i].height((width - gap) / 2));
    }
  }

  PageLayout Arrange() const {
    // best[w][n]: least cost of a page with the first w wide and the first n narrow panels, and its last band.
    struct Best {
      double cost = std::numeric_limits<double>::infinity();
      Band last;
    };
    std::vector<std::vector<Best>> best(wide_.size() + 1, std::vector<Best>(narrow_.size() + 1));
    best[0][0].cost = 0;
    for (std::size_t w = 0; w <= wide_.size(); ++w) {
      for (std::size_t n = 0; n <= narrow_.size(); ++n) {
        for (std::size_t bw = 0; bw <= w; ++bw) {
          for (std::size_t bn = 0; bn <= n; ++bn) {
            const double before = best[w - bw][n - bn].cost;
            if (!IsBand({bw, bn}) || !(before < best[w][n].cost)) continue;
            const double cost = before + Cost(w - bw, n - bn, {bw, bn});
            if (cost < best[w][n].cost - 1e-6) best[w][n] = {cost, {bw, bn}};
          }
        }
      }
    }
    std::vector<Band> bands;
    for (std::size_t w = wide_.size(), n = narrow_.size(); w + n > 0;) {
      bands.insert(bands.begin(), best[w][n].last);
      w -= bands.front().wide, n -= bands.front().narrow;
    }
    PageLayout layout;
    layout.boxes.resize(panels_.size());
    double y = top_;
    std::size_t w = 0, n = 0;
    for (const Band& band : bands) {
      Place(w, n, band, y, &layout.boxes);
      y += Height(w, n, band) + gap_;
      w += band.wide, n += band.narrow;
    }
    layout.height = y - gap_;
    return layout;
  }

 private:
  double two_thirds() const { return width_ - third_ - gap_; }

  static bool IsBand(const Band& band) {
    if (band.narrow == 0) return band.wide == 1;
    return band.wide > 0 || band.narrow <= 3;
  }

  double Stack(const std::vector<double>& heights, std::size_t first, std::size_t count) const {
    double sum = count > 0 ? -gap_ : 0;
    for (std::size_t k = first; k < first + count; ++k) sum += heights[k] + gap_;
    return sum;
  }

  double Height(std::size_t w, std::size_t n, const Band& band) const {
    if (band.narrow == 0) return full_heights_[w];
    if (band.wide == 0) {
      const auto first = RowHeights(band).begin() + static_cast<std::ptrdiff_t>(n);
      return *std::max_element(first, first + static_cast<std::ptrdiff_t>(band.narrow));
    }
    return std::max(Stack(column_heights_, w, band.wide), Stack(column_heights_narrow_, n, band.narrow));
  }

  // Two side by side share the whole width.
  const std::vector<double>& RowHeights(const Band& band) const {
    return band.narrow == 2 ? half_heights_ : column_heights_narrow_;
  }

  double Cost(std::size_t w, std::size_t n, const Band& band) const {
    const double height = Height(w, n, band);
    double filled = height;  // as a height over the whole width
    if (band.wide > 0 && band.narrow > 0) {
      filled = (2 * Stack(column_heights_, w, band.wide) + Stack(column_heights_narrow_, n, band.narrow)) / 3;
    } else if (band.narrow > 0) {
      // Two have more room than they need.
      const double heights = Stack(RowHeights(band), n, band.narrow) - gap_ * static_cast<double>(band.narrow - 1);
      filled = heights / (band.narrow == 2 ? 2.4 : 3);
    }
    return height + gap_ + kBlank * (height - filled);
  }

  void Place(std::size_t w, std::size_t n, const Band& band, double y, std::vector<Box>* boxes) const {
    const double height = Height(w, n, band);
    if (band.narrow == 0) {
      (*boxes)[wide_[w]] = {left_, y, width_, height};
      return;
    }
    if (band.wide == 0) {
      const double share = band.narrow == 2 ? (width_ - gap_) / 2 : third_;
      for (std::size_t k = 0; k < band.narrow; ++k)
        (*boxes)[narrow_[n + k]] = {left_ + static_cast<double>(k) * (share + gap_), y, share, height};
      return;
    }
    const double beside = left_ + two_thirds() + gap_;
    PlaceStack(wide_, column_heights_, w, band.wide, {left_, y, two_thirds(), height}, boxes);
    PlaceStack(narrow_, column_heights_narrow_, n, band.narrow, {beside, y, third_, height}, boxes);
  }

  // Panels that can use more height share what the other column is longer, up to a quarter of their own.
  void PlaceStack(const std::vector<std::size_t>& which, const std::vector<double>& heights, std::size_t first,
                  std::size_t count, const Box& column, std::vector<Box>* boxes) const {
    double growing = 0;
    for (std::size_t k = first; k < first + count; ++k) growing += panels_[which[k]].grows ? heights[k] : 0;
    const double slack = column.height - Stack(heights, first, count),
                 share = growing > 0 ? std::min(0.25, slack / growing) : 0;
    double y = column.y;
    for (std::size_t k = first; k < first + count; ++k) {
      const double height = heights[k] * (panels_[which[k]].grows ? 1 + share : 1);
      (*boxes)[which[k]] = {column.x, y, column.width, height};
      y += height + gap_;
    }
  }

  const std::vector<PanelSize>& panels_;
  double left_, top_, width_, gap_, third_;
  std::vector<std::size_t> wide_, narrow_;
  std::vector<double> column_heights_, full_heights_, column_heights_narrow_, half_heights_;
};

}  // namespace

PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap) {
  return Arranger(panels, left, top, width, gap).Arrange();
}

}  // namespace lobefit

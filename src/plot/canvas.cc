#include "lobefit/plot/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <opencv2/imgproc.hpp>

#include "lobefit/plot/circular_band.h"

namespace lobefit {
namespace {

// OpenCV takes coordinates in 1/16 pixel; its pixel centres are at whole numbers, the page's at halves.
constexpr int kShift = 4;

cv::Point Fixed(double x, double y) {
  const double limit = 1 << 20;
  return {static_cast<int>(std::lround(std::clamp(x - 0.5, -limit, limit) * (1 << kShift))),
          static_cast<int>(std::lround(std::clamp(y - 0.5, -limit, limit) * (1 << kShift)))};
}

bool IsFinite(const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// A colour laid over pixels.
class Paint {
 public:
  Paint(Rgb color, double alpha)
      : color_(color), strength_(static_cast<int>(std::lround(std::clamp(alpha, 0.0, 1.0) * 256))) {}

  // `coverage`: 0-255.
  void Over(std::uint8_t* pixel, int coverage) const {
    const int weight = coverage * strength_;  // 0 .. 255 * 256
    const auto mix = [weight](int under, int over) {
      return static_cast<std::uint8_t>(under + ((over - under) * weight + (over > under ? 32640 : -32640)) / 65280);
    };
    pixel[0] = mix(pixel[0], color_.r);
    pixel[1] = mix(pixel[1], color_.g);
    pixel[2] = mix(pixel[2], color_.b);
  }

  // A row of pixels by a row of coverages. A line covers few pixels of the box around it: eight at a time are passed.
  void OverRow(std::uint8_t* pixels, const std::uint8_t* coverage, int count) const {
    constexpr int kWord = sizeof(std::uint64_t);
    for (int x = 0; x < count;) {
      if (std::uint64_t eight = 0; count - x >= kWord) {
        std::memcpy(&eight, coverage + x, kWord);
        if (eight == 0) {
          x += kWord;
          continue;
        }
      }
      for (const int end = std::min(count, x + kWord); x < end; ++x) {
        if (coverage[x] != 0) Over(pixels + std::ptrdiff_t{3} * x, coverage[x]);
      }
    }
  }

 private:
  Rgb color_;
  int strength_;
};

}  // namespace

bool operator==(const Rgb& a, const Rgb& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

Box Inset(const Box& box, double left, double top, double right, double bottom) {
  return {box.x + left, box.y + top, std::max(0.0, box.width - left - right), std::max(0.0, box.height - top - bottom)};
}

Canvas::Canvas(double width, double height, double scale, std::shared_ptr<Fonts> fonts)
    : width_(width),
      height_(height),
      scale_(scale),
      fonts_(std::move(fonts)),
      pixels_(static_cast<int>(std::lround(height * scale)), static_cast<int>(std::lround(width * scale)), CV_8UC3,
              cv::Scalar::all(255)),
      clip_(0, 0, pixels_.cols, pixels_.rows) {}

cv::Rect Canvas::ClipOf(const Box& box) const {
  const cv::Point low(static_cast<int>(std::lround(box.x * scale_)), static_cast<int>(std::lround(box.y * scale_)));
  const cv::Point high(static_cast<int>(std::lround(box.right() * scale_)),
                       static_cast<int>(std::lround(box.bottom() * scale_)));
  return clip_ & cv::Rect(low, high);
}

Canvas Canvas::Part(const Box& box) const {
  Canvas part = *this;
  part.clip_ = ClipOf(box);
  return part;
}

Canvas::Clip::Clip(Canvas* canvas, const Box& box) : canvas_(canvas), before_(canvas->clip_) {
  canvas->clip_ = canvas->ClipOf(box);
}

Canvas::Clip::~Clip() { canvas_->clip_ = before_; }

cv::Rect Canvas::PixelBox(double x0, double y0, double x1, double y1) const {
  const double limit = 1 << 20;
  const auto low = [&](double v) { return static_cast<int>(std::floor(std::clamp(v, -limit, limit))); };
  const auto high = [&](double v) { return static_cast<int>(std::ceil(std::clamp(v, -limit, limit))); };
  return cv::Rect(cv::Point(low(x0), low(y0)), cv::Point(high(x1), high(y1))) & clip_;
}

void Canvas::Blend(const cv::Mat& coverage, cv::Point at, Rgb color, double alpha) {
  const cv::Rect area = cv::Rect(at.x, at.y, coverage.cols, coverage.rows) & clip_;
  const Paint paint(color, alpha);
  for (int y = area.y; y < area.y + area.height; ++y) {
    paint.OverRow(pixels_.ptr<std::uint8_t>(y) + std::ptrdiff_t{3} * area.x,
                  coverage.ptr<std::uint8_t>(y - at.y) + (area.x - at.x), area.width);
  }
}

void Canvas::Fill(const Box& box, Rgb color, double alpha) {
  // Whole pixels: neighbouring areas meet without a seam.
  const cv::Rect area = ClipOf(box);
  if (area.empty()) return;
  const Paint paint(color, alpha);
  for (int y = area.y; y < area.y + area.height; ++y) {
    std::uint8_t* row = pixels_.ptr<std::uint8_t>(y);
    for (int x = area.x; x < area.x + area.width; ++x) paint.Over(row + std::ptrdiff_t{3} * x, 255);
  }
}

void Canvas::Frame(const Box& box, const Stroke& stroke) {
  Run({{box.x, box.y}, {box.right(), box.y}, {box.right(), box.bottom()}, {box.x, box.bottom()}}, stroke, true);
}

void Canvas::Run(const std::vector<Point>& points, const Stroke& stroke, bool closed) {
  if (points.size() < 2) return;
  double x0 = points[0].x, x1 = x0, y0 = points[0].y, y1 = y0;
  for (const Point& p : points) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  const int thickness = std::max(1, static_cast<int>(std::lround(stroke.width * scale_)));
  const cv::Rect area = PixelBox(x0 * scale_ - thickness - 2, y0 * scale_ - thickness - 2, x1 * scale_ + thickness + 2,
                                 y1 * scale_ + thickness + 2);
  if (area.empty()) return;
  std::vector<cv::Point> fixed;
  fixed.reserve(points.size());
  // Straight lines along the axes sit on whole pixels: crisp, and equal wherever they are drawn.
  bool upright = points.size() == 2 || closed;
  for (std::size_t i = 1; i < points.size(); ++i)
    upright &= points[i].x == points[i - 1].x || points[i].y == points[i - 1].y;
  const double half = thickness % 2 == 1 ? 0.5 : 0.0;
  for (const Point& p : points) {
    double x = p.x * scale_, y = p.y * scale_;
    if (upright) x = std::floor(x) + half, y = std::floor(y) + half;
    fixed.push_back(Fixed(x - area.x, y - area.y));
  }
  cv::Mat mask = cv::Mat::zeros(area.size(), CV_8U);
  cv::polylines(mask, fixed, closed, 255, thickness, upright && thickness == 1 ? cv::LINE_8 : cv::LINE_AA, kShift);
  Blend(mask, area.tl(), stroke.color, stroke.alpha);
}

void Canvas::Line(Point a, Point b, const Stroke& stroke) { Polyline({a, b}, stroke); }

void Canvas::Polyline(const std::vector<Point>& points, const Stroke& stroke) {
  std::vector<Point> run;
  const auto flush = [&] {
    Run(run, stroke, false);
    run.clear();
  };
  const bool dashed = stroke.dash > 0;
  double left = stroke.dash;  // of the dash or gap that is being drawn
  bool on = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!IsFinite(points[i])) {
      flush();
      continue;
    }
    if (dashed && i > 0 && IsFinite(points[i - 1])) {
      Point from = points[i - 1];
      double length = std::hypot(points[i].x - from.x, points[i].y - from.y);
      while (length > left && left > 0) {
        const double f = left / length;
        from = {from.x + f * (points[i].x - from.x), from.y + f * (points[i].y - from.y)};
        length -= left;
        if (on) {
          run.push_back(from);
          flush();
        } else {
          run.assign(1, from);
        }
        on = !on;
        left = on ? stroke.dash : stroke.gap;
      }
      left -= length;
    }
    if (!dashed || on) run.push_back(points[i]);
  }
  flush();
}

void Canvas::Polygon(const std::vector<Point>& points, Rgb color, double alpha) {
  if (points.size() < 3) return;
  double x0 = points[0].x, x1 = x0, y0 = points[0].y, y1 = y0;
  for (const Point& p : points) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  const cv::Rect area = PixelBox(x0 * scale_ - 1, y0 * scale_ - 1, x1 * scale_ + 1, y1 * scale_ + 1);
  if (area.empty()) return;
  std::vector<std::vector<cv::Point>> fixed(1);
  for (const Point& p : points) fixed[0].push_back(Fixed(p.x * scale_ - area.x, p.y * scale_ - area.y));
  cv::Mat mask = cv::Mat::zeros(area.size(), CV_8U);
  cv::fillPoly(mask, fixed, 255, cv::LINE_AA, kShift);
  Blend(mask, area.tl(), color, alpha);
}

void Canvas::Disc(Point center, double radius, Rgb color, double alpha) {
  Band(center, -1, radius * scale_, color, alpha);
}

void Canvas::Ring(Point center, double radius, const Stroke& stroke) {
  const double half = std::max(0.5, stroke.width * scale_ / 2);
  Band(center, radius * scale_ - half, radius * scale_ + half, stroke.color, stroke.alpha);
}

void Canvas::Band(Point center, double inner, double outer, Rgb color, double alpha) {
  const double cx = center.x * scale_, cy = center.y * scale_;
  const cv::Rect area = PixelBox(cx - outer - 1, cy - outer - 1, cx + outer + 1, cy + outer + 1);
  if (area.empty()) return;
  const Paint paint(color, alpha);
  const CircularBand band(inner, outer);
  for (int y = area.y; y < area.y + area.height; ++y) {
    std::uint8_t* row = pixels_.ptr<std::uint8_t>(y);
    band.ForEach(cx, y + 0.5 - cy, area.x, area.x + area.width,
                 [&](int x, std::uint8_t coverage) { paint.Over(row + std::ptrdiff_t{3} * x, coverage); });
  }
}

void Canvas::Image(const cv::Mat& image, const Box& box, bool smooth) {
  const cv::Point low(static_cast<int>(std::lround(box.x * scale_)), static_cast<int>(std::lround(box.y * scale_)));
  const cv::Point high(static_cast<int>(std::lround(box.right() * scale_)),
                       static_cast<int>(std::lround(box.bottom() * scale_)));
  const cv::Rect area(low, high), visible = area & clip_;
  if (visible.empty() || image.empty()) return;
  cv::Mat stretched;
  const bool shrink = area.width < image.cols;
  cv::resize(image, stretched, area.size(), 0, 0,
             !smooth  ? cv::INTER_NEAREST
             : shrink ? cv::INTER_AREA
                      : cv::INTER_CUBIC);
  const int channels = stretched.channels();
  for (int y = visible.y; y < visible.y + visible.height; ++y) {
    const std::uint8_t* from = stretched.ptr<std::uint8_t>(y - area.y);
    std::uint8_t* to = pixels_.ptr<std::uint8_t>(y);
    for (int x = visible.x; x < visible.x + visible.width; ++x) {
      const std::uint8_t* p = from + channels * (x - area.x);
      const int alpha = channels == 4 ? p[3] : 255;
      if (alpha == 255) std::copy_n(p, 3, to + std::ptrdiff_t{3} * x);
      if (alpha == 255 || alpha == 0) continue;
      for (int c = 0; c < 3; ++c)
        to[3 * x + c] = static_cast<std::uint8_t>((p[c] * alpha + to[3 * x + c] * (255 - alpha) + 127) / 255);
    }
  }
}

}  // namespace lobefit

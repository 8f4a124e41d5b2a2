// A picture that is drawn in page units: lines, areas, markers, images and text, anti-aliased, with transparency. One
// page unit is `scale` pixels; y runs down. Lines and polygons are OpenCV's, text is FreeType's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace lobefit {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
};
bool operator==(const Rgb& a, const Rgb& b);

struct Point {
  double x = 0, y = 0;
};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
  Point center() const { return {x + width / 2, y + height / 2}; }
};

// Index of a pixel or cell in a row-major picture.
inline std::size_t PixelIndex(int column, int row, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

// The box without `left`, ... of its border.
Box Inset(const Box& box, double left, double top, double right, double bottom);

struct Stroke {
  Rgb color;
  double width = 1;
  double alpha = 1;
  // Length of dashes and of the gaps between them; 0: solid.
  double dash = 0, gap = 0;
};

enum class Align { kLeft, kCenter, kRight };
enum class Baseline { kBottom, kMiddle, kTop };  // kBottom: the letters stand on the point
enum class Weight { kRegular, kBold, kOblique, kMono };

struct TextStyle {
  double size = 12;
  Rgb color = {};
  Weight weight = Weight::kRegular;
  Align align = Align::kLeft;
  Baseline baseline = Baseline::kBottom;
  // True: "_" and "^" lower or raise the next character or {group}.
  bool markup = false;
  // True: turned a quarter counter-clockwise, reading upwards.
  bool upwards = false;
};

// Glyph outlines from DejaVu Sans where it is installed, else OpenCV's stroke font with Greek letters spelled out. Each
// glyph is rendered once; several threads may ask.
class Fonts {
 public:
  // `folders` are searched for DejaVuSans.ttf and DejaVuSans-Bold.ttf; empty: the usual places.
  explicit Fonts(const std::vector<std::string>& folders = {});
  ~Fonts();
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;

  bool has_outlines() const;
  // Coverage (0-255) of one glyph at `pixels` to the em, where it stands against the pen (right and up positive) and
  // how far the pen moves on.
  struct Glyph {
    cv::Mat coverage;
    int left = 0, top = 0;
    double advance = 0;
  };
  const Glyph& Find(char32_t character, double pixels, Weight weight);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class Canvas {
 public:
  Canvas(double width, double height, double scale, std::shared_ptr<Fonts> fonts);

  double width() const { return width_; }
  double height() const { return height_; }
  double scale() const { return scale_; }
  // CV_8UC3, channels in the order red, green, blue.
  const cv::Mat& pixels() const { return pixels_; }

  void Fill(const Box& box, Rgb color, double alpha = 1);
  void Frame(const Box& box, const Stroke& stroke);
  void Line(Point a, Point b, const Stroke& stroke);
  // A point that is not finite breaks the line.
  void Polyline(const std::vector<Point>& points, const Stroke& stroke);
  void Polygon(const std::vector<Point>& points, Rgb color, double alpha = 1);
  void Disc(Point center, double radius, Rgb color, double alpha = 1);
  void Ring(Point center, double radius, const Stroke& stroke);
  // `image` is CV_8UC3 (RGB) or CV_8UC4 (RGBA), stretched over the box; smooth: averaged, else every pixel a rectangle.
  void Image(const cv::Mat& image, const Box& box, bool smooth);

  void Text(Point at, std::string_view utf8, const TextStyle& style);
  double TextWidth(std::string_view utf8, const TextStyle& style) const;
  // The text cut with "…" at the end (or in the middle) so that it is no wider than `width`.
  std::string Shorten(std::string_view utf8, const TextStyle& style, double width, bool middle = false) const;
  // Lines no wider than `width`, broken at blanks.
  std::vector<std::string> Wrap(std::string_view utf8, const TextStyle& style, double width) const;

  // A canvas that draws on the pixels of this one, within the box only: parts that have no pixel in common may be drawn
  // at the same time.
  Canvas Part(const Box& box) const;

  // Drawing is limited to the box until the object goes.
  class Clip {
   public:
    Clip(Canvas* canvas, const Box& box);
    ~Clip();
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    Canvas* canvas_;
    cv::Rect before_;
  };

 private:
  cv::Rect ClipOf(const Box& box) const;
  cv::Rect PixelBox(double x0, double y0, double x1, double y1) const;
  void Blend(const cv::Mat& coverage, cv::Point at, Rgb color, double alpha);
  // Between two radii, in pixels.
  void Band(Point center, double inner, double outer, Rgb color, double alpha);
  void Run(const std::vector<Point>& points, const Stroke& stroke, bool closed);

  double width_, height_, scale_;
  std::shared_ptr<Fonts> fonts_;
  cv::Mat pixels_;
  cv::Rect clip_;
};

}  // namespace lobefit

// A sphere of each compared model under one light.
#include <algorithm>
#include <cmath>

#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

struct Ball {
  LitSphere lit;
  std::string label;
  Rgb color;
};

constexpr int kBallPixels = 200;

double BallSide(double width, std::size_t count) {
  return std::min(200.0, (width - 14 * static_cast<double>(count - 1)) / static_cast<double>(count));
}

void DrawBalls(const std::vector<Ball>& balls, Canvas* canvas, const Box& content) {
  const double exposure = SphereExposure(balls.front().lit), side = BallSide(content.width, balls.size());
  double x = content.x;
  for (const Ball& ball : balls) {
    cv::Mat picture(ball.lit.size, ball.lit.size, CV_8UC4);
    for (int row = 0; row < ball.lit.size; ++row) {
      for (int column = 0; column < ball.lit.size; ++column) {
        const std::size_t i = PixelIndex(column, row, ball.lit.size);
        const Rgb c = ball.lit.known[i] != 0 ? ToScreen(ball.lit.color[i], exposure) : style::kRule;
        picture.at<cv::Vec4b>(row, column) = {c.r, c.g, c.b, 255};
      }
    }
    const TextStyle name = style::Body(style::kInk, Align::kCenter);
    canvas->Text({x + side / 2, content.y + 12}, canvas->Shorten(ball.label, name, side), name);
    canvas->Fill({x, content.y + 17, side, 3}, ball.color);
    canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(side * canvas->scale()))),
                  {x, content.y + 26, side, side}, false);
    x += side + 14;
  }
}

}  // namespace

std::optional<Panel> ComparedSpheresPanel(const Compared& compared) {
  const ReportData& first = compared.first();
  const ChannelColor to_color(first.measurement.channels);
  const auto balls = std::make_shared<std::vector<Ball>>();
  if (std::optional<LitSphere> measured = LightMeasured(first.measurement, to_color, kBallPixels))
    balls->push_back({std::move(*measured), "measured", style::kFaint});
  for (const Compared::Entry& entry : compared.models)
    balls->push_back({LightSphere(Shown(entry.data->fitted), to_color, entry.data->channels(), LitRows(kBallPixels)),
                      entry.label, entry.color});
  Panel panel;
  panel.id = "spheres";
  panel.title = "Spheres under one light";
  panel.height = [balls](Canvas*, double width) { return 34 + BallSide(width, balls->size()); };
  panel.draw = [balls](Canvas* canvas, const Box& content) { DrawBalls(*balls, canvas, content); };
  return panel;
}

}  // namespace lobefit

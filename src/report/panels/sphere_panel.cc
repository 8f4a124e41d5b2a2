// A sphere of the material under one light and under a sky, measured beside fitted: isotropic measurements that are
// dense enough.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/panels/panel.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

constexpr int kLightSize = 220;
// A third from the lobe, a third by the cosine, a third from the glow of the sun; a table is slower to ask than the
// model. With fewer, or without those from the glow, the sky on a rough surface is blotched.
constexpr int kSkySamples = 75, kSkySamplesOfAModel = 240;

bool HasHoles(const LitSphere& sphere) { return std::count(sphere.known.begin(), sphere.known.end(), 0) > 0; }

struct Spheres {
  std::array<LitSphere, 4> sphere;  // measured and fitted under the light, under the sky
  std::array<cv::Mat, 4> picture;
  bool measured = false;  // else only the fitted ones
  bool sky = false;       // measured under the sky too
};

cv::Mat Rendered(const LitSphere& sphere, double exposure) {
  cv::Mat picture(sphere.size, sphere.size, CV_8UC4);
  for (int row = 0; row < sphere.size; ++row) {
    for (int column = 0; column < sphere.size; ++column) {
      const std::size_t i = PixelIndex(column, row, sphere.size);
      const Rgb c = sphere.known[i] != 0 ? ToScreen(sphere.color[i], exposure) : style::kRule;
      picture.at<cv::Vec4b>(row, column) = {c.r, c.g, c.b, 255};
    }
  }
  return picture;
}

constexpr double kGap = 14, kGroupGap = 34;

// Four spheres side by side, or the two fitted ones in a narrow panel.
double Side(const Spheres& spheres, double width) {
  return std::min(260.0, spheres.measured ? (width - 2 * kGap - kGroupGap) / 4 : (width - kGap) / 2);
}

void Draw(const Spheres& spheres, Canvas* canvas, const Box& content) {
  const double size = Side(spheres, content.width), used = spheres.sky        ? 4 * size + 2 * kGap + kGroupGap
                                                           : spheres.measured ? 3 * size + kGap + kGroupGap
                                                                              : 2 * size + kGap;
  double x = content.x + std::max(0.0, (content.width - used) / 2);
  const std::array<const char*, 2> lights = {"one light, upper left", "sky with a low sun"};
  for (std::size_t k = 0; k < 4; ++k) {
    const bool is_fitted = k % 2 == 1;
    if (!is_fitted && !(k == 0 ? spheres.measured : spheres.sky)) continue;
    const Box box = {x, content.y + 42, size, size};
    canvas->Image(RoundPicture(spheres.picture[k], static_cast<int>(std::lround(size * canvas->scale()))), box, false);
    canvas->Text({box.center().x, content.y + 34}, is_fitted ? "fitted" : "measured",
                 style::Body(style::kInk, Align::kCenter));
    const bool pair = k < 2 ? spheres.measured : spheres.sky;
    if (!is_fitted || !pair) {
      const double middle = pair ? x + size + kGap / 2 : box.center().x;
      canvas->Text({middle, content.y + 14}, lights[k / 2], style::Note(style::kSecondary, Align::kCenter));
    }
    x += size + (k == 1 && spheres.measured ? kGroupGap : kGap);
  }
}

}  // namespace

std::optional<Panel> SpherePanel(const ReportData& data) {
  if (data.material.model.lobes.empty()) return std::nullopt;
  const ChannelColor to_color(data.measurement.channels);
  const ColoredFit colored = InColors(data.material, to_color);
  const ShownBrdf fitted = Shown(colored.function);
  const std::vector<LitRow> rows = LitRows(kLightSize);
  SlopeCoordinates lobe = data.fitted.lobe_shapes()[0];
  // Where a lobe falls by less than the square of the distance most of its light lies far out.
  constexpr double kFarOut = 0.05;
  if (FamilyOf(data.material.model.lobes[0].ndf) == Family::kAbg && data.fitted.shapes()[0].exponent < 2)
    lobe.v[2] = lobe.v[4] = std::max(lobe.v[2], std::log(kFarOut));
  const auto spheres = std::make_shared<Spheres>();
  if (data.measurement.isotropic) {
    const ShownBrdf measured = Shown(data.lookup(), data.channels());
    spheres->sphere[0] = LightSphere(measured, to_color, data.channels(), rows);
    spheres->measured = IsCovered(spheres->sphere[0]);
    if (spheres->measured)
      spheres->sphere[2] = SkySphere(measured, lobe, to_color, data.channels(), kSkySamples, data.threads);
    // A narrow lobe in a sparse table leaves holes and rings under the sky: that is no measured appearance.
    spheres->sky = spheres->measured && IsCovered(spheres->sphere[2]);
  }
  spheres->sphere[1] = LightSphere(fitted, colored.to_color, colored.function.channels(), rows);
  spheres->sphere[3] = SkySphere(fitted, lobe, colored.to_color, colored.function.channels(),
                                 spheres->sky ? kSkySamples : kSkySamplesOfAModel, data.threads);
  // One exposure for a pair: the measured sphere sets it.
  const std::array<double, 2> exposure = {SphereExposure(spheres->sphere[spheres->measured ? 0 : 1]),
                                          SphereExposure(spheres->sphere[spheres->sky ? 2 : 3])};
  for (std::size_t k = 0; k < 4; ++k) {
    if (k % 2 == 1 || (k == 0 ? spheres->measured : spheres->sky))
      spheres->picture[k] = Rendered(spheres->sphere[k], exposure[k / 2]);
  }
  Panel panel;
  panel.id = "sphere";
  panel.title = "As it looks";
  panel.wide = spheres->measured;
  if (spheres->measured && (HasHoles(spheres->sphere[0]) || (spheres->sky && HasHoles(spheres->sphere[2]))))
    panel.legend = {{LegendEntry::Mark::kNone, {}, "grey: no sample near"}};
  panel.height = [spheres](Canvas*, double width) { return 42 + Side(*spheres, width) + 8; };
  panel.draw = [spheres](Canvas* canvas, const Box& content) { Draw(*spheres, canvas, content); };
  return panel;
}

}  // namespace lobefit

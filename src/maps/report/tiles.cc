#include "lobefit/maps/report/tiles.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/maps/report/pictures.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

// Ticks of a scale of colours.
std::vector<Tick> TicksOf(const Range& range) {
  return range.logarithmic ? LogTicks(range.low, range.high, 5) : LinearTicks(range.low, range.high, 4);
}

Tile Scalar(const Maps& maps, MapPart part, const char* plane, const std::string& title, const std::string& label,
            bool logarithmic) {
  double low = Percentile(maps, part, plane, 0.02), high = Percentile(maps, part, plane, 0.98);
  if (std::isnan(low)) return {title + ": nowhere determined", {}, std::nullopt, ""};
  if (logarithmic) low = std::max(low, 1e-7), high = std::max(high, 1.2 * low);
  if (!logarithmic) low = 0, high = high > 0 ? high : 1;
  const Range range = {low, high, logarithmic};
  return {title, ScalarPicture(maps, part, plane, low, high, logarithmic), range, label};
}

std::string Amount(const Stack& stack, double white) {
  return stack.calibrated ? fmt::format("white at {:.3g}", white)
                          : fmt::format("white at {:.3g} of the stack's own unit", white);
}

std::vector<Tile> MapTiles(const Maps& maps, const Stack& stack) {
  std::vector<Tile> tiles, errors;
  const bool gray = maps.channels == 1;
  const auto white = [&](const char* head) {
    const double w = Percentile(maps, MapPart::kParameters, head, 0.99);
    return w > 0 ? w : 1.0;
  };
  tiles.push_back({"Normal", NormalPicture(maps), std::nullopt, "x right: red, y up: green, z to the camera: blue"});
  errors.push_back(
      Scalar(maps, MapPart::kErrors, "normal.angle_deg", "Error of the normal", "degrees, standard", true));
  const double diffuse = white("diffuse.");
  tiles.push_back({"Diffuse", ColorPicture(maps, "diffuse.", diffuse), std::nullopt, Amount(stack, diffuse)});
  errors.push_back(Scalar(maps, MapPart::kErrors, gray ? "diffuse.Y" : "diffuse.G", "Error of diffuse",
                          gray ? "standard" : "green, standard", true));
  if (maps.lobe != MapLobe::kNone) {
    const double f0 = white("f0.");
    tiles.push_back(
        {"F0", ColorPicture(maps, "f0.", f0), std::nullopt, Amount(stack, f0) + "; white paper: not determined"});
    errors.push_back(Scalar(maps, MapPart::kErrors, gray ? "f0.Y" : "f0.G", "Error of F0",
                            gray ? "standard" : "green, standard", true));
    const bool one = maps.lobe == MapLobe::kGgx;
    tiles.push_back(Scalar(maps, MapPart::kParameters, WidestAlpha(maps.lobe), one ? "Alpha" : "Alpha, wide",
                           "width; white: not determined", false));
    errors.push_back(
        Scalar(maps, MapPart::kErrors, one ? "ln_alpha" : "ln_alpha_x", "Error of ln alpha", "standard", true));
  }
  while (tiles.size() % kTileColumns != 0) tiles.push_back({}), errors.push_back({});
  tiles.insert(tiles.end(), errors.begin(), errors.end());
  return tiles;
}

void AddPair(const Maps& maps, const Stack& stack, const MapsPage& page, const RelitLight& light,
             std::vector<Tile>* tiles) {
  const RelitPair pair = Relit(maps, stack, light.light, page.fallback);
  std::vector<float> finite;
  for (const float v : pair.photograph) {
    if (std::isfinite(v)) finite.push_back(v);
  }
  if (finite.empty()) return;
  const auto at = finite.begin() + static_cast<std::ptrdiff_t>((finite.size() - 1) * 995 / 1000);
  std::nth_element(finite.begin(), at, finite.end());
  const double white = std::max(static_cast<double>(*at), 1e-12);
  const char* kind = light.fitted ? "the worst light of the fit" : "a light that was not fitted";
  // Both in one row.
  if (tiles->size() % kTileColumns == kTileColumns - 1) tiles->push_back({});
  tiles->push_back(
      {fmt::format("Photograph {}", light.light + 1), PhotoPicture(pair.photograph, maps, white), std::nullopt, kind});
  tiles->push_back({fmt::format("Fit, {:.1f} dB", light.psnr), PhotoPicture(pair.fit, maps, white), std::nullopt,
                    "under the same light, same exposure"});
}

}  // namespace

const RelitLight* WorstLight(const std::vector<RelitLight>& lights, bool fitted) {
  const RelitLight* worst = nullptr;
  for (const RelitLight& light : lights) {
    if (light.fitted == fitted && !std::isnan(light.psnr) && (worst == nullptr || light.psnr < worst->psnr)) {
      worst = &light;
    }
  }
  return worst;
}

std::vector<Tile> ReportTiles(const Maps& maps, const Stack& stack, const MapsPage& page) {
  std::vector<Tile> tiles = MapTiles(maps, stack);
  tiles.push_back({"Status", StatusPicture(maps), std::nullopt,
                   "green: all determined; blue: no lobe by evidence; purple: something not determined; orange: at a "
                   "bound; red: not converged; black: too few values"});
  if (PlaneIndex(maps.planes, MapPart::kQuality, "normal.doubt_deg") < maps.planes.size()) {
    tiles.push_back(Scalar(maps, MapPart::kQuality, "normal.doubt_deg", "Doubt of the normal",
                           "degrees, if the misfit is no noise", true));
  }
  tiles.push_back(Scalar(maps, MapPart::kQuality, "rms", "Residual", "of the texel's 90th percentile", true));
  if (PlaneIndex(maps.planes, MapPart::kQuality, "cluster") < maps.planes.size()) {
    tiles.push_back(Scalar(maps, MapPart::kQuality, "cluster", "Cluster", "texels that share numbers", false));
  }
  for (const bool fitted : {false, true}) {
    const RelitLight* worst = WorstLight(page.lights, fitted);
    if (worst != nullptr) AddPair(maps, stack, page, *worst, &tiles);
  }
  return tiles;
}

void DrawTile(const Tile& tile, const Box& box, Canvas* canvas) {
  TextStyle title = style::Body();
  title.size = style::kPanelTitleSize, title.weight = Weight::kBold;
  canvas->Text({box.x, box.y + 16}, tile.title, title);
  if (tile.picture.empty()) return;
  const Box room = {box.x, box.y + kTileTitleRoom, box.width, box.height - kTileTitleRoom - kTileScaleRoom};
  const double aspect = static_cast<double>(tile.picture.cols) / tile.picture.rows;
  const double width = std::min(room.width, room.height * aspect), height = width / aspect;
  const Box at = {room.x, room.y, width, height};
  canvas->Image(tile.picture, at, tile.picture.cols > width);
  canvas->Frame(at, {style::kRule, 1});
  if (tile.range) {
    DrawColorScale(canvas, {at.x, at.bottom() + 22, width, 10}, SequentialColor, *tile.range, TicksOf(*tile.range),
                   tile.label);
  } else {
    double y = at.bottom() + 18;
    for (const std::string& line : canvas->Wrap(tile.label, style::Note(), box.width)) {
      canvas->Text({at.x, y}, line, style::Note());
      y += 15;
    }
  }
}

}  // namespace lobefit

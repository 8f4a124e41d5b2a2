#include "lobefit/maps/report/web/html.h"

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "lobefit/base/text/base64.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/report/tiles.h"
#include "lobefit/maps/report/web/assets.h"
#include "lobefit/maps/report/web/data.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/web/assets.h"
#include "lobefit/report/web/template.h"

namespace lobefit {
namespace {

std::string TilesHtml(const std::vector<Tile>& tiles) {
  // Numbers at the ends of a scale stand out of its box.
  constexpr double kTileWidth = 304, kSide = 14, kScale = 2;
  const auto fonts = std::make_shared<Fonts>();
  std::string html;
  for (const Tile& tile : tiles) {
    if (tile.title.empty()) continue;
    const double aspect = tile.picture.empty() ? 0 : static_cast<double>(tile.picture.rows) / tile.picture.cols;
    const double width = kTileWidth - 2 * kSide;
    const Box box = {kSide, 0, width, std::min(aspect, 1.4) * width + kTileTitleRoom + kTileScaleRoom};
    Canvas canvas(kTileWidth, box.height, kScale, fonts);
    DrawTile(tile, box, &canvas);
    html += fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"></figure>\n",
                        MarkupText(tile.label.empty() ? tile.title : tile.title + ": " + tile.label),
                        Base64(EncodePng(canvas.pixels(), 0)));
  }
  return html;
}

std::string ShareRows(const Maps& maps) {
  std::size_t inside = 0, normal = 0, lobe = 0, width = 0, none = 0, bound = 0, open = 0, few = 0;
  const std::size_t alpha = PlaneIndex(maps.planes, MapPart::kParameters, WidestAlpha(maps.lobe));
  for (std::size_t t = 0; t < maps.rows.rows * maps.rows.width; ++t) {
    const auto bits = static_cast<unsigned>(maps.rows.values.back()[t]);
    if ((bits & kMapOutside) != 0) continue;
    ++inside;
    normal += std::isfinite(maps.rows.values[0][t]) ? 1 : 0;
    if (maps.lobe != MapLobe::kNone) {
      lobe += (bits & (kMapNoLobe | kMapTooFew)) == 0 ? 1 : 0;
      width += std::isfinite(maps.rows.values[alpha][t]) ? 1 : 0;
    }
    none += (bits & kMapNoLobe) != 0 ? 1 : 0, bound += (bits & kMapAtBound) != 0 ? 1 : 0;
    open += (bits & kMapNotConverged) != 0 ? 1 : 0, few += (bits & kMapTooFew) != 0 ? 1 : 0;
  }
  std::string rows;
  const auto add = [&](const char* name, std::size_t count) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.1f} %</td></tr>\n", name, count,
                        inside == 0 ? 0 : 100 * static_cast<double>(count) / static_cast<double>(inside));
  };
  add("fitted", inside), add("normal determined", normal);
  if (maps.lobe != MapLobe::kNone) {
    add("with a lobe", lobe), add("width determined", width), add("no lobe, by evidence", none);
  }
  add("at a bound", bound), add("not converged", open), add("too few values", few);
  return rows;
}

std::string PsnrRows(const std::vector<RelitLight>& lights, bool fitted) {
  double sum = 0;
  std::size_t count = 0;
  for (const RelitLight& light : lights) {
    if (light.fitted == fitted && std::isfinite(light.psnr)) sum += light.psnr, ++count;
  }
  const RelitLight* worst = WorstLight(lights, fitted);
  if (count == 0 || worst == nullptr) return "";
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.1f}</td><td>{:.1f} (light {})</td></tr>\n",
                     fitted ? "fitted" : "left out", count, sum / static_cast<double>(count), worst->psnr,
                     worst->light + 1);
}

std::string EveryLight(const std::vector<RelitLight>& lights) {
  std::string rows;
  for (const RelitLight& light : lights) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.1f}</td></tr>\n", light.light + 1,
                        light.fitted ? "yes" : "left out", light.psnr);
  }
  return rows;
}

std::string LightNote(const Stack& stack) {
  if (!stack.near) return "";
  return fmt::format(
      "It stays {:.4g} mm from the picture's middle, as the lights are on average; light falls off as it did.",
      stack.near->reference_mm);
}

}  // namespace

std::string MapsHtml(const Maps& maps, const Stack& stack, const MapsPage& page) {
  const std::size_t step = LiveStep(maps);
  const std::string style = std::string(kPageCss) + std::string(kMapsCss);
  const bool judged = WorstLight(page.lights, false) != nullptr;
  return FillTemplate(
      kMapsHtml,
      {{"title", MarkupText(page.title)},
       {"subtitle", MarkupText(page.subtitle)},
       {"chip", judged ? "judged by lights left out" : "no light left out"},
       {"chip-class", judged ? "" : "rough"},
       {"style", style},
       {"style-hash", PolicyHash(style)},
       {"script", std::string(kMapsJs)},
       {"script-hash", PolicyHash(kMapsJs)},
       {"shader", "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n" +
                      std::string(kMapsGlsl)},
       {"data", LiveData(maps, stack, page, step)},
       {"light-note", LightNote(stack)},
       {"live-note", step == 1 ? "" : fmt::format("Shown is one texel of {} x {}.", step, step)},
       {"shares", ShareRows(maps)},
       {"psnr", PsnrRows(page.lights, false) + PsnrRows(page.lights, true)},
       {"every-light", EveryLight(page.lights)},
       {"tiles", TilesHtml(ReportTiles(maps, stack, page))}},
      {});
}

}  // namespace lobefit

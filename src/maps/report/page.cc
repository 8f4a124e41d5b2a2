#include "lobefit/maps/report/page.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/maps/report/tiles.h"
#include "lobefit/plot/png.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

constexpr double kWidth = 1320, kMargin = 30, kGap = 24, kTop = 96;

}  // namespace

void WriteMapsReport(const Maps& maps, const Stack& stack, const MapsPage& page, double scale,
                     const std::filesystem::path& path) {
  const std::vector<Tile> tiles = ReportTiles(maps, stack, page);
  const double column = (kWidth - 2 * kMargin - (kTileColumns - 1) * kGap) / kTileColumns;
  const double aspect = static_cast<double>(maps.rows.rows) / static_cast<double>(maps.rows.width);
  const double row = std::min(column * aspect, 1.4 * column) + kTileTitleRoom + kTileScaleRoom;
  const double rows = std::ceil(static_cast<double>(tiles.size()) / kTileColumns);
  Canvas canvas(kWidth, kTop + rows * (row + kGap) + kMargin, scale, std::make_shared<Fonts>());
  TextStyle title = style::Body();
  title.size = style::kTitleSize, title.weight = Weight::kBold;
  canvas.Text({kMargin, 46}, canvas.Shorten(page.title, title, kWidth - 2 * kMargin), title);
  canvas.Text({kMargin, 70}, canvas.Shorten(page.subtitle, style::Body(style::kSecondary), kWidth - 2 * kMargin),
              style::Body(style::kSecondary));
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const double x = kMargin + static_cast<double>(k % kTileColumns) * (column + kGap);
    const double y = kTop + std::floor(static_cast<double>(k) / kTileColumns) * (row + kGap);
    DrawTile(tiles[k], {x, y, column, row}, &canvas);
  }
  WritePng(canvas.pixels(), 96 * scale, path);
}

}  // namespace lobefit

// The pictures of a report, each with its title and its scale or words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "lobefit/maps/report/page.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {

struct Tile {
  std::string title;
  cv::Mat picture;
  // Under the picture: a scale of colours, or words.
  std::optional<Range> range;
  std::string label;
};

// Maps, under them their errors, in rows of kTileColumns; status and residual; photographs beside the fit.
inline constexpr int kTileColumns = 4;
std::vector<Tile> ReportTiles(const Maps& maps, const Stack& stack, const MapsPage& page);

// Room of a tile beside its picture: title above, scale or words below.
inline constexpr double kTileTitleRoom = 26, kTileScaleRoom = 66;
void DrawTile(const Tile& tile, const Box& box, Canvas* canvas);

// The worst light, of those that were fitted or of the others; null where there is none.
const RelitLight* WorstLight(const std::vector<RelitLight>& lights, bool fitted);

}  // namespace lobefit

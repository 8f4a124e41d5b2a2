// NAME.maps.exr: tiled, one part a kind of map.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lobefit/maps/output/planes.h"

namespace lobefit {

// Rows [first, end) of all planes.
using MapSource = std::function<MapRows(std::size_t first, std::size_t end)>;

// Tiles of 64 x 64, ZIP. Asks `source` for one row of tiles at a time. The file takes its name when it is whole.
// Throws OutputError.
void WriteMapsExr(const std::vector<MapPlane>& planes, std::size_t width, std::size_t height, const MapSource& source,
                  const std::filesystem::path& path);

struct Maps {
  MapLobe lobe = MapLobe::kNone;
  int channels = 0;
  std::vector<MapPlane> planes;
  MapRows rows;  // the whole picture
};

// The planes of which `wanted` says so; the others stay empty. Throws InputError for a file that is not such a one.
Maps ReadMapsExr(
    const std::filesystem::path& path,
    const std::function<bool(const MapPlane&)>& wanted = [](const MapPlane&) { return true; });
// Whether the first bytes are OpenEXR's and a part is called "parameters".
bool IsMapsExr(const std::filesystem::path& path);

}  // namespace lobefit

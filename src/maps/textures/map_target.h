// The targets of maps: which pictures each needs, what its renderer makes of them, and its document.
#pragma once

#include <string_view>
#include <vector>

#include "lobefit/export/targets/target.h"
#include "lobefit/maps/textures/texture.h"

namespace lobefit {

struct MapTarget {
  const char* name = "";
  std::vector<Texture> (*textures)(const MapNumbers& maps) = nullptr;
  // What the renderer evaluates at a texel where these values are read, in the order of `textures`.
  Surface (*surface)(const MapNumbers& maps, const std::vector<TextureValue>& read) = nullptr;
  // Writes the document and returns its file; it names textures by WriteContext::map_path, name and ending.
  std::filesystem::path (*write)(const MapNumbers& maps, const WriteContext& context) = nullptr;
  std::vector<Carried> (*carries)(const MapNumbers& maps) = nullptr;
  const char* load = "";  // Target::load
};

const std::vector<MapTarget>& MapTargets();
// Null where maps cannot be exported to it.
const MapTarget* FindMapTarget(std::string_view name);

// The rows that all targets share: the fit's own terms, numbers in steps of 16 bits.
std::vector<Carried> CommonRows(const MapNumbers& maps);

MapTarget GltfMaps();
MapTarget OpenPbrMaps();
MapTarget MaterialXMaps();
MapTarget PbrtMaps();
MapTarget MitsubaMaps();

inline bool IsAnisotropic(const MapNumbers& maps) { return maps.lobe() == MapLobe::kGgxAnisotropic; }
inline bool HasLobes(const MapNumbers& maps) { return maps.lobe() != MapLobe::kNone; }

}  // namespace lobefit

#include "lobefit/maps/textures/map_target.h"

#include <algorithm>

namespace lobefit {

const std::vector<MapTarget>& MapTargets() {
  static const std::vector<MapTarget> targets = {PbrtMaps(), MitsubaMaps(), MaterialXMaps(), OpenPbrMaps(), GltfMaps()};
  return targets;
}

const MapTarget* FindMapTarget(std::string_view name) {
  const auto found = std::find_if(MapTargets().begin(), MapTargets().end(),
                                  [&](const MapTarget& target) { return target.name == name; });
  return found == MapTargets().end() ? nullptr : &*found;
}

std::vector<Carried> CommonRows(const MapNumbers& maps) {
  const char* const steps = "in steps of 16 bits";
  std::vector<Carried> rows = {{Feature::kNormal, Carries::kApproximately, steps},
                               {Feature::kDiffuse, Carries::kApproximately, steps}};
  if (!HasLobes(maps)) return rows;
  rows.push_back({Feature::kShape, Carries::kApproximately, steps});
  if (IsAnisotropic(maps)) rows.push_back({Feature::kRotation, Carries::kApproximately, steps});
  rows.push_back({Feature::kMasking, Carries::kExactly, ""});
  rows.push_back({Feature::kFresnel, Carries::kApproximately, steps});
  return rows;
}

}  // namespace lobefit

#include "lobefit/export/targets.h"

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/brdf_explorer/write.h"
#include "lobefit/export/targets/bsdf_xml/write.h"
#include "lobefit/export/targets/csv/write.h"
#include "lobefit/export/targets/glsl/write.h"
#include "lobefit/export/targets/gltf/write.h"
#include "lobefit/export/targets/json/write.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/merl/write.h"
#include "lobefit/export/targets/mitsuba/write.h"
#include "lobefit/export/targets/openpbr/write.h"
#include "lobefit/export/targets/osl/write.h"
#include "lobefit/export/targets/pbrt/write.h"
#include "lobefit/export/targets/rgl/write.h"

namespace lobefit {

const std::vector<Target>& ExportTargets() {
  static const std::vector<Target> targets = {
      RglTarget(),          MerlTarget(),    GltfTarget(),    JsonTarget(), MaterialXTarget(),
      MitsubaTarget(),      PbrtTarget(),    OpenPbrTarget(), GlslTarget(), OslTarget(),
      BrdfExplorerTarget(), BsdfXmlTarget(), CsvTarget(),
  };
  return targets;
}

const Target& FindTarget(std::string_view name) {
  std::vector<std::string> names;
  for (const Target& target : ExportTargets()) {
    if (name == target.name) return target;
    names.emplace_back(target.name);
  }
  throw UsageError(
      fmt::format("'{}' is not a target{}; the targets are: {}", Excerpt(name), DidYouMean(name, names), Join(names)));
}

}  // namespace lobefit

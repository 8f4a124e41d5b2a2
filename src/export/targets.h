// The table of targets: a new one is one folder below export/targets and one row in targets.cc.
#pragma once

#include <string_view>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

// In the order in which a file is recognised: formats with a magic number first, then text from strict to loose.
const std::vector<Target>& ExportTargets();

// Throws UsageError that lists the targets and suggests one.
const Target& FindTarget(std::string_view name);

}  // namespace lobefit

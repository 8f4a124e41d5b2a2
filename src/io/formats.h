// The table of formats that can be read: a new format is one folder and one row in formats.cc.
#pragma once

#include <vector>

#include "lobefit/io/text/format.h"

namespace lobefit {

// In the order of recognition: formats with a magic number first, then by size, then text formats from strict to loose.
const std::vector<Format>& Formats();

}  // namespace lobefit

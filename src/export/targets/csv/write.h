// Samples over a goniometer's directions.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target CsvTarget();

}  // namespace lobefit

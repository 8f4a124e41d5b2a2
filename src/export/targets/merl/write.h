// MERL tables.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target MerlTarget();

}  // namespace lobefit

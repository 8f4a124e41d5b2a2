// The material document itself.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target JsonTarget();

}  // namespace lobefit

// The OpenPBR surface of MaterialX 1.39; its files are read by the reader of MaterialX.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target OpenPbrTarget();

}  // namespace lobefit

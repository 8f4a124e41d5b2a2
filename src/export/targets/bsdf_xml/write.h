// BSDF-XML tensor trees.
#pragma once

#include "lobefit/export/targets/target.h"

namespace lobefit {

Target BsdfXmlTarget();

}  // namespace lobefit

#include "lobefit/base/version.h"

namespace lobefit {

const char* Version() { return LOBEFIT_VERSION; }

}  // namespace lobefit

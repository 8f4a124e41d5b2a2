// How many threads an option asks for.
#pragma once

#include "lobefit/base/parallel.h"

namespace lobefit {

// `asked`, or as many as the process may use where that is 0.
inline int ThreadsFor(int asked) { return asked > 0 ? asked : HardwareThreads(); }

}  // namespace lobefit

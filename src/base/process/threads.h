// How many threads an option asks for.
#pragma once

#include "lobefit/base/process/parallel.h"

namespace lobefit {

// The process uses at most so many from now on, also where nothing asks how many: what HardwareThreads gives. For a
// program, before its work; 0 takes the limit away.
void LimitThreads(int most);

// `asked`, or as many as the process may use where that is 0.
inline int ThreadsFor(int asked) { return asked > 0 ? asked : HardwareThreads(); }

}  // namespace lobefit

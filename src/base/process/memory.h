// Memory for large arrays.
#pragma once

#include <cstddef>

namespace lobefit {

// Asks for pages of 2 MB under [begin, begin + bytes), which must be allocated but not written yet: 35 MB then cost
// some twenty page faults instead of 9000, which took longer than reading the file. Advice only: nothing else changes.
// Of a vector: after reserve(), before its elements are made.
void AdviseLargePages(const void* begin, std::size_t bytes);

}  // namespace lobefit

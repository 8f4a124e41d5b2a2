#include "lobefit/base/process/memory.h"

#include <cstdint>

#include <sys/mman.h>

namespace lobefit {

void AdviseLargePages(const void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kLargePage = std::uintptr_t{1} << 21, kPage = 4096;
  if (bytes < 2 * kLargePage) return;
  // Whole pages only; the kernel takes those of 2 MB that fit.
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + kPage - 1) / kPage * kPage, last = (address + bytes) / kPage * kPage;
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace lobefit

// One run of a reader of image stacks' files on arbitrary bytes: it reads or throws InputError, and what it reads keeps
// the promises of a stack. Images are not opened.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {

inline int FuzzStack(StackFiles (*read)(const std::filesystem::path&), const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz", 0);
  // Pages of the run before stay.
  if (file < 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size) ||
      ftruncate(file, static_cast<off_t>(size)) != 0)
    std::abort();
  try {
    const Stack stack = read("/proc/self/fd/" + std::to_string(file)).stack;
    for (const StackLight& light : stack.lights) {
      if (!(std::fabs(Norm(light.direction) - 1) < 1e-9)) std::abort();
      if (stack.near && !(light.place.z > 0 && std::isfinite(Norm(light.place)))) std::abort();
    }
    if (stack.near && !(stack.width_mm > 0 && std::isfinite(stack.near->reference_mm))) std::abort();
    for (const Vec3& camera : stack.cameras) {
      if (!(stack.width_mm > 0 && camera.z > 0 && std::isfinite(Norm(camera)))) std::abort();
    }
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace lobefit

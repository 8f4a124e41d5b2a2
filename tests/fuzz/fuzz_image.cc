// One image of a stack from arbitrary bytes: it opens and gives its rows, or throws InputError; integers stay within
// their range. All parts of an OpenEXR file.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/stack/exr_parts.h"

namespace {

void ReadRows(lobefit::ImageRows* image) {
  // What a head claims costs time, not memory: large claims keep a run short.
  constexpr std::size_t kMostPixels = 20000;
  if (image->width() == 0 || image->height() == 0) std::abort();
  if (image->width() * image->height() > kMostPixels) return;
  std::vector<float> row(image->width() * image->channels());
  for (std::size_t y = 0; y < image->height(); ++y) {
    image->Next(row.data());
    for (const float value : row) {
      if (image->bits() <= 16 && !(value >= 0 && value <= 1)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz", 0);
  // Pages of the run before stay.
  if (file < 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size) ||
      ftruncate(file, static_cast<off_t>(size)) != 0)
    std::abort();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  try {
    if (lobefit::IsExrImage(path)) {
      const lobefit::ExrParts parts(path);
      for (const std::string& part : parts.names()) ReadRows(parts.Open(part).get());
    } else {
      ReadRows(lobefit::OpenImage(path).get());
    }
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

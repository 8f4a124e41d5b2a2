#include <cstring>
#include <fstream>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/stack/exr_parts.h"

namespace lobefit {

std::unique_ptr<ImageRows> OpenImage(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  char head[4] = {};
  if (!in) throw InputError(PrintableName(path) + ": cannot be opened; is it there, and may it be read?");
  in.read(head, 4);
  const auto begins = [&](const char* with, std::size_t bytes) { return std::memcmp(head, with, bytes) == 0; };
  if (begins("\x89PNG", 4)) return OpenPngRows(path);
  if (IsExrImage(path)) return OpenExrRows(path);
  if (begins("\xff\xd8\xff", 3)) return OpenJpegRows(path);
  // 42, or 43 in BigTIFF, in either order of bytes.
  for (const char* order : {"II*\0", "II+\0", "MM\0*", "MM\0+"}) {
    if (begins(order, 4)) return OpenTiffRows(path);
  }
  throw InputError(
      PrintableName(path) +
      ": neither PNG, JPEG, TIFF nor OpenEXR, which are what images of a stack may be; convert it (16 bits a "
      "channel keep what 8 lose)");
}

}  // namespace lobefit

#include "tests/fuzz/fuzz_reader.h"
#include <ImfHeader.h>

#include "lobefit/io/exr/reader.h"

// OpenEXR reserves memory for as many pixels as the head announces
// before it sees the first: smaller images than the reader allows keep a run short.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool limited = [] {
    try {
      lobefit::ReadExr({"none", ""}, {});  // sets the reader's own limits
    } catch (const lobefit::InputError&) {
    }
    Imf::Header::setMaxImageSize(32, 32);
    Imf::Header::setMaxTileSize(32, 32);
    return true;
  }();
  return limited ? lobefit::FuzzReader(lobefit::IsExr, lobefit::ReadExr, data, size) : 0;
}

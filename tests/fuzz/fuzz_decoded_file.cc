// Unpacking and decoding of a file's bytes; what comes out is handed to no reader here.
#include <cstdint>
#include <cstdlib>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/io/text/decoded_file.h"
#include "lobefit/io/wrong_kind.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz", 0);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  try {
    const lobefit::DecodedFile decoded("/proc/self/fd/" + std::to_string(file));
    lobefit::DescribeWrongKind(decoded.bytes());
  } catch (const lobefit::InputError&) {
  }
  return 0;
}

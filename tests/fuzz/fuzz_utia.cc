#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/utia/grid.h"
#include "lobefit/io/utia/reader.h"

// The table of the format, 2 MB without a header, is too large to be read millions of times: the same reader on a small
// grid.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr lobefit::UtiaGrid kSmall = {2, 3};
  const auto read = [](const lobefit::InputFile& file, const lobefit::ReadOptions& options) {
    return lobefit::ReadUtiaGrid(file, options, kSmall);
  };
  return lobefit::FuzzReader(lobefit::IsUtia, read, data, size);
}

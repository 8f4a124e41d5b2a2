#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/io/merl/reader.h"
#include "lobefit/io/merl/table.h"

namespace {

constexpr lobefit::MerlDims kSmall = {6, 2, 3};
constexpr std::size_t kBytes = lobefit::MerlBytes(kSmall);

}  // namespace

// The table of the format, 35 MB, is too large to be read millions of times: short inputs go to the reader, which
// checks head and size; the end of longer ones is the head and the cells of a small table.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = [](const lobefit::InputFile& file, const lobefit::ReadOptions& options) {
    const std::size_t bytes = file.bytes.size();
    if (bytes < kBytes) return lobefit::ReadMerl(file, options);
    return lobefit::ReadMerlTable(file.bytes.substr(bytes - kBytes), kSmall, bytes % 4 < 2, options.merl_cell);
  };
  return lobefit::FuzzReader(lobefit::IsMerl, read, data, size);
}

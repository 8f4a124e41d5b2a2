#include <string>

#include "tests/fuzz/fuzz_reader.h"

// The format is a table of one size without a header: the input is repeated to that size, sometimes one byte off.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kBytes = 3 * 288 * 288 * 8;
  if (size == 0) return 0;
  std::string bytes(kBytes + (data[0] == 1 ? 1 : 0), '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(data[i % size]);
  return lobefit::FuzzReader(lobefit::IsUtia, lobefit::ReadUtia, reinterpret_cast<const std::uint8_t*>(bytes.data()),
                             bytes.size());
}

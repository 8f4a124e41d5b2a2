#include "tests/fuzz/fuzz_import.h"

#include "lobefit/export/targets/mitsuba/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return lobefit::FuzzImport(lobefit::IsMitsuba, lobefit::ReadMitsuba, data, size);
}

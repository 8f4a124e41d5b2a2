#include "tests/support/paths.h"

namespace lobefit::test {

std::filesystem::path SourceDir() { return LOBEFIT_SOURCE_DIR; }
std::filesystem::path ProgramPath() { return LOBEFIT_PROGRAM; }

}  // namespace lobefit::test

// Where tests find the repository and the program. Compiled once, so that no other object holds a path of the machine.
#pragma once

#include <filesystem>

namespace lobefit::test {

std::filesystem::path SourceDir();
std::filesystem::path ProgramPath();

}  // namespace lobefit::test

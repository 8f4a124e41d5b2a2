// Runs the built program in a folder of its own, as a user would.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/folder_test.h"
#include "tests/support/paths.h"
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lobefit {

struct ProgramResult {
  int exit_code = -1;
  std::string out, err;
};

inline std::string ReadWholeFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void WriteWholeFile(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A test with an empty folder as its working directory.
class ProgramTest : public FolderTest {
 protected:
  // Runs a shell command in the folder; `lobefit` is the built program, $SOURCE the repository.
  ProgramResult Shell(const std::string& command) const {
    const std::string program = test::ProgramPath().parent_path().string();
    const std::string full = "cd '" + folder_.string() + "' && export PATH='" + program + "':$PATH SOURCE='" +
                             test::SourceDir().string() + "' && { " + command +
                             "\n} >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(full.c_str());
    ProgramResult result = {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadWholeFile(folder_ / "stdout.txt"),
                            ReadWholeFile(folder_ / "stderr.txt")};
    std::filesystem::remove(folder_ / "stdout.txt");
    std::filesystem::remove(folder_ / "stderr.txt");
    return result;
  }
};

}  // namespace lobefit

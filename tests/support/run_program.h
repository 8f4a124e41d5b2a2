// Runs the built program in a folder of its own, as a user would.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

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
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = std::string(testing::UnitTest::GetInstance()->current_test_info()->test_suite_name()) + "." +
                       testing::UnitTest::GetInstance()->current_test_info()->name() + "." + std::to_string(getpid());
    for (char& c : name) c = c == '/' ? '_' : c;
    folder_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

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

  // Names of the files in the folder, sorted.
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder_;
};

}  // namespace lobefit

#include "lobefit/base/file.h"

#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

TEST(MappedFile, ReadsBackWhatWasWritten) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "mapped.txt";
  WriteFileAtomically(path, std::string_view("abc\n"));
  EXPECT_EQ(MappedFile(path).bytes(), "abc\n");
  std::filesystem::remove(path);
}

TEST(MappedFile, NamesWhatItCannotRead) {
  EXPECT_THROW(MappedFile("/no/such/file"), InputError);
  EXPECT_THROW(MappedFile{testing::TempDir()}, InputError);
}

TEST(Sha256Hex, AgreesWithThePublishedVector) {
  EXPECT_EQ(Sha256Hex("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-4, example 1
}

TEST(MakeFolder, MakesThoseAboveAndSaysWhatStandsInTheWay) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "made";
  MakeFolder(folder / "a" / "b");
  MakeFolder(folder / "a" / "b");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a" / "b"));
  WriteFileAtomically(folder / "file", std::string_view("x"));
  try {
    MakeFolder(folder / "file" / "c");
    FAIL() << "made";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be made: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--out"), std::string::npos);
  }
  std::filesystem::remove_all(folder);
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenWritingFails) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "atomic";
  std::filesystem::create_directories(folder);
  WriteFileAtomically(folder / "f", std::string_view("old"));
  EXPECT_THROW(WriteFileAtomically(folder / "f", [](std::ostream&) { throw std::runtime_error("x"); }),
               std::runtime_error);
  EXPECT_EQ(MappedFile(folder / "f").bytes(), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()), 1);
  EXPECT_THROW(WriteFileAtomically("/no/such/folder/f", std::string_view("x")), OutputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lobefit

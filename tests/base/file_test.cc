#include "lobefit/base/files/file.h"

#include <filesystem>
#include <thread>

#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

std::string MessageOf(const std::filesystem::path& path) {
  try {
    FileBytes{path};
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

class FileBytesTest : public FolderTest {};

TEST_F(FileBytesTest, HoldsSmallAndLargeFiles) {
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 2097152U, 9000001U}) {
    std::string bytes(size, 'x');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7 % 251);
    Write("f", bytes);
    EXPECT_TRUE(FileBytes(folder_ / "f").bytes() == bytes) << size;
  }
}

TEST_F(FileBytesTest, IsNotTouchedByWhatBecomesOfTheFile) {
  Write("f", std::string(100000, 'a'));
  const FileBytes file(folder_ / "f");
  std::filesystem::resize_file(folder_ / "f", 10);
  EXPECT_EQ(file.bytes(), std::string(100000, 'a'));
}

TEST_F(FileBytesTest, ReadsAPipeToItsEnd) {
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string bytes(5000000, 'p');
  std::thread writer([&] { WriteFileAtomically(pipe, bytes); });
  EXPECT_TRUE(FileBytes(pipe).bytes() == bytes);
  writer.join();
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(FileBytesTest, SaysWhatItCannotRead) {
  EXPECT_THAT(MessageOf("/no/such/file"), HasSubstr("cannot be opened: No such file"));
  EXPECT_THAT(MessageOf(folder_), HasSubstr("is a folder; name a file"));
  EXPECT_THAT(MessageOf("/dev/zero"), HasSubstr("holds more than 512 MB, the limit of a pipe"));
  // A file system's word for the size is not believed twice: files of /proc state 0 and hold more.
  EXPECT_GT(FileBytes("/proc/self/status").bytes().size(), 100U);
  // Sparse, so that it costs no disk.
  Write("big", "");
  std::filesystem::resize_file(folder_ / "big", FileBytes::kMost + 1);
  EXPECT_THAT(MessageOf(folder_ / "big"), HasSubstr("holds more than 4096 MB, the limit of a file"));
}

TEST(Sha256Hex, AgreesWithThePublishedVector) {
  EXPECT_EQ(Sha256Hex("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-4, example 1
}

}  // namespace
}  // namespace lobefit

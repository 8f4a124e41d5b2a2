// What is written is whole or not there, goes where it should and nowhere else.
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "tests/support/folder_test.h"
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/files/file_group.h"
#include "lobefit/base/files/pending_file.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class OutputTest : public FolderTest {
 protected:
  struct stat Status(const std::string& name) const {
    struct stat status = {};
    EXPECT_EQ(stat((folder_ / name).c_str(), &status), 0);
    return status;
  }
  // What writing to `name` throws, "" for nothing.
  std::string Refusal(const std::string& name) const {
    try {
      WriteFileAtomically(folder_ / name, std::string_view("new"));
    } catch (const OutputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(OutputTest, MakesFoldersWithThoseAboveAndSaysWhatStandsInTheWay) {
  MakeFolder(folder_ / "a" / "b");
  MakeFolder(folder_ / "a" / "b");
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "a" / "b"));
  Write("file", "x");
  try {
    MakeFolder(folder_ / "file" / "c");
    FAIL() << "made";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be made: "));
    EXPECT_THAT(error.what(), HasSubstr("--out"));
  }
}

TEST_F(OutputTest, LeavesTheOldFileWhenWritingFails) {
  WriteFileAtomically(folder_ / "f", std::string_view("old"));
  EXPECT_THROW(WriteFileAtomically(folder_ / "f",
                                   [](std::ostream& out) {
                                     out << std::string(1000000, 'n');
                                     throw std::runtime_error("x");
                                   }),
               std::runtime_error);
  EXPECT_EQ(Read("f"), "old");
  EXPECT_THAT(Files(), ElementsAre("f"));
  EXPECT_THROW(WriteFileAtomically("/no/such/folder/f", std::string_view("x")), OutputError);
}

TEST_F(OutputTest, WritesWhatComesInPiecesOfAnySize) {
  std::string all;
  WriteFileAtomically(folder_ / "f", [&](std::ostream& out) {
    for (std::size_t size : {1U, 65535U, 1U, 65536U, 200000U, 3U}) {
      const std::string piece(size, static_cast<char>('a' + size % 26));
      out << piece;
      all += piece;
    }
    out.put('.');
  });
  EXPECT_TRUE(Read("f") == all + ".");
}

TEST_F(OutputTest, KeepsModeAndOwner) {
  Write("f", "old");
  ASSERT_EQ(chmod((folder_ / "f").c_str(), 0640), 0);
  const bool root = geteuid() == 0;
  if (root) {
    ASSERT_EQ(chown((folder_ / "f").c_str(), 65534, 65534), 0);
  }
  WriteFileAtomically(folder_ / "f", std::string_view("new"));
  EXPECT_EQ(Read("f"), "new");
  EXPECT_EQ(Status("f").st_mode & 07777, 0640U);
  EXPECT_EQ(Status("f").st_uid, root ? 65534U : geteuid());
  // A new file has the rights that the user's mask gives.
  const mode_t mask = umask(027);
  WriteFileAtomically(folder_ / "g", std::string_view("new"));
  umask(mask);
  EXPECT_EQ(Status("g").st_mode & 07777, 0640U);
}

TEST_F(OutputTest, ReplacesTheTargetOfALinkAndKeepsTheLink) {
  std::filesystem::create_directory(folder_ / "d");
  Write("d/target", "old");
  std::filesystem::create_symlink("d/target", folder_ / "link");
  std::filesystem::create_symlink("link", folder_ / "second");
  std::filesystem::create_symlink("d/nothing", folder_ / "dangling");
  std::filesystem::create_symlink("loop", folder_ / "loop");
  WriteFileAtomically(folder_ / "second", std::string_view("new"));
  WriteFileAtomically(folder_ / "dangling", std::string_view("made"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "second"));
  EXPECT_EQ(Read("d/target"), "new");
  EXPECT_EQ(Read("d/nothing"), "made");
  EXPECT_THAT(Refusal("loop"), HasSubstr("symbolic links"));
}

TEST_F(OutputTest, DoesNotFollowAnotherUsersLinkInASharedFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make a link of another user";
  Write("mine", "old");
  std::filesystem::create_directory(folder_ / "shared");
  ASSERT_EQ(chmod((folder_ / "shared").c_str(), 01777), 0);
  std::filesystem::create_symlink("../mine", folder_ / "shared" / "result");
  WriteFileAtomically(folder_ / "shared" / "result", std::string_view("own link"));
  ASSERT_EQ(lchown((folder_ / "shared" / "result").c_str(), 65534, 65534), 0);
  EXPECT_THAT(Refusal("shared/result"), HasSubstr("a link that another user made in a shared folder"));
  EXPECT_EQ(Read("mine"), "own link");
}

TEST_F(OutputTest, WritesThroughPipesAndDevices) {
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = std::string(FileBytes(pipe).bytes()); });
  EXPECT_TRUE(IsStream(pipe));
  WriteFileAtomically(pipe, std::string_view("through"));
  reader.join();
  EXPECT_EQ(got, "through");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(IsStream("/dev/null"));
  EXPECT_TRUE(IsStream("-"));
  EXPECT_FALSE(IsStream(folder_ / "nothing"));
  // A device of the folder: /dev itself must not be at risk.
  if (geteuid() == 0 && mknod((folder_ / "full").c_str(), S_IFCHR | 0600, makedev(1, 7)) == 0) {
    const std::string refusal = Refusal("full");
    EXPECT_TRUE(std::filesystem::is_character_file(folder_ / "full"));
    // Where the file system allows no devices, it cannot be opened.
    EXPECT_THAT(refusal, testing::AnyOf(HasSubstr("No space left on device; is the disk full?"), HasSubstr("denied")));
  }
  if (geteuid() == 0 && mknod((folder_ / "disk").c_str(), S_IFBLK | 0600, makedev(259, 77)) == 0) {
    EXPECT_THAT(Refusal("disk"), HasSubstr("block device"));
  }
}

TEST_F(OutputTest, TakesTheLongestNameAFolderAllows) {
  const std::string longest(255, 'n');
  WriteFileAtomically(folder_ / longest, std::string_view("x"));
  EXPECT_EQ(Read(longest), "x");
  EXPECT_THAT(Refusal(longest + "n"), HasSubstr("File name too long"));
}

TEST_F(OutputTest, IsTheOldFileOrTheNewOneForEveryReader) {
  const std::string a(300000, 'a'), b(500000, 'b');
  WriteFileAtomically(folder_ / "f", a);
  std::atomic<bool> done{false};
  std::thread writers[2];
  for (int w = 0; w < 2; ++w) {
    writers[w] = std::thread([&, w] {
      for (int i = 0; i < 30; ++i) WriteFileAtomically(folder_ / "f", w == 0 ? a : b);
    });
  }
  std::thread reader([&] {
    while (!done) {
      const std::string got = Read("f");
      EXPECT_TRUE(got == a || got == b) << got.size();
    }
  });
  for (std::thread& writer : writers) writer.join();
  done = true;
  reader.join();
  EXPECT_THAT(Files(), ElementsAre("f"));
}

TEST_F(OutputTest, HasNoNameOrOneNobodyGuessesUntilItIsWhole) {
  {
    PendingFile file(folder_);
    ASSERT_EQ(write(file.descriptor(), "half", 4), 4);
    for (const std::string& name : Files()) EXPECT_THAT(name, testing::MatchesRegex("\\.lobefit-[0-9a-f]+"));
  }
  EXPECT_TRUE(Files().empty());
}

TEST_F(OutputTest, AGroupHasNoNamesUntilAllIsOnTheDisk) {
  Write("old", "before");
  ASSERT_EQ(chmod((folder_ / "old").c_str(), 0640), 0);
  {
    FileGroup group, more;
    group.Add(folder_ / "new", "text");
    group.Add(folder_ / "old", "after");
    more.Add(folder_ / "last", "words");
    group.Take(std::move(more));
    for (const std::string& name : Files())
      EXPECT_TRUE(name == "old" || name.starts_with(".lobefit-")) << name << " is there already";
    EXPECT_EQ(Read("old"), "before");
    group.Commit();
    EXPECT_EQ(Read("new") + Read("old") + Read("last"), "textafterwords");
    EXPECT_EQ(Status("old").st_mode & 0777, 0640U);
    group.Add(folder_ / "never", "committed");
  }
  EXPECT_THAT(Files(), testing::UnorderedElementsAre("new", "old", "last"));
}

TEST_F(OutputTest, AGroupSaysWhatCannotBeWritten) {
  std::filesystem::create_directories(folder_ / "a");
  std::filesystem::create_directories(folder_ / "taken");
  FileGroup group;
  EXPECT_THROW(group.Add(folder_ / "none" / "f", "x"), OutputError);
  EXPECT_THROW(group.Add("/dev/null", "x"), OutputError);
  EXPECT_THROW(group.Add(folder_ / "taken", "x"), OutputError);
  group.Add(folder_ / "a" / "first", "x");
  group.Add(folder_ / "a" / "second", "x");
  // A folder takes the name meanwhile.
  std::filesystem::create_directories(folder_ / "a" / "second");
  try {
    group.Commit();
    FAIL() << "committed";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("second"));
  }
  EXPECT_EQ(Read("a/first"), "x");
}

// The signal comes while a file is half written.
TEST_F(OutputTest, LeavesNothingBehindWhenItIsTerminated) {
  for (const int signal : {SIGTERM, SIGINT, SIGKILL}) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      if (signal != SIGKILL) RemoveTemporariesOnSignal(signal);
      WriteFileAtomically(folder_ / "f", [&](std::ostream& out) {
        out << std::string(1000000, 'h') << std::flush;
        kill(getpid(), signal);
      });
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    EXPECT_TRUE(Files().empty()) << Files()[0];
  }
}

TEST_F(OutputTest, IsCheckedBeforeTheWork) {
  Write("in.csv", "x");
  std::filesystem::create_symlink("in.csv", folder_ / "link.csv");
  std::filesystem::create_hard_link(folder_ / "in.csv", folder_ / "hard.csv");
  const std::vector<std::filesystem::path> inputs = {folder_ / "other.csv", folder_ / "in.csv"};
  for (const char* name : {"in.csv", "link.csv", "hard.csv", "./in.csv"}) {
    try {
      CheckOutput(folder_ / name, inputs);
      ADD_FAILURE() << name;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("would be overwritten; choose another name"));
    }
  }
  CheckOutput(folder_ / "new.csv", inputs);
  CheckOutput(folder_ / "not" / "yet" / "new.csv", inputs);
  CheckOutput("-", inputs);
  CheckOutput("/dev/null", inputs);
  EXPECT_THROW(CheckOutput(folder_, inputs), OutputError);
  EXPECT_THROW(CheckOutput(folder_ / "in.csv" / "below", inputs), OutputError);
  EXPECT_THROW(CheckOutput(folder_ / std::string(256, 'n'), inputs), OutputError);
}

}  // namespace
}  // namespace lobefit

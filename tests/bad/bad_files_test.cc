// Every kind of malformed file has a file here and the exact message that it must give: messages.txt holds lines "FILE
// | MESSAGE", where the message follows the path and ": ". {formats} stands for the list of formats, {columns} for the
// columns that a CSV may have.
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "tests/support/paths.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/formats.h"
#include "lobefit/io/read.h"

namespace lobefit {
namespace {

const std::filesystem::path kFolder = test::SourceDir() / "tests" / "bad";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::map<std::string, std::string> ExpectedMessages() {
  std::vector<std::string> formats;
  for (const Format& format : Formats()) {
    formats.push_back(std::string(format.name) + " (" + format.description + ")");
  }
  const FileBytes file(kFolder / "messages.txt");
  LineReader lines(file.bytes());
  std::string_view line;
  std::map<std::string, std::string> messages;
  while (lines.Next(&line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t at = line.find(" | ");
    EXPECT_NE(at, std::string_view::npos) << "messages.txt line " << lines.line_number();
    if (at == std::string_view::npos) continue;
    const std::string message = Replaced(Replaced(std::string(line.substr(at + 3)), "{formats}", Join(formats, "; ")),
                                         "{columns}", AllowedColumns());
    EXPECT_TRUE(messages.emplace(std::string(line.substr(0, at)), message).second) << line;
  }
  return messages;
}

std::string MessageOf(const std::filesystem::path& path) {
  try {
    ReadMeasurement(path);
  } catch (const InputError& error) {
    EXPECT_EQ(error.exit_code(), kExitInput);
    const std::string prefix = path.string() + ": ", message = error.what();
    EXPECT_TRUE(message.starts_with(prefix)) << message;
    return message.substr(std::min(prefix.size(), message.size()));
  }
  return "(was read)";
}

TEST(BadFiles, EachGivesItsMessage) {
  for (const auto& [name, message] : ExpectedMessages())
    EXPECT_EQ(MessageOf(kFolder / "files" / name), message) << name;
}

TEST(BadFiles, EachHasAMessage) {
  std::set<std::string> named, present;
  for (const auto& [name, message] : ExpectedMessages()) named.insert(name);
  for (const auto& entry : std::filesystem::directory_iterator(kFolder / "files")) {
    present.insert(entry.path().filename().string());
  }
  EXPECT_EQ(named, present);
}

// Peak resident memory since the last call, KiB: tests before this one in the process read 512 MB of a device.
long PeakSinceLast() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  std::ofstream("/proc/self/clear_refs") << "5";
  return usage.ru_maxrss;
}

// What the headers of these files claim is never allocated.
TEST(BadFiles, MemoryStaysSmall) {
  PeakSinceLast();
  for (const auto& [name, message] : ExpectedMessages()) MessageOf(kFolder / "files" / name);
  EXPECT_LT(PeakSinceLast(), 400 * 1024) << "KiB";
}

TEST(BadFiles, FoldersMissingFilesAndDevicesAreRefused) {
  PeakSinceLast();
  EXPECT_EQ(MessageOf(kFolder / "files"), "is a folder; name a file, a pipe or - for standard input");
  EXPECT_EQ(MessageOf("/dev/zero"),
            "holds more than 512 MB, the limit of a pipe; write it to a file, or give a part of it");
  EXPECT_EQ(MessageOf(kFolder / "no_such_file"),
            "cannot be opened: No such file or directory; check the name and the permissions");
  // The endless one was in memory once.
  EXPECT_LT(PeakSinceLast(), 600 * 1024);
}

// A table of the right size whose cells are all holes, or all not numbers.
TEST(BadFiles, AMerlTableWithoutAUsableCellIsRefused) {
  const std::int32_t dims[3] = {90, 90, 180};
  const auto table = [&](double value) {
    std::string bytes(reinterpret_cast<const char*>(dims), sizeof(dims));
    bytes.reserve(34992012);
    for (int i = 0; i < 3 * 90 * 90 * 180; ++i) bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return bytes;
  };
  EXPECT_EQ(
      MessageOf(TemporaryFile(table(-1)).path()),
      "holds no usable sample: 1096216 marked as not measured, 361784 direction below the horizon; check that the "
      "right file was named and that its units are stated");
  EXPECT_EQ(
      MessageOf(TemporaryFile(table(std::nan(""))).path()),
      "holds no usable sample: 1096216 not a finite number, 361784 direction below the horizon; check that the right "
      "file was named and that its units are stated");
}

}  // namespace
}  // namespace lobefit

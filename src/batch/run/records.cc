#include "lobefit/batch/run/records.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/run/segment_lines.h"

namespace lobefit {
namespace {

class SegmentFile {
 public:
  explicit SegmentFile(const std::filesystem::path& path)
      : path_(path), number_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (number_ < 0) Fail();
  }
  ~SegmentFile() { close(number_); }
  SegmentFile(const SegmentFile&) = delete;
  SegmentFile& operator=(const SegmentFile&) = delete;

  // As far as the file goes.
  std::string Read(std::uint64_t begin, std::uint64_t end) const {
    std::string text(end - begin, '\0');
    std::size_t size = 0;
    while (size < text.size()) {
      const ssize_t count = pread(number_, text.data() + size, text.size() - size, static_cast<off_t>(begin + size));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) Fail();
      if (count == 0) break;
      size += static_cast<std::size_t>(count);
    }
    text.resize(size);
    return text;
  }

 private:
  [[noreturn]] void Fail() const {
    throw InputError(path_.string() + ": cannot be read: " + std::strerror(errno) + "; check the permissions");
  }
  const std::filesystem::path path_;
  const int number_;
};

// Most tasks end in the piece in which they began: only the others need be remembered.
void ForgetEnded(SegmentLines* lines) {
  std::unordered_map<std::string, StartRecord> open_tasks;
  for (StartRecord& start : lines->started) open_tasks.insert_or_assign(start.id, std::move(start));
  std::vector<std::string> ended_elsewhere;
  for (std::string& id : lines->ended) {
    if (open_tasks.erase(id) == 0) ended_elsewhere.push_back(std::move(id));
  }
  lines->started.clear();
  for (auto& [id, start] : open_tasks) lines->started.push_back(std::move(start));
  lines->ended = std::move(ended_elsewhere);
}

// The lines of a segment that begin in [begin, end).
SegmentLines ParseLines(const std::filesystem::path& path, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kStep = 1 << 16;
  const SegmentFile file(path);
  // From the byte before, which tells whether a line begins here, to the end of the last line.
  std::uint64_t offset = begin == 0 ? 0 : begin - 1;
  std::string text = file.Read(offset, end);
  std::size_t searched = text.empty() ? 0 : text.size() - 1;
  while (text.find('\n', searched) == std::string::npos) {
    searched = text.size();
    const std::string more = file.Read(offset + text.size(), offset + text.size() + kStep);
    if (more.empty()) break;
    text += more;
  }
  std::string_view rest = text;
  if (begin > 0) {
    const std::size_t first = rest.find('\n');
    rest.remove_prefix(first == std::string_view::npos ? rest.size() : first + 1);
    offset += text.size() - rest.size();
  }
  SegmentLines parsed;
  LineReader lines(rest);
  std::string_view line;
  bool is_first = true;
  while (offset + lines.offset() < end && lines.Next(&line)) {
    if (line.empty()) continue;
    const std::size_t known = parsed.done.size();
    try {
      ParseLine(line, static_cast<std::uint64_t>(line.data() - rest.data()), &parsed);
    } catch (const std::exception&) {
      ++parsed.lines_lost;
    }
    const bool is_done = parsed.done.size() > known;
    parsed.begins_with_done = parsed.begins_with_done || (is_first && is_done);
    is_first = false;
    // Places count from the beginning of the piece.
    if (!is_done) continue;
    parsed.done.back().row_offset += offset;
    parsed.done.back().picture_offset += offset;
  }
  parsed.picture_offset += offset;
  ForgetEnded(&parsed);
  return parsed;
}

// The better one of two records with one key, else the later one.
bool Replaces(const DoneRecord& next, const DoneRecord& held) {
  if (next.key == held.key && next.status != held.status) return next.status < held.status;
  return next.at > held.at;
}

}  // namespace

double Now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

Records ReadRecords(const std::filesystem::path& out, int threads) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 22;
  Records records;
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(out / "segments", error)) {
    if (entry.path().extension() == ".jsonl") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  struct Piece {
    std::size_t segment;
    std::uint64_t begin, end;
  };
  std::vector<Piece> pieces;
  for (const std::filesystem::path& path : paths) {
    const std::uint64_t bytes = std::filesystem::file_size(path);
    for (std::uint64_t begin = 0; begin < bytes; begin += kPiece)
      pieces.push_back({records.segments.size(), begin, std::min(begin + kPiece, bytes)});
    records.segments.push_back({path.stem().string(), "", false, path, 0});
  }
  std::vector<SegmentLines> parsed(pieces.size());
  ParallelFor(pieces.size(), threads,
              [&](std::size_t i) { parsed[i] = ParseLines(paths[pieces[i].segment], pieces[i].begin, pieces[i].end); });

  std::vector<std::unordered_map<std::string, StartRecord>> open(paths.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t s = pieces[i].segment;
    Segment& segment = records.segments[s];
    segment.lines_lost += parsed[i].lines_lost;
    if (!parsed[i].writer.host.empty()) {
      segment.host = parsed[i].writer.host;
      segment.is_running = IsRunning(parsed[i].writer);
    }
    if (i > 0 && pieces[i - 1].segment == s && parsed[i].begins_with_done) {
      const SegmentLines& before = parsed[i - 1];
      DoneRecord& first = parsed[i].done.front();
      first.picture_offset = before.picture_offset, first.picture_bytes = before.picture_bytes;
      first.picture_is_measured = before.picture_is_measured;
    }
    for (DoneRecord& done : parsed[i].done) {
      done.segment = s;
      records.done.push_back(std::move(done));
    }
    // A process begins no task twice, so that all begun ones may come first.
    for (StartRecord& start : parsed[i].started) {
      start.segment = s;
      open[s][start.id] = std::move(start);
    }
    for (const std::string& id : parsed[i].ended) open[s].erase(id);
    // But for the picture that may be the next piece's, its lines are no longer needed.
    parsed[i].done = {}, parsed[i].started = {}, parsed[i].ended = {};
  }
  for (std::size_t s = 0; s < paths.size(); ++s) {
    if (records.segments[s].is_running) continue;
    for (auto& [id, start] : open[s]) records.deaths[id].push_back(start);
  }
  return records;
}

RowReader::~RowReader() {
  for (const auto& [segment, descriptor] : descriptors_) close(descriptor);
}

std::string_view RowReader::Read(const DoneRecord& done) {
  return done.row_bytes == 0 ? done.row : ReadPlace(done, done.row_offset, done.row_bytes);
}

std::string_view RowReader::ReadPicture(const DoneRecord& done) {
  return done.picture_bytes == 0 ? done.picture : ReadPlace(done, done.picture_offset, done.picture_bytes);
}

std::string_view RowReader::ReadPlace(const DoneRecord& done, std::uint64_t offset, std::uint64_t bytes) {
  constexpr std::size_t kMostOpen = 64;
  const std::filesystem::path& path = records_.segments[done.segment].path;
  auto descriptor = descriptors_.find(done.segment);
  if (descriptor == descriptors_.end()) {
    if (descriptors_.size() == kMostOpen) {
      for (const auto& [segment, number] : descriptors_) close(number);
      descriptors_.clear();
    }
    const int number = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (number < 0) throw InputError(path.string() + ": cannot be read: " + std::strerror(errno));
    descriptor = descriptors_.emplace(done.segment, number).first;
  }
  text_.resize(bytes);
  if (pread(descriptor->second, text_.data(), bytes, static_cast<off_t>(offset)) != static_cast<ssize_t>(bytes))
    throw InputError(path.string() + ": changed while it was read; start the same command again");
  return text_;
}

std::unordered_map<std::string_view, const DoneRecord*> LatestDone(
    const Records& records, const std::unordered_map<std::string_view, std::string_view>& settings_of) {
  std::unordered_map<std::string_view, const DoneRecord*> latest;
  latest.reserve(settings_of.size());
  for (const DoneRecord& done : records.done) {
    const auto settings = settings_of.find(done.id);
    if (settings == settings_of.end() || settings->second != done.settings) continue;
    const auto [held, is_new] = latest.emplace(done.id, &done);
    if (!is_new && Replaces(done, *held->second)) held->second = &done;
  }
  return latest;
}

}  // namespace lobefit

#include "lobefit/batch/run/records.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <optional>

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "lobefit/base/error.h"
#include "lobefit/base/parallel.h"
#include "lobefit/base/text.h"
#include "lobefit/batch/run/journal.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kStatusNames = {"fitted", "doubtful", "failed", "crashed"};
// Before the object of a result's columns, which is the last member of its line. A quote within a string has a
// backslash before it, so that this is not found in one.
constexpr std::string_view kRow = ",\"row\":{";

struct Parsed {
  std::vector<DoneRecord> done;
  std::vector<StartRecord> started;
  std::vector<std::string> ended;  // ids of those that were begun here or in an earlier piece
  Writer writer;
  std::size_t lines_lost = 0;
};

std::optional<TaskStatus> StatusFrom(const std::string& name) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (name == kStatusNames[i]) return static_cast<TaskStatus>(i);
  }
  return std::nullopt;
}

DoneRecord DoneFrom(const Json& json, std::string_view row) {
  const Json& stamp = json.at("stamp");
  const std::optional<TaskStatus> status = StatusFrom(json.at("status").get<std::string>());
  if (!status) throw InputError("status");
  DoneRecord done;
  done.id = json.at("done").get<std::string>();
  done.key = json.at("key").get<std::string>();
  done.settings = json.at("settings").get<std::string>();
  done.sha256 = json.at("sha256").get<std::string>();
  done.stamp = {stamp.at(0).get<std::uint64_t>(), stamp.at(1).get<std::int64_t>(), stamp.at(2).get<std::int64_t>()};
  done.status = *status;
  done.exit_code = json.at("exit").get<int>();
  done.message = json.at("message").get<std::string>();
  done.document_bytes = json.at("document_bytes").get<std::uint64_t>();
  done.at = json.at("at").get<double>();
  done.seconds = json.at("seconds").get<double>();
  done.peak_mb = json.at("peak_mb").get<double>();
  done.threads = json.at("threads").get<int>();
  done.row = row;
  return done;
}

void ParseLine(std::string_view line, Parsed* parsed) {
  std::string_view row;
  std::string head(line);
  if (const std::size_t at = line.find(kRow); at != std::string_view::npos) {
    if (!line.ends_with("}}")) throw InputError("cut short");
    row = line.substr(at + kRow.size() - 1, line.size() - at - kRow.size());
    head = std::string(line.substr(0, at)) + "}";
  }
  const Json json = Json::parse(head);
  if (json.contains("done")) {
    parsed->done.push_back(DoneFrom(json, row));
    parsed->ended.push_back(parsed->done.back().id);
  } else if (json.contains("left")) {
    parsed->ended.push_back(json.at("left").get<std::string>());
  } else if (json.contains("start")) {
    parsed->started.push_back({json.at("start").get<std::string>(), json.at("at").get<double>(), 0});
  } else if (json.contains("segment")) {
    parsed->writer = {json.at("host").get<std::string>(), json.at("pid").get<long>(),
                      json.at("start_ticks").get<std::uint64_t>(), json.at("space").get<std::string>()};
  }
}

// A share of a segment's lines.
Parsed ParseLines(std::string_view text) {
  Parsed parsed;
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.empty()) continue;
    try {
      ParseLine(line, &parsed);
    } catch (const std::exception&) {
      ++parsed.lines_lost;
    }
  }
  return parsed;
}

std::shared_ptr<const std::string> ReadText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  auto text = std::make_shared<std::string>(file ? static_cast<std::size_t>(file.tellg()) : 0, '\0');
  file.seekg(0);
  file.read(text->data(), static_cast<std::streamsize>(text->size()));
  if (!file) throw InputError(path.string() + ": cannot be read; check the permissions");
  return text;
}

// Pieces of at most some megabytes that end with a line.
std::vector<std::string_view> Pieces(std::string_view text) {
  constexpr std::size_t kPiece = std::size_t{1} << 22;
  std::vector<std::string_view> pieces;
  while (!text.empty()) {
    const std::size_t end =
        text.size() <= kPiece ? text.size() : std::min(text.find('\n', kPiece), text.size() - 1) + 1;
    pieces.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return pieces;
}

// The better one of two records with one key, else the later one.
bool Replaces(const DoneRecord& next, const DoneRecord& held) {
  if (next.key == held.key && next.status != held.status) return next.status < held.status;
  return next.at > held.at;
}

}  // namespace

std::string NameOf(TaskStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

FileStamp StampOf(const std::filesystem::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return {};
  constexpr std::int64_t kBillion = 1000000000;
  return {static_cast<std::uint64_t>(status.st_size), status.st_mtim.tv_sec * kBillion + status.st_mtim.tv_nsec,
          status.st_ctim.tv_sec * kBillion + status.st_ctim.tv_nsec};
}

double Now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

std::string ToLine(const StartRecord& start) {
  return Json({{"start", start.id}, {"at", start.at}}).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string LeftLine(const std::string& id) {
  return Json({{"left", id}}).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToLine(const DoneRecord& done) {
  const Json json = {{"done", done.id},
                     {"key", done.key},
                     {"settings", done.settings},
                     {"sha256", done.sha256},
                     {"stamp", {done.stamp.bytes, done.stamp.modified_ns, done.stamp.changed_ns}},
                     {"status", NameOf(done.status)},
                     {"exit", done.exit_code},
                     {"message", done.message},
                     {"document_bytes", done.document_bytes},
                     {"at", done.at},
                     {"seconds", done.seconds},
                     {"peak_mb", done.peak_mb},
                     {"threads", done.threads}};
  std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (done.row.empty()) return line;
  line.pop_back();
  line += kRow.substr(0, kRow.size() - 1);
  line += done.row;
  return line + "}";
}

DoneRecord DoneFromLine(std::string_view line) {
  Parsed parsed;
  ParseLine(line, &parsed);
  return std::move(parsed.done.at(0));
}

Records ReadRecords(const std::filesystem::path& out, int threads) {
  Records records;
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(out / "segments", error)) {
    if (entry.path().extension() == ".jsonl") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  struct Piece {
    std::size_t segment;
    std::string_view text;
  };
  std::vector<Piece> pieces;
  for (const std::filesystem::path& path : paths) {
    records.segments.push_back({path.stem().string(), "", false, ReadText(path), 0});
    for (const std::string_view text : Pieces(*records.segments.back().text))
      pieces.push_back({records.segments.size() - 1, text});
  }
  std::vector<Parsed> parsed(pieces.size());
  ParallelFor(pieces.size(), threads, [&](std::size_t i) { parsed[i] = ParseLines(pieces[i].text); });

  std::vector<std::unordered_map<std::string, StartRecord>> open(paths.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t s = pieces[i].segment;
    Segment& segment = records.segments[s];
    segment.lines_lost += parsed[i].lines_lost;
    if (!parsed[i].writer.host.empty()) {
      segment.host = parsed[i].writer.host;
      segment.is_running = IsRunning(parsed[i].writer);
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
  }
  for (std::size_t s = 0; s < paths.size(); ++s) {
    if (records.segments[s].is_running) continue;
    for (auto& [id, start] : open[s]) records.deaths[id].push_back(start);
  }
  return records;
}

std::unordered_map<std::string, const DoneRecord*> LatestDone(
    const Records& records, const std::unordered_map<std::string, std::string>& settings_of) {
  std::unordered_map<std::string, const DoneRecord*> latest;
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

#include "lobefit/batch/run/segment_lines.h"

#include <array>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/run/flat_members.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kStatusNames = {"fitted", "doubtful", "failed", "crashed"};
// Before the object of a result's columns, which is the last member of its line. A quote within a string has a
// backslash before it, so that this is not found in one.
constexpr std::string_view kRow = ",\"row\":{";
// The line of a picture, between whose parts only base64 stands.
constexpr std::string_view kMeasured = "{\"measured\":\"", kFitted = "{\"fitted\":\"", kPictureEnd = "\"}";

template <typename T>
T Integer(std::string_view text) {
  const std::optional<long long> value = ParseInteger(text);
  if (!value || (*value < 0 && std::is_unsigned_v<T>)) throw InputError("no integer");
  return static_cast<T>(*value);
}

double Number(std::string_view text) {
  const std::optional<double> value = ParseDouble(text);
  if (!value) throw InputError("no number");
  return *value;
}

TaskStatus StatusFrom(std::string_view name) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (name == kStatusNames[i]) return static_cast<TaskStatus>(i);
  }
  throw InputError("status");
}

// "35004 1700000000000000000 1700000000000000001", of each file one after the other.
std::string StampText(const std::vector<FileStamp>& stamps) {
  std::string text;
  for (const FileStamp& stamp : stamps) {
    text += (text.empty() ? "" : " ") + std::to_string(stamp.bytes) + " " + std::to_string(stamp.modified_ns) + " " +
            std::to_string(stamp.changed_ns);
  }
  return text;
}

std::vector<FileStamp> StampsFrom(std::string_view text) {
  std::vector<FileStamp> stamps;
  const std::vector<std::string_view> numbers = SplitBlanks(text);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    stamps.push_back({Integer<std::uint64_t>(numbers[i]), Integer<std::int64_t>(numbers[i + 1]),
                      Integer<std::int64_t>(numbers[i + 2])});
  }
  return stamps;
}

// The first member says what a line is.
void ParseDone(const FlatMembers& members, DoneRecord* done) {
  constexpr int kMembers = 13;
  int seen = 0;
  for (const auto& [name, value, kind] : members) {
    ++seen;
    if (name == "done") {
      done->id = value;
    } else if (name == "key") {
      done->key = value;
    } else if (name == "settings") {
      done->settings = value;
    } else if (name == "sha256") {
      done->sha256 = value;
    } else if (name == "stamps") {
      done->stamps = StampsFrom(value);
    } else if (name == "status") {
      done->status = StatusFrom(value);
    } else if (name == "exit") {
      done->exit_code = Integer<int>(value);
    } else if (name == "message") {
      done->message = value;
    } else if (name == "document_bytes") {
      done->document_bytes = Integer<std::uint64_t>(value);
    } else if (name == "at") {
      done->at = Number(value);
    } else if (name == "seconds") {
      done->seconds = Number(value);
    } else if (name == "peak_mb") {
      done->peak_mb = Number(value);
    } else if (name == "threads") {
      done->threads = Integer<int>(value);
    } else {
      --seen;
    }
  }
  if (seen != kMembers) throw InputError("members are missing");
}

// Where the row of a line lies in it; empty where it has none.
std::string_view RowOf(std::string_view line) {
  const std::size_t at = line.find(kRow);
  if (at == std::string_view::npos) return {};
  if (!line.ends_with("}}")) throw InputError("cut short");
  return line.substr(at + kRow.size() - 1, line.size() - at - kRow.size());
}

}  // namespace

std::string NameOf(TaskStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

void ParseLine(std::string_view line, std::uint64_t offset, SegmentLines* parsed) {
  const std::uint64_t picture_bytes = std::exchange(parsed->picture_bytes, 0);
  if (line.starts_with(kMeasured) || line.starts_with(kFitted)) {
    parsed->picture_is_measured = line.starts_with(kMeasured);
    const std::size_t begin = (parsed->picture_is_measured ? kMeasured : kFitted).size();
    if (!line.ends_with(kPictureEnd) || line.size() < begin + kPictureEnd.size()) throw InputError("cut short");
    parsed->picture_offset = offset + begin;
    parsed->picture_bytes = line.size() - begin - kPictureEnd.size();
    return;
  }
  const std::string_view row = RowOf(line);
  const std::string head =
      row.empty() ? std::string(line) : std::string(line.substr(0, line.size() - row.size() - kRow.size())) + "}";
  const FlatMembers in_order(head);
  if (in_order.begin() == in_order.end()) return;
  if (in_order.begin()->name == "done") {
    DoneRecord done;
    ParseDone(in_order, &done);
    done.row_bytes = row.size();
    done.row_offset = row.empty() ? 0 : offset + static_cast<std::uint64_t>(row.data() - line.data());
    done.picture_offset = parsed->picture_offset;
    done.picture_bytes = picture_bytes;
    done.picture_is_measured = parsed->picture_is_measured;
    parsed->ended.push_back(done.id);
    parsed->done.push_back(std::move(done));
    return;
  }
  std::map<std::string, std::string> members;
  for (const FlatMember& member : in_order) members.emplace(member.name, member.value);
  if (members.contains("ended")) {
    parsed->ended.push_back(members.at("ended"));
  } else if (members.contains("start")) {
    parsed->started.push_back({members.at("start"), Number(members.at("at")), 0});
  } else if (members.contains("segment")) {
    parsed->writer = {members.at("host"), Integer<long>(members.at("pid")),
                      Integer<std::uint64_t>(members.at("start_ticks")), members.at("space")};
  }
}

std::string ToLine(const StartRecord& start) {
  return Json({{"start", start.id}, {"at", start.at}}).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string EndedLine(const std::string& id) {
  return Json({{"ended", id}}).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToLine(const DoneRecord& done) {
  const Json json = {{"done", done.id},
                     {"key", done.key},
                     {"settings", done.settings},
                     {"sha256", done.sha256},
                     {"stamps", StampText(done.stamps)},
                     {"status", NameOf(done.status)},
                     {"exit", done.exit_code},
                     {"message", done.message},
                     {"document_bytes", done.document_bytes},
                     {"at", done.at},
                     {"seconds", done.seconds},
                     {"peak_mb", done.peak_mb},
                     {"threads", done.threads}};
  std::string line;
  if (!done.picture.empty()) {
    line += done.picture_is_measured ? kMeasured : kFitted;
    line += done.picture;
    line += kPictureEnd;
    line += '\n';
  }
  line += json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (done.row.empty()) return line;
  line.pop_back();
  line += kRow.substr(0, kRow.size() - 1);
  line += done.row;
  return line + "}";
}

DoneRecord DoneFromLine(std::string_view text) {
  SegmentLines parsed;
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) ParseLine(line, static_cast<std::uint64_t>(line.data() - text.data()), &parsed);
  DoneRecord done = std::move(parsed.done.at(0));
  done.row = text.substr(done.row_offset, std::exchange(done.row_bytes, 0));
  done.picture = text.substr(done.picture_offset, std::exchange(done.picture_bytes, 0));
  return done;
}

}  // namespace lobefit

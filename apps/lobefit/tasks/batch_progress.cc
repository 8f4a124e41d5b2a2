#include "tasks/batch_progress.h"

#include <cstdio>

#include "text/output.h"
#include <fmt/format.h>
#include <unistd.h>

#include "lobefit/base/text/text.h"
#include "lobefit/batch/results/results.h"
#include "lobefit/batch/run/flat_members.h"

namespace lobefit {
namespace {

// "describes its data" and the like where the document has a verdict, else the status.
std::string ShareOf(const DoneRecord& done) {
  if (done.row.empty()) return NameOf(done.status);
  for (const FlatMember& member : FlatMembers(done.row)) {
    if (member.name == "verdict" && member.kind == FlatMember::Kind::kString) return std::string(member.value);
  }
  return NameOf(done.status);
}

}  // namespace

BatchProgress::BatchProgress(std::size_t total, bool lines)
    : total_(total),
      lines_(lines),
      terminal_(total > 0 && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

BatchProgress::~BatchProgress() {
  if (drawn_s_ >= 0) std::fputs("\r\033[K", stderr);
}

void BatchProgress::Add(const DoneRecord& done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++done_;
  if (lines_) {
    Print(fmt::format("{} {}\n", NameOf(done.status), Said(done.id, done.message)));
    std::fflush(stdout);
  }
  if (!terminal_) return;
  ++shares_[ShareOf(done)];
  Draw();
}

void BatchProgress::Draw() {
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (drawn_s_ >= 0 && elapsed_s - drawn_s_ < 0.2 && done_ < total_) return;
  drawn_s_ = elapsed_s;
  const double left_s = elapsed_s * static_cast<double>(total_ - done_) / static_cast<double>(done_);
  std::string shares;
  for (const auto& [name, count] : shares_) {
    shares +=
        fmt::format(", {} {:.0f} %", Excerpt(name), 100.0 * static_cast<double>(count) / static_cast<double>(done_));
  }
  std::fprintf(stderr, "\rbatch: %zu of %zu, %.0f s left%s\033[K", done_, total_, left_s, shares.c_str());
}

}  // namespace lobefit

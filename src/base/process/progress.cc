#include "lobefit/base/process/progress.h"

#include <cstdio>
#include <utility>

#include <unistd.h>

namespace lobefit {

Progress::Progress(std::string label, std::size_t total)
    : label_(std::move(label)),
      total_(total),
      enabled_(total > 0 && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::Advance(std::size_t steps) {
  const std::size_t done = done_ += steps;
  if (!enabled_) return;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (lock.owns_lock()) Draw(done);
}

void Progress::Draw(std::size_t done) {
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (elapsed_s - last_drawn_s_ < 0.1) return;
  last_drawn_s_ = elapsed_s;
  drawn_ = true;
  const double fraction = static_cast<double>(done) / static_cast<double>(total_);
  const double left_s = fraction > 0 ? elapsed_s * (1 - fraction) / fraction : 0;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(fraction * kWidth);
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kWidth, '.');
  std::fprintf(stderr, "\r%s [%s] %3.0f %%, %.0f s left\033[K", label_.c_str(), bar.c_str(), 100 * fraction, left_s);
}

}  // namespace lobefit

// A progress bar on stderr, drawn only where stderr is a terminal and only after a second.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace lobefit {

class Progress {
 public:
  // `total` steps of the work that `label` names.
  Progress(std::string label, std::size_t total);
  // Clears the bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `steps` more are done. Callable from any thread.
  void Advance(std::size_t steps = 1);

 private:
  void Draw(std::size_t done);

  const std::string label_;
  const std::size_t total_;
  const bool enabled_;
  const std::chrono::steady_clock::time_point start_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
  double last_drawn_s_ = 0.9;  // the first bar after one second; a tenth of a second between bars
  bool drawn_ = false;
};

}  // namespace lobefit

// How far a batch is: one line that is drawn again on a terminal, one line for each file elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

#include "lobefit/batch/run/records.h"

namespace lobefit {

class BatchProgress {
 public:
  // `total` tasks are to be done. `lines`: a line on stdout for each that is done.
  BatchProgress(std::size_t total, bool lines);
  // Clears the line.
  ~BatchProgress();
  BatchProgress(const BatchProgress&) = delete;
  BatchProgress& operator=(const BatchProgress&) = delete;

  // From any thread.
  void Add(const DoneRecord& done);

 private:
  void Draw();

  const std::size_t total_;
  const bool lines_, terminal_;
  const std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::map<std::string, std::size_t> shares_;  // of statuses, or of verdicts where documents have them
  double drawn_s_ = -1;
};

}  // namespace lobefit

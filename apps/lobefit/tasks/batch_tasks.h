// The tasks of a batch as fits: their options, and what is done for each.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tasks/fit_file.h"

#include "lobefit/batch/list/work_list.h"
#include "lobefit/batch/run/run.h"

namespace lobefit {

// Long names of the options that a single fit has, without dashes.
std::vector<std::string> FitOptionNames();

// Options of tasks by their words.
class TaskOptions {
 public:
  // The digest of what decides a result beside the file: version, options, the text of the recipe. Throws UsageError
  // and InputError for options that are not valid.
  std::string SettingsOf(const OptionWords& words);
  // Of a task whose words were given to SettingsOf.
  const FitFileOptions& Of(const Task& task) const { return *options_.at(task.options); }

 private:
  std::map<OptionWords, std::shared_ptr<const FitFileOptions>> options_;
};

enum class BatchReports { kNone, kDoubtful, kAll };

// Fits a task and draws its report; document and picture are of the outcome.
class FitWork {
 public:
  // `options` must outlive the object.
  FitWork(std::filesystem::path out, BatchReports reports, std::vector<std::string> formats,
          const TaskOptions& options);
  Outcome operator()(const Task& task, int threads) const;

 private:
  std::filesystem::path out_;
  BatchReports reports_;
  std::vector<std::string> formats_;
  const TaskOptions& options_;
};

}  // namespace lobefit

// The options by which a verb reads a measurement: what a file leaves open, and which part of it is used.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "lobefit/io/read.h"
#include "lobefit/measurement/prepare/selection.h"

namespace lobefit {

// What results of these files are called: the name of the one file without its ending, the folder's name, or what the
// names of several have in common at their beginning.
std::string SeriesName(const std::vector<std::string>& files);

// The file that answers for directions between its samples, where one alone was named.
std::filesystem::path OnlyFile(const std::vector<std::string>& files);

class MeasurementOptions {
 public:
  // Adds the options; the object must outlive the parsing.
  void AddTo(CLI::App* app);
  // Reads one file, or several and folders as one measurement (io/series.h), and applies the selection. Throws
  // UsageError and InputError.
  Measurement Load(const std::vector<std::string>& files) const;
  // The same for verbs whose result stands or falls with what the values are: refuses a file that does not say it.
  Measurement LoadStated(const std::vector<std::string>& files) const;
  // Throws UsageError for words that no file can make valid.
  void Check() const;
  // The words that were given, by option: "theta-i", "10:50".
  std::map<std::string, std::string> Words() const;
  // Takes those of a document's fit where none was given. Throws InputError for an option that there is not.
  void FillFrom(const std::map<std::string, std::string>& words, const std::string& document);
  // Keeps the chosen incident directions and channels.
  void Select(Measurement* measurement) const;

 private:
  ReadOptions Read() const;
  // Each option's name and word.
  std::vector<std::pair<std::string, std::string*>> Named();
  void SelectDirections(Measurement* measurement) const;

  std::string theta_i_, phi_i_, channels_;
  std::vector<std::string> words_;  // of the options of ReadOptionTable(), in its order; empty: not given
  std::string document_;            // whose words some are; empty: none
};

}  // namespace lobefit

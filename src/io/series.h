// One measurement named as one file, several, or a folder of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/io/text/format.h"

namespace lobefit {

// "scan.csv" or "scan.csv:theta_i=30,sample-rotation=20deg": a file, and keys that its head lacks.
struct FileSpec {
  std::filesystem::path path;
  std::vector<std::string> keys;  // "theta_i=30"
};

// The whole text is a path where there is such a file; else what follows the last colon that is followed by KEY=VALUE
// are keys.
FileSpec ParseFileSpec(const std::string& text);

// Reads each as ReadMeasurement does and pools them (measurement/prepare/pool.h); a folder stands for its files, by
// name. Throws InputError for a folder without files, UsageError for the same file twice.
Measurement ReadSeries(const std::vector<std::string>& specs, const ReadOptions& options);

// The files that such names stand for, folders by all files in them: what no output may overwrite.
std::vector<std::filesystem::path> InputPaths(const std::vector<std::string>& files);

}  // namespace lobefit

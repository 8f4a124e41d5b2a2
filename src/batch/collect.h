// What a batch hands over: tables, an overview, and how far it is.
#pragma once

#include <filesystem>
#include <string>

#include "lobefit/batch/results/results.h"

namespace lobefit {

// Writes results.csv, results.jsonl, runs.csv and index.html into `out`. Throws OutputError.
void WriteResults(const ResultTable& table, int threads, const std::filesystem::path& out);

// How many tasks are fitted, doubtful, failed, crashed, missing, with the first failures and missing ones by name.
std::string StatusToText(const ResultTable& table);
// The same as a JSON document, with every name.
std::string StatusToJson(const ResultTable& table);

}  // namespace lobefit

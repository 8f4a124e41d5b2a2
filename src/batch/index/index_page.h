// index.html: a batch at one look, as one file that needs no network.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "lobefit/batch/results/results.h"

namespace lobefit {

struct IndexOptions {
  std::string title;
  // Of longer batches the page holds the failures and the first rows by id, and says so.
  std::size_t most_rows = 10000, most_pictures = 1000;
};

// Totals, failures with their messages, a gallery of lit spheres, a table to sort and filter, a scatter of any two
// columns with intervals, links to documents and reports. `out` is the batch's folder, where the reports are looked
// for.
std::string IndexPage(const ResultTable& table, const std::filesystem::path& out, const IndexOptions& options);

}  // namespace lobefit

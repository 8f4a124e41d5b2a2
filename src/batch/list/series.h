// Cells of a manifest that name several files, which are one measurement.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lobefit {

// Files that the cell names, relative to `folder`, each perhaps with keys (io/series.h): "scan_10.csv:theta_i=10". The
// cell is the name of a file or folder, a pattern with * ? or [], or several of these with ";" between; a folder stands
// for the measurements in it, by name, and so does a pattern for the files that it matches. Names that are not there
// are kept. Throws InputError for a folder or pattern without files, and a file that is named twice.
std::vector<std::string> ListSeries(const std::string& cell, const std::filesystem::path& folder, bool any_rows);

// What the results of such a cell are named by, whatever files are there now: what its names have in common at their
// beginning. Empty where they have nothing.
std::string SeriesId(const std::string& cell);

}  // namespace lobefit

// One fit a texel of an image stack: all of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/maps/output/exr.h"
#include "lobefit/maps/output/previews.h"
#include "lobefit/maps/recipe.h"
#include "lobefit/maps/shared_numbers.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

struct MapsOptions {
  MapRecipe recipe;
  std::filesystem::path folder = ".";
  std::string name;
  int threads = 1;
  std::optional<std::pair<std::size_t, std::size_t>> rows;  // [first, end): only these, into the journal
  bool merge = false;                                       // only joins what the journal holds
  std::vector<std::size_t> left_out;                        // lights that are not fitted, from 0
  NormalY normal_y = NormalY::kUp;
};

// Counts of texels for the document and the summary.
struct MapsSummary {
  std::size_t texels = 0, normal = 0, lobe = 0, alpha = 0;  // within the mask; determined ones of each
  std::size_t no_lobe = 0, at_bound = 0, not_converged = 0, too_few = 0;
  double mean_rms = 0, mean_used = 0;
};

struct MapsResult {
  bool complete = false;
  std::vector<std::pair<std::size_t, std::size_t>> missing;  // rows, where not complete
  std::vector<std::filesystem::path> written;
  MapsSummary summary;
  SharedNumbers shared;
  double fit_seconds = 0;
  std::size_t fitted_texels = 0;  // in this process
};

// Writes NAME.maps.exr, NAME.maps.json and previews into the folder; while it runs, the journal NAME.maps.part beside
// them, which a second call goes on with. Same bytes whatever the threads, bands and interruptions. Memory: bands of 16
// MB a thread, and rows of tiles of the result. Throws InputError, OutputError.
MapsResult RunMaps(const Stack& stack, const MapsOptions& options, const std::string& command);

// What the journal is called.
std::filesystem::path JournalFolder(const MapsOptions& options);

}  // namespace lobefit

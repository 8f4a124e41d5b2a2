// Writing a material in any of the formats that can be written: the table behind `lobefit convert`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/io/exr/map.h"
#include "lobefit/io/merl/writer.h"
#include "lobefit/io/read.h"
#include "lobefit/io/rgl/writer.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/interpolation.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// What is to be written: a measurement, a function of directions, or both. Formats that list samples take the
// measurement's, or tabulate the function over a goniometer's directions; formats with a grid of their own ask the
// function, or interpolate the measurement.
struct WriteSource {
  const Measurement* measurement = nullptr;
  BrdfFunction brdf;
  Channels channels;
  bool isotropic = false;
  DirectionsPredicate covers = {};  // where the function lies between measured values; null: everywhere
};

struct WriteOptions {
  CellPosition merl_cell = CellPosition::kCentre;
  RglWriteOptions rgl;  // isotropic and description are set by the source
  ExrMap exr;
  std::size_t exr_size = 256;  // pixels a side
  int tensor_tree_log2 = 5;
};

// One format. `extension` is what a file of it is usually named ("csv", "bsdf"): the default choice for an output's
// name.
struct WriteFormat {
  const char* name;
  const char* extension;
  const char* description;
  bool is_grid;  // asks for f_r at directions of its own
  // Returns the files that were written. Throws UsageError for what the format cannot hold, OutputError.
  std::vector<std::filesystem::path> (*write)(const WriteSource& source, const WriteOptions& options,
                                              const std::filesystem::path& path);
};
const std::vector<WriteFormat>& WriteFormats();

// The format named `name`, or the one that the extension of `path` stands for ("bsdf" is rgl, "xml" is tensor-tree).
// Throws UsageError that lists the formats.
const WriteFormat& FindWriteFormat(const std::optional<std::string>& name, const std::filesystem::path& path);

// The file's own function of directions, where the format defines one (rgl: what renderers evaluate), and where it lies
// between measured values; nothing otherwise.
struct TabulatedFunction {
  BrdfFunction brdf;
  DirectionsPredicate covers;
};
TabulatedFunction TabulatedBrdf(const std::filesystem::path& path, const Measurement& measurement);

// Writes a file into another format and reads it back. What was lost: words (what the target cannot hold, samples that
// were set aside when reading back) and numbers (the target's values against the source's, see compare_written.h).
struct Conversion {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> losses;
  Difference difference;     // compared is 0 where nothing could be compared, and
  std::string not_compared;  // says why
};
Conversion Convert(const WriteSource& source, const WriteFormat& format, const WriteOptions& options,
                   const std::filesystem::path& path);

}  // namespace lobefit

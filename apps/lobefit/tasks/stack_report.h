// What `report` and `info` do with image stacks and maps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// Draws the report as .png, .html or both, and prints how well lights that were not fitted are predicted and what is
// doubtful about the stack. `picture`: its extension becomes the format's. Throws UsageError for other formats,
// InputError, OutputError.
int ReportMaps(const std::filesystem::path& maps, const std::filesystem::path& stack, const StackOptions& options,
               const std::vector<std::string>& formats, const std::filesystem::path& picture, double scale);

// What a stack holds: lights, encoding, shares of dark and saturated values. Reads all images.
int DescribeStack(const std::filesystem::path& stack, const StackOptions& options, bool json);

}  // namespace lobefit

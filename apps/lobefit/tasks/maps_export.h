// lobefit export of maps.
#pragma once

#include <filesystem>

#include "lobefit/export/export.h"
#include "lobefit/maps/textures/export_maps.h"

namespace lobefit {

// Prints what `lobefit export` prints. Returns the exit code. Throws InputError, OutputError.
int ExportMapsFile(const std::filesystem::path& maps, const ExportOptions& options, const MapsExportOptions& more,
                   bool json);

}  // namespace lobefit

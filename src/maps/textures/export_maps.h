// Export of maps: pictures and a document for each renderer, with the table of what each carries.
#pragma once

#include "lobefit/export/export.h"
#include "lobefit/maps/document.h"
#include "lobefit/maps/output/previews.h"
#include "lobefit/maps/textures/numbers.h"

namespace lobefit {

struct MapsExportOptions {
  // NormalY::kDown: beside NAME_normal.png, whose y is up as all targets have it, NAME_normal_down.png is written.
  NormalY normal_y = NormalY::kUp;
  double white = kNan;  // MapNumbers'
};

// Writes the pictures NAME_*.png, a document a target that names them, and NAME.export.json. Targets that hold one
// material only refuse. Errors are those of at most 1000 texels (ErrorOfTarget). `maps_file` is NAME.maps.exr, for its
// digest. Throws InputError where no target can hold maps, before anything is written; OutputError.
ExportOutcome ExportMaps(const Maps& maps, const MapsRecord& record, const std::filesystem::path& maps_file,
                         const ExportOptions& options, const MapsExportOptions& more);

}  // namespace lobefit

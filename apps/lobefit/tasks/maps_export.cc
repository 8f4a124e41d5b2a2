#include "tasks/maps_export.h"

#include "text/output.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"

namespace lobefit {

int ExportMapsFile(const std::filesystem::path& path, const ExportOptions& options, const MapsExportOptions& more,
                   bool json) {
  const MapsRecord record = ReadMapsRecord(std::filesystem::path(path).replace_extension(".json"));
  const Maps maps = ReadMapsExr(path);
  const ExportOutcome outcome = ExportMaps(maps, record, path, options, more);
  if (json) {
    const FileBytes document(options.folder / (options.name + ".export.json"));
    fmt::print("{}", document.bytes());
  } else {
    Print(ExportSummary(outcome));
  }
  if (outcome.refusals.empty()) return kExitDone;
  Print(fmt::format("lobefit: {}: {}; the other targets are written\n", options.material_file,
                    RefusalText(outcome.refusals)),
        stderr);
  return kExitInput;
}

}  // namespace lobefit

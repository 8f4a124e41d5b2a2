#include "lobefit/export/targets/merl/write.h"

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/merl/read.h"
#include "lobefit/io/merl/writer.h"

namespace lobefit {
namespace {

std::string RefuseMerl(const FittedBrdf& fit) {
  if (fit.IsTilted()) return "its table has no azimuth of the sample, and a lobe of the fit is tilted";
  if (fit.IsAnisotropic()) return "its table has no azimuth of the sample, and a lobe of the fit is anisotropic";
  return "";
}

WrittenFiles WriteMerlTable(const FittedBrdf& fit, const WriteContext& context) {
  const std::filesystem::path path = context.File(".binary");
  WriteMerl(fit.function(), fit.channels(), {}, path);
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadMerlLookup({path, bytes.bytes()});
  return {{path}, InChannelsOf(fit, back.brdf), false, {"the error is that of a reader that takes the nearest cell"}};
}

}  // namespace

Target MerlTarget() {
  return {.name = "merl",
          .description = "MERL table, isotropic materials only",
          .load = "as any file of the MERL database: {name}.binary",
          .rgb_only = true,
          .refusal = RefuseMerl,
          .carries = CarriesTable,
          .write = WriteMerlTable,
          .recognises = IsMerlTable,
          .read = ReadMerlLookup};
}

}  // namespace lobefit

#include "lobefit/export/targets/json/write.h"

#include <memory>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/sel/document.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

bool IsDocument(std::string_view bytes) { return Trim(bytes).starts_with("{"); }

ImportedMaterial ReadDocument(const InputFile& file) {
  const Material material = ReadMaterial(file.path);
  const Channels channels = {material.channels, material.wavelengths_nm};
  if (material.sel) return {"json", channels, SelBrdf(*material.sel), {}};
  const BrdfFunction brdf = FittedBrdf(material).function();
  return {"json", channels, brdf, {}};
}

WrittenFiles WriteJson(const FittedBrdf& fit, const WriteContext& context) {
  const std::filesystem::path path = context.File(".material.json");
  WriteMaterial(fit.material(), path);
  const ImportedMaterial back = ReadDocument({path, {}});
  return {{path}, back.brdf, true, {}};
}

}  // namespace

Target JsonTarget() {
  return {.name = "json",
          .description = "the material document itself",
          .load = "lobefit report {name}.material.json MEASUREMENT",
          .carries = CarriesModelItself,
          .write = WriteJson,
          .write_sel = WriteSelJson,
          .recognises = IsDocument,
          .read = ReadDocument};
}

}  // namespace lobefit

#include "lobefit/export/import.h"

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/export/targets.h"

namespace lobefit {

ImportedMaterial ImportMaterial(const std::filesystem::path& path) {
  const FileBytes file(path);
  for (const Target& target : ExportTargets()) {
    if (target.read != nullptr && target.recognises(file.bytes())) return target.read({path, file.bytes()});
  }
  throw InputError(path.string() +
                   ": no material that can be read; allowed are materials of pbrt-v4 (.pbrt), Mitsuba 3 (.xml), "
                   "MaterialX (.mtlx) and glTF (.gltf), RGL tables (.bsdf), MERL tables (.binary) and material "
                   "documents (.json)");
}

}  // namespace lobefit

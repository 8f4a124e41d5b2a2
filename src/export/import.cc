#include "lobefit/export/import.h"

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/export/targets.h"

namespace lobefit {

namespace {

constexpr std::size_t kMostText = std::size_t{16} << 20;

}  // namespace

ImportedMaterial ImportMaterial(const std::filesystem::path& path) {
  const FileBytes file(path);
  for (const Target& target : ExportTargets()) {
    if (target.read == nullptr || !target.recognises(file.bytes())) continue;
    if (target.is_text && file.bytes().size() > kMostText) {
      throw InputError(path.string() + ": is a file of " + target.name + " of " + std::to_string(file.bytes().size()) +
                       " bytes; materials of up to " + std::to_string(kMostText) +
                       " are read: name a file that holds the material without the scene");
    }
    return target.read({path, file.bytes()});
  }
  if (file.bytes().starts_with("glTF"))
    throw InputError(path.string() + ": is glTF in its binary form; save it as .gltf, which is text");
  throw InputError(path.string() +
                   ": no material that can be read; allowed are materials of pbrt-v4 (.pbrt), Mitsuba 3 (.xml), "
                   "MaterialX (.mtlx) and glTF (.gltf), RGL tables (.bsdf), MERL tables (.binary) and material "
                   "documents (.json)");
}

}  // namespace lobefit

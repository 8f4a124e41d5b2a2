// One run of a reader of renderers' files on arbitrary bytes: it reads or throws InputError, and what it reads is f_r
// at any directions. Files that a material names are looked for in a folder that is not there.
#pragma once

#include <cmath>
#include <vector>

#include "tests/fuzz/fuzz_reader.h"

#include "lobefit/export/targets/imported_material.h"

namespace lobefit {

inline int FuzzImport(bool (*recognise)(std::string_view), ImportedMaterial (*read)(const InputFile&),
                      const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  recognise(bytes);
  try {
    const ImportedMaterial material = read(InputFile{"none/fuzz", bytes});
    Require(!material.channels.names.empty() && material.channels.names.size() < 100000);
    std::vector<double> values(material.channels.names.size());
    for (const auto& [wi, wo] : {std::pair{Vec3{0, 0, 1}, Vec3{0, 0, 1}},
                                 {Vec3{0.6, 0, 0.8}, Vec3{-0.6, 0, 0.8}},
                                 {Vec3{0.8, 0, 0.6}, Vec3{0, 0.6, 0.8}},
                                 {Vec3{0.6, 0, -0.8}, Vec3{0, 0, 1}}}) {
      material.brdf(wi, wo, values.data());
      for (const double value : values) Require(!std::isnan(value));
    }
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace lobefit

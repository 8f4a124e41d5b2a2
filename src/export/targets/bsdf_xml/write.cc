#include "lobefit/export/targets/bsdf_xml/write.h"

#include <algorithm>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/io/bsdf_xml/lookup.h"
#include "lobefit/io/bsdf_xml/writer.h"

namespace lobefit {
namespace {

std::vector<Carried> CarriesXml(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesTable(fit);
  if (fit.material().channels.size() == 3 && fit.IsRgbOrGrey()) {
    Mark(&rows, Feature::kChannels, Carries::kApproximately, "as CIE Y, u', v' of Radiance's primaries");
  }
  return rows;
}

WrittenFiles WriteBsdfXml(const FittedBrdf& fit, const WriteContext& context) {
  const std::filesystem::path path = context.File(".xml");
  TensorTreeOptions options;
  options.isotropic = fit.IsIsotropic();
  WriteTensorTree(fit.function(), fit.channels(), options, path);
  const FileBytes bytes(path);
  const TreeLookup table = LookUpTensorTrees({path, bytes.bytes()});
  const std::size_t channels = fit.material().channels.size();
  if (table.channels.size() == channels) return {{path}, table.brdf, false, {}};
  // Grey in R, G and B became one block.
  return {{path},
          [brdf = table.brdf, channels](const Vec3& wi, const Vec3& wo, double* values) {
            brdf(wi, wo, values);
            std::fill_n(values + 1, channels - 1, values[0]);
          },
          false,
          {}};
}

}  // namespace

Target BsdfXmlTarget() {
  return {.name = "bsdf-xml",
          .description = "BSDF-XML tensor tree for Radiance",
          .load = "void BSDF {name} 6 0 {name}.xml 0 1 0 . (and two lines 0)",
          .carries = CarriesXml,
          .write = WriteBsdfXml};
}

}  // namespace lobefit

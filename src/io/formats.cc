#include "lobefit/io/formats.h"

#include "lobefit/io/alta/reader.h"
#include "lobefit/io/astm/reader.h"
#include "lobefit/io/bird/reader.h"
#include "lobefit/io/bsdf_xml/reader.h"
#include "lobefit/io/cornell/reader.h"
#include "lobefit/io/csv/reader.h"
#include "lobefit/io/exr/reader.h"
#include "lobefit/io/fred/reader.h"
#include "lobefit/io/lighttools/reader.h"
#include "lobefit/io/mbsdf/reader.h"
#include "lobefit/io/merl/reader.h"
#include "lobefit/io/mit/reader.h"
#include "lobefit/io/mountain/reader.h"
#include "lobefit/io/openmaterial/reader.h"
#include "lobefit/io/rgl/reader.h"
#include "lobefit/io/utia/reader.h"
#include "lobefit/io/zemax/reader.h"

namespace lobefit {

const std::vector<Format>& Formats() {
  static const std::vector<Format> formats = {
      {"rgl", "RGL/EPFL .bsdf tensor file", IsRgl, ReadRgl},
      {"exr", "OpenEXR slice, hemisphere or UTIA image", IsExr, ReadExr},
      {"merl", "MERL .binary table", IsMerl, ReadMerl},
      {"mbsdf", "MDL .mbsdf isotropic table", IsMbsdf, ReadMbsdf},
      {"bsdf-xml", "Radiance/WINDOW BSDF-XML: angle-basis matrix or tensor tree", IsBsdfXml, ReadBsdfXml},
      {"utia", "UTIA .bin table", IsUtia, ReadUtia},
      {"mit", "MIT/Ngan anisotropic .dat table", IsMit, ReadMit},
      {"zemax", "Zemax BSDF Data Interchange text", IsZemax, ReadZemax},
      {"lighttools", "LightTools .bsdf text", IsLightTools, ReadLightTools},
      {"fred", "FRED tabular scatter text", IsFred, ReadFred},
      {"astm", "ASTM E1392/E2387 text", IsAstm, ReadAstm},
      {"alta", "ALTA text or binary", IsAlta, ReadAlta},
      {"mountain", "pab-opto Mountain text", IsMountain, ReadMountain},
      {"cornell", "Cornell spectral text", IsCornell, ReadCornell},
      {"bird", "EMPIR BiRD/BxDiff universal BRDF file, JSON", IsBird, ReadBird},
      {"openmaterial", "ASAM OpenMATERIAL 3D BRDF table, JSON", IsOpenMaterial, ReadOpenMaterial},
      {"csv", "goniometer rows with column names, comma, semicolon or tab separated", IsCsv, ReadCsv},
  };
  return formats;
}

}  // namespace lobefit

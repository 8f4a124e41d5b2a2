#include "lobefit/io/formats.h"

namespace lobefit {

const std::vector<Format>& Formats() {
  static const std::vector<Format> formats = {
      {"rgl", "RGL/EPFL .bsdf tensor file", IsRgl, ReadRgl},
      {"merl", "MERL .binary table", IsMerl, ReadMerl},
      {"csv", "goniometer rows with column names, comma, semicolon or tab separated", IsCsv, ReadCsv},
  };
  return formats;
}

}  // namespace lobefit

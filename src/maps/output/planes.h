// The maps: which there are, in which part of the file, and how a texel fills them.
#pragma once

#include <string>
#include <vector>

#include "lobefit/maps/engine/texel.h"

namespace lobefit {

enum class MapPart { kParameters, kErrors, kQuality };
enum class MapType { kFloat, kHalf, kCount };  // kCount: unsigned integers

struct MapPlane {
  MapPart part;
  std::string name;  // channel of the EXR part
  MapType type;
};

const char* PartName(MapPart part);

// What maps there are.
struct MapKind {
  MapLobe lobe = MapLobe::kNone;
  int channels = 0;
  bool clusters = false;  // texels are parted
  bool doubt = true;      // files of older versions have none
};

// In the order of Fill. Parameters: normal.x .y .z, diffuse.C, f0.C, alpha (or alpha_x, alpha_y, angle_deg and, of an
// ellipsoid, tilt_x_deg, tilt_y_deg), C of R, G, B, or Y alone. Errors, standard: the same names, of alphas the error
// of the logarithm as ln_alpha, and normal.angle_deg. Quality: normal.doubt_deg (engine/errors.h), rms (units of
// scale), scale, used (lights), cluster (from 1; 0: none), status (MapStatus), the last.
std::vector<MapPlane> PlanesFor(const MapKind& kind);

// values[plane]; what PlanesFor names. NaN for what is not there or not determined.
void Fill(const TexelFit& fit, const MapKind& kind, float* values);

// The plane of the width, or of the larger one. Domain: a lobe.
inline const char* WidestAlpha(MapLobe lobe) { return lobe == MapLobe::kGgx ? "alpha" : "alpha_x"; }

// Of the name in the part; the number of planes where there is none.
std::size_t PlaneIndex(const std::vector<MapPlane>& planes, MapPart part, const std::string& name);

// A rectangle of maps: values[plane][row width + column].
struct MapRows {
  std::size_t first_row = 0, rows = 0, width = 0;
  std::vector<std::vector<float>> values;
};

}  // namespace lobefit

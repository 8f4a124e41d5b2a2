// Writing a BSDF-XML tensor tree (LBNL/Shirley-Chiu) that Radiance reads.
#pragma once

#include <filesystem>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct TensorTreeOptions {
  bool isotropic = false;   // rank 3 instead of 4; the caller knows that f_r does not depend on the azimuth
  int log2_resolution = 5;  // cells along each axis at the finest level: 2^this
  // A cube whose values all lie within this fraction of their mean becomes one value.
  double tolerance = 0.02;
};

// The front's reflection under WINDOW's name, "Reflection Back". R G B are written as CIE Y, u', v' (radiance_color.h)
// or, where they are grey in all directions, as Visible alone; one channel as Visible, wavelengths one block each.
// Values at the cells' centres. Coloured isotropic functions whose least luminance is above 0.005 / pi are written with
// rank 4: Radiance takes such a diffuse part out of a tree of rank 3 and loses its colour. Throws OutputError,
// UsageError for a resolution out of 2..7 (rank 3: 2..8).
void WriteTensorTree(const BrdfFunction& brdf, const Channels& channels, const TensorTreeOptions& options,
                     const std::filesystem::path& path);

}  // namespace lobefit

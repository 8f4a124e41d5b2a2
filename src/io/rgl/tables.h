// The tables of an RGL `.bsdf` file, checked.
#pragma once

#include <cstdint>
#include <vector>

#include "lobefit/io/rgl/tensor_file.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// A table whose last two axes are a grid over the unit square.
struct RglGrid {
  std::vector<float> values;
  std::vector<std::size_t> shape;

  std::size_t width() const { return shape.back(); }
  std::size_t height() const { return shape[shape.size() - 2]; }
};

struct RglTables {
  std::vector<float> phi, theta, wavelengths;
  RglGrid ndf, sigma, vndf, spectra;
  bool spectral = false;
  bool jacobian = true;  // values are to be multiplied by ndf / (4 sigma)
  // One a node of the luminance table, or empty.
  std::vector<std::uint8_t> valid;

  bool isotropic() const { return phi.size() <= 2; }
  std::size_t slices() const { return phi.size() * theta.size(); }
  std::size_t channels() const { return spectra.shape[2]; }
  std::size_t nodes() const { return spectra.width() * spectra.height(); }
};

// Throws InputError that names the field.
RglTables ReadRglTables(const TensorFile& file);

// R, G, B or the file's wavelengths.
Channels RglChannels(const RglTables& tables);

// Part of the circle of viewers that the file stores: 1 all of it; 2 half of it, for a surface that a half turn leaves
// unchanged; 4 a quarter of it, for one with two mirror planes. Throws InputError for another part.
int RglReduction(const TensorFile& file, const RglTables& tables);

}  // namespace lobefit

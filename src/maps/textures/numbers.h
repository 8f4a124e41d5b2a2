// Maps as renderers are to have them: every texel with every number, and in the words of their models.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/maps/output/exr.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

// One texel. Reflectances are absolute; a grey picture has three equal channels.
struct TexelNumbers {
  Vec3 normal = {0, 0, 1};
  Color3 diffuse = {0, 0, 0}, f0 = {0, 0, 0};
  Widths widths = {1, 1};  // along the tangent of azimuth `rotation` (SurfaceLobe's), and across it
  double rotation = 0;     // radians
  bool lobe = false;
};

// What the maps say at a texel, as f_r: the oracle of every export. `schlick`: the fit has Schlick's term, else none.
Surface SurfaceOf(const TexelNumbers& numbers, bool schlick);

// Texels whose numbers were not determined and are filled, by what they are; all within the mask.
struct FilledTexels {
  std::size_t normal = 0, diffuse = 0, f0 = 0, width = 0;
};

class MapNumbers {
 public:
  // A number that is not determined becomes the median of the determined ones of its block of 16 x 16 texels or, where
  // they are fewer than 8, of the block of twice the side, and so on to the whole picture; a lobe of unknown widths is
  // round. Texels without a lobe by evidence keep none. Outside the mask: +z and black. Diffuse and f0 are divided by
  // `white`, the albedo in the maps' unit that is 1; NaN: that of Calibrated maps, 1, or of others the 99.5th
  // percentile of the largest channel of diffuse + f0. `maps` must outlive this, with all planes read.
  MapNumbers(const Maps& maps, bool calibrated, double white);

  std::size_t width() const { return maps_.rows.width; }
  std::size_t height() const { return maps_.rows.rows; }
  MapLobe lobe() const { return maps_.lobe; }
  bool schlick() const { return calibrated_; }
  double white() const { return white_; }
  const FilledTexels& filled() const { return filled_; }
  std::size_t inside() const { return inside_; }  // texels within the mask
  bool Inside(std::size_t texel) const;
  TexelNumbers At(std::size_t texel) const;

 private:
  double Value(std::size_t plane, std::size_t texel) const;
  bool HasLobe(std::size_t texel) const;

  const Maps& maps_;
  bool calibrated_;
  double white_;
  std::vector<std::vector<float>> medians_;  // [plane of the parameters][texel], empty where nothing is missing
  FilledTexels filled_;
  std::size_t inside_ = 0, f0_ = 0, alpha_ = 0;
};

}  // namespace lobefit

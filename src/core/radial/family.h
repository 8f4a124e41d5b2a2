// The families of normal distributions, whatever their shape: round, tilted, anisotropic, with all five parameters; and
// the ABg lobe, which is no distribution of normals but lies on the same ellipses.
#pragma once

namespace lobefit {

enum class Family { kGgx, kBeckmann, kKagiwadaKalaba, kSphericalGaussian, kProfile, kStudent, kAbg };

}  // namespace lobefit

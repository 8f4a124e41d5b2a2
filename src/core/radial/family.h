// The families of normal distributions, whatever their shape: round, tilted, anisotropic, with all five parameters.
#pragma once

namespace lobefit {

enum class Family { kGgx, kBeckmann, kKagiwadaKalaba, kSphericalGaussian, kProfile, kStudent };

}  // namespace lobefit

// A reflectance function as synthesis and writers see it: they know neither models nor fits.
#pragma once

#include <functional>

#include "lobefit/math/vec.h"

namespace lobefit {

// Writes f_r in 1/sr, one value a channel, for unit directions above the horizon. Safe to call from several threads.
using BrdfFunction = std::function<void(const Vec3& wi, const Vec3& wo, double* values)>;

}  // namespace lobefit

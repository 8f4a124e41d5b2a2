// The numbers behind the pictures as OpenEXR.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/report/figures/field_image.h"

namespace lobefit {

// One part a field, with the float channels "measured", "fitted" (f_r, 1/sr) and "log_ratio" (natural logarithm of
// measured / fitted, within kMostLogRatio); NaN where nothing is known. By way of a temporary name; throws OutputError.
// Domain: at least one field, names unique.
void WriteExr(const std::vector<NamedField>& fields, const std::filesystem::path& path);

}  // namespace lobefit

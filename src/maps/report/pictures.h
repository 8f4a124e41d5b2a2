// Maps as pictures of a page.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "lobefit/maps/output/exr.h"

namespace lobefit {

// White where a number is NaN within the picture, the page's shade outside the mask.
cv::Mat NormalPicture(const Maps& maps);
// `head`: "diffuse." or "f0."; `white` becomes 1.
cv::Mat ColorPicture(const Maps& maps, const std::string& head, double white);
// One plane by the sequential colours from `low` to `high`, by the logarithm where asked.
cv::Mat ScalarPicture(const Maps& maps, MapPart part, const std::string& name, double low, double high,
                      bool logarithmic);
cv::Mat StatusPicture(const Maps& maps);
// A photograph, [texel channels + channel].
cv::Mat PhotoPicture(const std::vector<float>& image, const Maps& maps, double white);

// Percentile (0 to 1) of the finite numbers of the planes whose names begin with `head`; NaN where there are none.
double Percentile(const Maps& maps, MapPart part, const std::string& head, double share);

}  // namespace lobefit

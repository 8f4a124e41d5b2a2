// PNG through libpng: opencv_imgcodecs would add 58 ms to every start of the program.
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

namespace lobefit {

// `rgb`: CV_8UC3, red first. `pixels_per_inch` is stored for printing; 0: none. By way of a temporary name; throws
// OutputError.
void WritePng(const cv::Mat& rgb, double pixels_per_inch, const std::filesystem::path& path);

// The same in memory, for pictures inside a page.
std::string EncodePng(const cv::Mat& rgb, double pixels_per_inch);

}  // namespace lobefit

// PNG files, packed by zlib on several threads: libpng packs on one, and opencv_imgcodecs would add 58 ms to every
// start of the program.
#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

namespace lobefit {

// `rgb`: CV_8UC3, red first. `pixels_per_inch` is stored for printing; 0: none. By way of a temporary name; throws
// OutputError. The bytes do not depend on the number of threads.
void WritePng(const cv::Mat& rgb, double pixels_per_inch, const std::filesystem::path& path, int threads = 1);

// The same in memory, for pictures inside a page.
std::string EncodePng(const cv::Mat& rgb, double pixels_per_inch, int threads = 1);

}  // namespace lobefit

// Pictures as bytes of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lobefit {

// A PNG of 8 or 16 bits, 1, 3 or 4 channels (the fourth is alpha, not multiplied in), rows from the top.
std::string EncodePixels(const std::vector<std::uint16_t>& pixels, std::size_t width, std::size_t height, int channels,
                         int bits);

// An OpenEXR of floats, [(row width + column) channels + channel]; 1 channel is called Y, 3 are R, G, B.
std::string EncodeExr(std::vector<float> image, std::size_t width, std::size_t height, std::size_t channels);

}  // namespace lobefit

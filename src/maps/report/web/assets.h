// The files of the page of maps, which the build puts into the program.
#pragma once

#include <string_view>

namespace lobefit {

extern const std::string_view kMapsHtml;  // maps.html, a template
extern const std::string_view kMapsCss;   // maps.css, behind the style of report/web
extern const std::string_view kMapsJs;    // maps.js
extern const std::string_view kMapsGlsl;  // maps.glsl

}  // namespace lobefit

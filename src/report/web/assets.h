// The files of the page, which the build puts into the program.
#pragma once

#include <string_view>

namespace lobefit {

extern const std::string_view kPageHtml;  // page.html, a template
extern const std::string_view kPageCss;   // page.css
extern const std::string_view kPageJs;    // page.js
extern const std::string_view kPageGlsl;  // page.glsl

}  // namespace lobefit

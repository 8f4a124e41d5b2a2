// The files of the overview, which the build puts into the program.
#pragma once

#include <string_view>

namespace lobefit {

extern const std::string_view kIndexHtml;  // page.html, a template
extern const std::string_view kIndexCss;   // page.css
extern const std::string_view kIndexJs;    // page.js

}  // namespace lobefit

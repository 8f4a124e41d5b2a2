// Text for a page: JSON inside HTML, HTML text.
#pragma once

#include <string>
#include <string_view>

namespace lobefit {

// A quoted JSON string that may stand inside <script>; bytes that are not UTF-8 become U+FFFD.
std::string JsonString(std::string_view text);
// A number of `digits` significant digits; null if it is not finite.
std::string JsonNumber(double value, int digits = 6);
// With &, <, > and quotes escaped.
std::string HtmlText(std::string_view text);

}  // namespace lobefit

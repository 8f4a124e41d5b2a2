// A text file with places to fill.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace lobefit {

// `text` with each {{name}} replaced by its value, once: values are not searched for places. {{#name}}...{{/name}}
// stays where sections.at(name), else it is left out with all it holds. Throws std::logic_error for a name that has no
// value.
std::string FillTemplate(std::string_view text, const std::map<std::string, std::string, std::less<>>& values,
                         const std::map<std::string, bool, std::less<>>& sections);

// As a page's policy names a style or a script that it lets run.
std::string PolicyHash(std::string_view text);

}  // namespace lobefit

// Files that are no measurement, though people have them under the name of one.
#pragma once

#include <string>
#include <string_view>

namespace lobefit {

// What the bytes are and what to do: "is a web page, not a measurement; ..."; empty for anything else.
std::string DescribeWrongKind(std::string_view bytes);

}  // namespace lobefit

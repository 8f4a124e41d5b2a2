// Base64 [RFC 4648 section 4]: bytes inside text files.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lobefit {

std::string Base64(std::string_view bytes);
// Nothing where the text is not base64 with its padding.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace lobefit

// Encodings of text that is not UTF-8, told by the words that heads of measurements have.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lobefit {

// Text of `encoding`, a name of iconv, in UTF-8. Throws InputError where the system does not know it, and for a byte that
// is none of its; with "//IGNORE" behind the name such bytes are left out.
std::string ToUtf8(std::string_view bytes, const char* encoding, const std::filesystem::path& path);

// "GB18030", "SHIFT_JIS", "BIG5", "EUC-KR", "WINDOWS-1250" or "WINDOWS-1251" where the beginning of a text has words for
// angles and light in it, else "WINDOWS-1252".
const char* FindEncoding(std::string_view head);

}  // namespace lobefit

// Encodings of text that is not UTF-8, told by the words that heads of measurements have.
#pragma once

#include <string>
#include <string_view>

namespace lobefit {

// The text in UTF-8; what `encoding` (a name of iconv) does not allow is left out. Empty where the system does not know
// the encoding.
std::string ConvertLoosely(std::string_view text, const char* encoding);

// "GB18030", "SHIFT_JIS", "BIG5", "EUC-KR", "WINDOWS-1250" or "WINDOWS-1251" where the text has words for angles and
// light in it, else "WINDOWS-1252", which every text is.
const char* FindEncoding(std::string_view text);

}  // namespace lobefit

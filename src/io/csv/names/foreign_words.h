// Names of columns in the languages of those who write them, as the English words that the rules of columns.h know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// A name in Chinese, Japanese, Korean or Russian script with the words that are known put into English, blanks between
// them: "入射角(度)" gives " incident  angle ( deg )". Everything else stays as it is.
std::string TranslateScripts(std::string_view name);

// English words of one word in small Latin letters without accents: "observacion" gives {"viewing"}, the compound
// "einfallswinkel" {"incident", "angle"}. Empty where the word is of no language but English, or not known.
std::vector<std::string_view> TranslateWord(std::string_view word);

}  // namespace lobefit

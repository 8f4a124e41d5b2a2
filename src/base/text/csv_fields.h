// Fields of a line of CSV with the quotes of RFC 4180: a field that begins with a quote ends with one, may hold
// separators, and writes a quote as two.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// The fields between separators, as written: untrimmed, with their quotes. Blanks may stand around quotes.
void SplitQuoted(std::string_view line, char separator, std::vector<std::string_view>* fields);

// A field without blanks around it and without its quotes. `storage` holds the text where quotes were doubled.
std::string_view Unquoted(std::string_view field, std::string* storage);

// True where the line ends within a quoted field, which then goes on in the next line.
bool EndsWithinQuotes(std::string_view line, char separator);

}  // namespace lobefit

// Text from strangers, made fit for a terminal, a message or a shell.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// Length in bytes of the well-formed UTF-8 character with which `text` begins (Unicode 15, table 3-7); 0 if there is
// none.
std::size_t Utf8Length(std::string_view text);

// One line that a terminal only shows: control characters (C0, C1, delete), marks that turn the direction of writing
// and bytes that are not UTF-8 become '?'.
std::string Printable(std::string_view text);
// The name of a file, for messages.
std::string PrintableName(const std::filesystem::path& path);
// The same with newlines and tabs kept, for whole texts.
std::string PrintableLines(std::string_view text);

// Names from a file with commas between, at most 20 of them: "a, b, c and 39997 more".
std::string JoinSome(const std::vector<std::string>& names);

// Text as HTML and XML hold it, in elements and in attributes: &, <, > and both quotes escaped; bytes that are not
// UTF-8 and characters that XML 1.0 does not allow become U+FFFD.
std::string MarkupText(std::string_view text);

// The word that a shell (bash, zsh, POSIX 2024) reads as `argument`, on one line; quoted only where it has to be.
std::string ShellWord(std::string_view argument);

}  // namespace lobefit

// What --help prints: lines of at most 100 columns, one word for what an option takes, an example, the exit codes.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace lobefit {

// Sets how `verb` prints its help. `example`: command lines that work as they stand.
void SetUpHelp(const std::string& example, CLI::App* verb);

// Of words that `verb` does not know: "option '--recip' is not known (did you mean '--recipe'?)".
std::string UnknownWords(const CLI::App& verb);

// The text in lines no longer than `width`, broken at blanks, each after the first with `indent` blanks before it.
std::string Wrapped(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace lobefit

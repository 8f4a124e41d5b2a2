#include "text/help.h"

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::size_t kWidth = 100, kColumn = 30;

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 2 wrong usage; 3 input that cannot be read or is not valid; 4 the fit did not converge, is "
    "not "
    "determined or does not describe the data (its result is written and says so); 5 tasks or trials are missing; 1 "
    "anything else.";

// What an option takes, in a word; nothing for a flag.
std::string Metavariable(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  if (!option.get_option_text().empty()) return option.get_option_text();
  std::string type = option.get_type_name();
  // A choice is listed as "TEXT:{a,b}".
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open != std::string::npos && close != std::string::npos) {
    type = type.substr(open + 1, close - open - 1);
    std::replace(type.begin(), type.end(), ',', '|');
    return type;
  }
  static const std::map<std::string, std::string> words = {
      {"channels", "LIST"},  {"drift", "auto|SD"}, {"format", "LIST"}, {"mean", "flux|plain"}, {"metric", "NAME"},
      {"name", "NAME"},      {"noise", "TERMS"},   {"out", "PATH"},    {"phi-i", "RANGE"},     {"picture", "FILE"},
      {"recipe", "NAME"},    {"recipes", "LIST"},  {"shard", "I/N"},   {"theta-i", "RANGE"},   {"to", "LIST"},
      {"weighting", "NAME"}, {"with", "FILE"}};
  const auto word = words.find(option.get_lnames().empty() ? "" : option.get_lnames()[0]);
  if (word != words.end()) return word->second;
  if (type.starts_with("UINT") || type.starts_with("INT")) return "N";
  return type.starts_with("FLOAT") ? "NUMBER" : "TEXT";
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    const bool many = is_positional && option->get_expected_max() > 1;
    std::string left = "  " + make_option_name(option, is_positional);
    if (!is_positional) {
      const std::string word = Metavariable(*option);
      if (!word.empty()) left += " " + word;
    }
    if (many) left += "...";
    if (left.size() + 2 > kColumn) {
      left += "\n" + std::string(kColumn, ' ');
    } else {
      left.resize(kColumn, ' ');
    }
    return left + Wrapped(option->get_description(), kWidth - kColumn, kColumn) + "\n";
  }
  std::string make_subcommand(const CLI::App* verb) const override {
    std::string left = "  " + verb->get_name();
    left.resize(kColumn / 2, ' ');
    return left + Wrapped(verb->get_description(), kWidth - kColumn / 2, kColumn / 2) + "\n";
  }
};

}  // namespace

std::string Wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::string wrapped;
  std::size_t line = 0;
  for (const std::string_view word : Split(text, ' ')) {
    if (line > 0 && line + 1 + word.size() > width) {
      wrapped += "\n" + std::string(indent, ' ');
      line = 0;
    }
    if (line > 0) wrapped += " ", ++line;
    wrapped += word;
    line += word.size();
  }
  return wrapped;
}

void SetUpHelp(const std::string& example, CLI::App* verb) {
  verb->formatter(std::make_shared<HelpFormatter>());
  std::string footer = example.empty() ? "" : "Example:\n  " + example + "\n\n";
  verb->footer(footer + Wrapped(kExitCodes, kWidth, 0));
}

std::string UnknownWords(const CLI::App& verb) {
  std::vector<std::string> names, words;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const std::string& word : verb.remaining()) {
    if (!word.starts_with("-")) continue;
    const std::string name = word.substr(0, word.find('='));
    words.push_back(fmt::format("option '{}' is not known{}", Excerpt(name), DidYouMean(name, names)));
  }
  if (words.empty() && !verb.remaining().empty())
    words.push_back(fmt::format("'{}' was not expected", Excerpt(verb.remaining().front())));
  return Join(words, "; ");
}

}  // namespace lobefit

// What every reader of TOML says of a file: where a fault stands, what is unknown, what is allowed. For sources that
// link toml++; an alternative to its own exceptions, which know no file.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

struct TomlFile {
  std::string name;  // printable

  [[noreturn]] void Fail(const toml::source_region& at, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", name, at.begin.line, message));
  }

  // Throws InputError with the line for text that is not TOML.
  toml::table Parse(std::string_view text) const {
    CheckKeyLengths(text);
    try {
      return toml::parse(text);
    } catch (const toml::parse_error& error) {
      Fail(error.source(), Excerpt(error.description(), 200));
    }
  }

  // toml++ descends into a dotted key part by part: from some 40 000 parts on its stack ends the program. A key ends
  // with its line.
  void CheckKeyLengths(std::string_view text) const {
    constexpr std::ptrdiff_t kMostPoints = 10000;
    std::size_t number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
      const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
      if (std::count(line.begin(), line.end(), '.') > kMostPoints) {
        throw InputError(
            fmt::format("{}:{}: the line has more than {} points, which no key may have; write long arrays "
                        "on several lines",
                        name, number, kMostPoints));
      }
      begin += line.size() + 1;
    }
  }

  // `where`: of which table, in words such as "in [lights]"; may be empty.
  void CheckKeys(const toml::table& table, const std::vector<std::string>& allowed,
                 const std::string& where = "") const {
    for (const auto& [key, node] : table) {
      const std::string given(key.str());
      if (std::find(allowed.begin(), allowed.end(), given) != allowed.end()) continue;
      Fail(key.source(), fmt::format("unknown key '{}'{}{}{}; allowed: {}", Excerpt(given), where.empty() ? "" : " ",
                                     where, DidYouMean(given, allowed), Join(allowed)));
    }
  }

  // A number from `low` to `high`; `otherwise` where the key is not there.
  double Number(const toml::table& table, const char* key, double otherwise, double low, double high) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    const double value = node->is_number() ? *node->value<double>() : std::nan("");
    if (!(value >= low && value <= high))
      Fail(node->source(), fmt::format("'{}' must be a number from {} to {}", key, low, high));
    return value;
  }

  // Index of the word in `allowed`; 0 where the key is not there.
  std::size_t Word(const toml::table& table, const char* key, const std::vector<std::string>& allowed) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return 0;
    const std::string word = node->is_string() ? *node->value<std::string>() : "?";
    const auto found = std::find(allowed.begin(), allowed.end(), word);
    if (found == allowed.end()) {
      Fail(node->source(), fmt::format("{} = '{}' is unknown{}; allowed: {}", key, Excerpt(word),
                                       DidYouMean(word, allowed), Join(allowed)));
    }
    return static_cast<std::size_t>(found - allowed.begin());
  }
};

}  // namespace lobefit

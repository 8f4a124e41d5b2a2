// lobefit formats: what can be read, and the options that one format alone looks at.
#include <algorithm>
#include <memory>

#include "text/help.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/formats.h"
#include "lobefit/io/text/options.h"

namespace lobefit {
namespace {

constexpr std::size_t kWidth = 100;

bool LooksAt(const ReadOptionEntry& option, const std::string& format) {
  return option.formats.empty() ||
         std::find(option.formats.begin(), option.formats.end(), format) != option.formats.end();
}

std::string OptionsOf(const std::string& format) {
  constexpr std::size_t kColumn = 6;
  std::string text;
  for (const ReadOptionEntry& option : ReadOptionTable()) {
    if (!LooksAt(option, format)) continue;
    text += fmt::format("  --{} {}\n{:{}}{}\n", option.name, option.allowed, "", kColumn,
                        Wrapped(option.help, kWidth - kColumn, kColumn));
  }
  return text;
}

int List(bool json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::size_t width = 0;
  for (const Format& format : Formats()) width = std::max(width, std::string(format.name).size());
  std::string text = "Formats that are read, recognised by their content:\n";
  for (const Format& format : Formats()) {
    std::vector<std::string> own;
    for (const ReadOptionEntry& option : ReadOptionTable()) {
      if (!option.formats.empty() && LooksAt(option, format.name)) own.push_back(std::string("--") + option.name);
    }
    text += fmt::format("  {:<{}}  {}\n", format.name, width, format.description);
    list.push_back({{"name", format.name}, {"description", format.description}, {"options", own}});
  }
  text += "`lobefit formats NAME` lists the options for what a file of that format leaves open.\n";
  fmt::print("{}", json ? list.dump(2) + "\n" : text);
  return kExitDone;
}

nlohmann::ordered_json OptionsToJson(const std::string& format) {
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  for (const ReadOptionEntry& option : ReadOptionTable()) {
    if (LooksAt(option, format))
      options[std::string("--") + option.name] = {{"takes", option.allowed}, {"help", option.help}};
  }
  return options;
}

int Describe(const std::string& name, bool json) {
  std::vector<std::string> names;
  for (const Format& format : Formats()) {
    names.emplace_back(format.name);
    if (name != format.name) continue;
    if (json) {
      const nlohmann::ordered_json described = {
          {"name", name}, {"description", format.description}, {"options", OptionsToJson(name)}};
      fmt::print("{}\n", described.dump(2));
      return kExitDone;
    }
    fmt::print("{}: {}\nOptions for what a file leaves open, of every verb that reads one:\n{}", format.name,
               format.description, OptionsOf(name));
    return kExitDone;
  }
  throw UsageError(fmt::format("'{}' is no format that is read{}; the formats are: {}", Excerpt(name),
                               DidYouMean(name, names), Join(names)));
}

}  // namespace

std::function<int()> SetUpFormats(CLI::App* app, CommonOptions* common) {
  auto name = std::make_shared<std::string>();
  app->add_option("NAME", *name, "a format, to see its options");
  return [=] { return name->empty() ? List(common->json) : Describe(*name, common->json); };
}

}  // namespace lobefit

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"
#include "lobefit/export/export.h"

namespace lobefit {
namespace {

std::string Percent(double fraction) {
  const double percent = 100 * fraction;
  return percent < 99.5   ? fmt::format("{:.2g} %", percent)
         : percent < 1000 ? fmt::format("{:.0f} %", percent)
                          : fmt::format("{:.0f} x", 1 + fraction);
}

std::string Levels(const ErrorLevels& levels) {
  if (levels.compared == 0) return "nothing";
  return fmt::format("median {}, 90 % within {}, at most {}", Percent(levels.median), Percent(levels.percentile_90),
                     Percent(levels.maximum));
}

// One line for all features with the same fate.
std::string CarriedLines(const std::vector<Carried>& rows) {
  std::string text;
  std::vector<bool> done(rows.size(), false);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::string> features;
    for (std::size_t j = i; j < rows.size(); ++j) {
      if (rows[j].how != rows[i].how || rows[j].note != rows[i].note) continue;
      features.emplace_back(NameOf(rows[j].feature));
      done[j] = true;
    }
    const char* how = rows[i].how == Carries::kExactly         ? "exactly"
                      : rows[i].how == Carries::kApproximately ? "approximately"
                                                               : "NOT CARRIED";
    text += fmt::format("  {}: {}{}\n", how, Join(features), rows[i].note.empty() ? "" : " (" + rows[i].note + ")");
  }
  return text;
}

std::string Row(const ExportResult& result) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : result.files) names.push_back(file.string());
  const ExportError& error = result.error;
  const auto level = [](const ErrorLevels& levels, double value) {
    return levels.compared == 0 ? std::string("-") : Percent(value);
  };
  return fmt::format("{:<14} {:<10} {:>9} {:>9}  {:>9} {:>9}  {:>9}   {}\n", result.target->name, result.numbers,
                     level(error.lobe, error.lobe.median), level(error.lobe, error.lobe.percentile_90),
                     level(error.off, error.off.median), level(error.off, error.off.percentile_90),
                     std::isnan(error.albedo) ? "-" : Percent(error.albedo), Join(names));
}

}  // namespace

void AddLosses(const std::vector<Carried>& carries, std::vector<std::string>* head) {
  for (const Carried& row : carries) {
    if (row.how == Carries::kExactly) continue;
    head->push_back(fmt::format("{}: {}{}", NameOf(row.feature),
                                row.how == Carries::kNot ? "not carried, " : "approximately, ", row.note));
  }
  for (std::string& line : *head) {
    for (char& c : line) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
}

std::string ErrorWords(const ExportError& error) {
  const std::string albedo = std::isnan(error.albedo) ? "" : "; albedo within " + Percent(error.albedo);
  return fmt::format("in the lobe {}; off it {}{}", Levels(error.lobe), Levels(error.off), albedo);
}

std::string RefusalText(const std::vector<Refusal>& refusals) {
  std::vector<std::string> sentences;
  std::vector<bool> done(refusals.size(), false);
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::string> names;
    for (std::size_t j = i; j < refusals.size(); ++j) {
      if (refusals[j].reason != refusals[i].reason) continue;
      names.emplace_back(refusals[j].target->name);
      done[j] = true;
    }
    sentences.push_back(fmt::format("{} cannot hold this material: {}", Join(names), refusals[i].reason));
  }
  return Join(sentences, "; ");
}

std::string ExportSummary(const ExportOutcome& outcome) {
  std::string text = fmt::format(
      "{:<14} {:<10} {:>19}  {:>19}  {:>9}\n{:<14} {:<10} {:>9} {:>9}  {:>9} {:>9}  {:>9}   {}\n", "", "",
      "in the lobe", "off the lobe", "", "target", "numbers", "median", "90 %", "median", "90 %", "albedo", "files");
  for (const ExportResult& result : outcome.results) text += Row(result);
  text += fmt::format(
      "Errors: |f_r of the exported model - the fit's| relative to the fit's f_r (to {:.1g}/sr where that is less), at "
      "directions to 88 degrees. In the lobe: half vectors that hold 90 % of a lobe's normals. Albedo: the largest "
      "relative difference of a directional albedo.\n",
      kErrorFloor);
  for (const std::string& remark : outcome.remarks) text += fmt::format("Note: {}\n", remark);
  for (const ExportResult& result : outcome.results) {
    text += fmt::format("{}:\n  load: {}\n{}", result.target->name, result.load, CarriedLines(result.carries));
    if (!result.choice.empty()) {
      text += fmt::format("  numbers {}, {}", result.numbers, result.choice);
      if (result.other) {
        text += fmt::format(" (errors in the lobe, off it and of the albedo together); the {} ones have: {}",
                            result.numbers == "copied" ? "refitted" : "copied", ErrorWords(*result.other));
      }
      text += "\n";
    }
    for (const std::string& note : result.notes) text += fmt::format("  {}\n", note);
  }
  return text;
}

}  // namespace lobefit

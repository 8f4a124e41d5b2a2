#include "lobefit/export/export.h"

#include <chrono>
#include <functional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/progress.h"
#include "lobefit/base/text.h"
#include "lobefit/base/version.h"
#include "lobefit/export/import.h"
#include "lobefit/export/refit.h"
#include "lobefit/export/targets.h"
#include "lobefit/export/targets/sel/document.h"

namespace lobefit {
namespace {

using Clock = std::chrono::steady_clock;

// Why a target cannot hold the material, by `reason_of`; throws with all reasons and the targets that can.
void CheckRefusals(const ExportOptions& options, const std::function<std::string(const Target&)>& reason_of) {
  std::vector<std::string> reasons;
  for (const Target* target : options.targets) {
    const std::string reason = reason_of(*target);
    if (!reason.empty()) reasons.push_back(fmt::format("{} cannot hold this material: {}", target->name, reason));
  }
  if (reasons.empty()) return;
  std::vector<std::string> can;
  for (const Target& target : ExportTargets()) {
    if (reason_of(target).empty()) can.emplace_back(target.name);
  }
  throw InputError(fmt::format("{}: {}; targets that can: {}", options.material_file, Join(reasons, "; "), Join(can)));
}

std::string RefusalOfSel(const Target& target) {
  if (target.write_sel != nullptr) return "";
  return "it takes a model of the surface, and this is a table of squared ellipsoidal lobes for each incident "
         "direction";
}

std::string ErrorWords(const ExportError& error) {
  return fmt::format("median {:.2g} %, 90 % within {:.2g} %, at most {:.3g} %, albedo within {:.2g} %",
                     100 * error.median, 100 * error.percentile_90, 100 * error.maximum, 100 * error.albedo);
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
      features.push_back(rows[j].feature);
      done[j] = true;
    }
    const char* how = rows[i].how == Carries::kExactly         ? "exactly"
                      : rows[i].how == Carries::kApproximately ? "approximately"
                                                               : "NOT CARRIED";
    text += fmt::format("  {}: {}{}\n", how, Join(features), rows[i].note.empty() ? "" : " (" + rows[i].note + ")");
  }
  return text;
}

std::vector<std::string> Header(const Material& material, const ExportOptions& options, const ExportResult& result) {
  std::string fit_error;
  for (const MetricError& error : material.errors) fit_error += fmt::format("  {} {:.3g}", error.metric, error.rms);
  std::vector<std::string> lines = {
      fmt::format("{}: exported by lobefit {} from {}", options.name, Version(), options.material_file),
      fmt::format("measurement: {}", material.source.file),
      fmt::format("error of the fit (root mean square):{}", fit_error), fmt::format("command: {}", options.command)};
  if (result.numbers == "copied" || result.numbers == "refitted") {
    lines.push_back(fmt::format("numbers {}; error of this material against the fit: {}", result.numbers,
                                ErrorWords(result.error)));
  }
  for (const Carried& row : result.carries) {
    if (row.how == Carries::kExactly) continue;
    lines.push_back(
        fmt::format("{}: {}{}", row.feature, row.how == Carries::kNot ? "not carried, " : "approximately, ", row.note));
  }
  // A comment ends with its line.
  for (std::string& line : lines) {
    for (char& c : line) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  return lines;
}

WriteContext ContextOf(const Material& material, const ExportOptions& options, const ExportResult& result) {
  return {options.folder, options.name, Header(material, options, result), options.threads, ImportMaterial};
}

// What counts is the file: it is read back where it can be.
void Complete(const WrittenFiles& written, const ErrorMeter& meter, Clock::time_point start, ExportResult* result) {
  result->error = meter.Compare(written.brdf);
  result->files = written.files;
  result->notes = written.notes;
  for (const std::filesystem::path& file : result->files) result->bytes += std::filesystem::file_size(file);
  result->seconds = std::chrono::duration<double>(Clock::now() - start).count();
}

ExportResult ExportTo(const Target& target, const FittedBrdf& fit, const ErrorMeter& meter,
                      const ExportOptions& options) {
  const auto start = Clock::now();
  ExportResult result;
  result.target = &target;
  result.carries = target.carries(fit);
  std::optional<FittedBrdf> refitted;
  if (target.evaluate != nullptr) {
    result.numbers = "copied";
    result.error = meter.Compare(target.evaluate(fit));
    if (options.numbers != Numbers::kCopied) refitted = Refit(fit, target.own_model(fit), meter, options.threads);
    if (refitted) {
      const ExportError error = meter.Compare(target.evaluate(*refitted));
      if (options.numbers == Numbers::kRefitted || IsBetter(error, result.error)) {
        result.other = result.error;
        result.error = error;
        result.numbers = "refitted";
      } else {
        result.other = error;
        refitted.reset();
      }
    }
  }
  const WrittenFiles written = target.write(refitted ? *refitted : fit, ContextOf(fit.material(), options, result));
  if (target.evaluate == nullptr) result.numbers = written.exact ? "exact" : "tabulated";
  Complete(written, meter, start, &result);
  return result;
}

ExportResult ExportSelTo(const Target& target, const Material& material, const ErrorMeter& meter,
                         const ExportOptions& options) {
  const auto start = Clock::now();
  ExportResult result;
  result.target = &target;
  result.carries = CarriesSel(material);
  result.numbers = "exact";
  Complete(target.write_sel(material, ContextOf(material, options, result)), meter, start, &result);
  return result;
}

std::vector<ExportResult> ExportToAll(const ExportOptions& options,
                                      const std::function<ExportResult(const Target&)>& export_to) {
  std::vector<ExportResult> results;
  Progress progress("exporting", options.targets.size());
  for (const Target* target : options.targets) {
    results.push_back(export_to(*target));
    progress.Advance();
  }
  return results;
}

std::vector<ExportResult> ExportSel(const Material& material, const ExportOptions& options) {
  CheckRefusals(options, RefusalOfSel);
  MakeFolder(options.folder);
  const ErrorMeter meter = SelErrorMeter(material);
  return ExportToAll(options, [&](const Target& target) { return ExportSelTo(target, material, meter, options); });
}

std::vector<ExportResult> ExportModel(const Material& material, const ExportOptions& options) {
  const FittedBrdf fit(material);
  CheckRefusals(options, [&](const Target& target) { return target.refusal(fit); });
  MakeFolder(options.folder);
  const ErrorMeter meter(fit);
  return ExportToAll(options, [&](const Target& target) { return ExportTo(target, fit, meter, options); });
}

}  // namespace

std::vector<ExportResult> ExportMaterial(const Material& material, const ExportOptions& options) {
  std::vector<ExportResult> results = material.sel ? ExportSel(material, options) : ExportModel(material, options);
  WriteFileAtomically(options.folder / (options.name + ".export.json"), ExportJson(material, options, results));
  return results;
}

std::string ExportSummary(const std::vector<ExportResult>& results) {
  std::string text = fmt::format("{:<14} {:<10} {:>9} {:>9} {:>9} {:>9}   {}\n", "target", "numbers", "median", "90 %",
                                 "maximum", "albedo", "files");
  for (const ExportResult& result : results) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : result.files) names.push_back(file.string());
    const auto percent = [](double fraction) { return fmt::format("{:.2g} %", 100 * fraction); };
    text += fmt::format("{:<14} {:<10} {:>9} {:>9} {:>9} {:>9}   {}\n", result.target->name, result.numbers,
                        percent(result.error.median), percent(result.error.percentile_90),
                        percent(result.error.maximum), percent(result.error.albedo), Join(names));
  }
  text += "Errors: f_r of the exported model against the fit's at the same directions; albedo: largest difference.\n";
  for (const ExportResult& result : results) {
    text += fmt::format("{}:\n{}", result.target->name, CarriedLines(result.carries));
    if (result.other) {
      const auto words = [](const ExportError& error) {
        return fmt::format("median {:.2g} %, 90 % within {:.2g} %, albedo {:.2g} %", 100 * error.median,
                           100 * error.percentile_90, 100 * error.albedo);
      };
      text += fmt::format("  numbers {}{}; the {} ones have {}\n", result.numbers,
                          IsBetter(result.error, *result.other) ? ", which is nearer by median and 90 % together"
                                                                : " as asked, though not nearer",
                          result.numbers == "copied" ? "refitted" : "copied", words(*result.other));
    }
    for (const std::string& note : result.notes) text += fmt::format("  {}\n", note);
  }
  return text;
}

}  // namespace lobefit

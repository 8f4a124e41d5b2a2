#include "lobefit/export/export.h"

#include <chrono>
#include <functional>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"
#include "lobefit/export/determined.h"
#include "lobefit/export/refit.h"
#include "lobefit/export/targets.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/sel/document.h"
#include "lobefit/export/targets/shader_text.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/renderer/rgb_fit.h"

namespace lobefit {
namespace {

using Clock = std::chrono::steady_clock;

// An albedo above this is more than the error of its quadrature.
constexpr double kWorthARemark = 1.01;

// What a target is given: the fit, its error meter, and what was taken out of or changed in it.
struct Subject {
  FittedBrdf fit;
  std::shared_ptr<const ErrorMeter> meter;
  std::vector<Carried> changes;
};

// The fit in the three forms that targets take, each made once.
class Subjects {
 public:
  explicit Subjects(const Material& material) : whole_{FittedBrdf(material), nullptr, {}} {
    whole_.meter = std::make_shared<const ErrorMeter>(whole_.fit);
    Determined determined = OnlyDetermined(material);
    determined_ = std::make_unique<Subject>(
        Subject{FittedBrdf(std::move(determined.material)), whole_.meter, std::move(determined.left_out)});
    if (whole_.fit.IsRgbOrGrey()) return;
    try {
      MakeRgb(RgbMapOf(whole_.fit));
    } catch (const UsageError& error) {
      no_rgb_ = error.what();
    }
  }

  const Subject& For(const Target& target) const {
    if (NeedsRgb(target) && rgb_) return *rgb_;
    return std::string_view(target.name) == "json" ? whole_ : *determined_;
  }
  std::string Refusal(const Target& target) const {
    if (NeedsRgb(target) && !rgb_) return no_rgb_;
    return target.refusal == nullptr ? "" : target.refusal(For(target).fit);
  }
  const Subject& whole() const { return whole_; }

 private:
  bool NeedsRgb(const Target& target) const {
    if (whole_.fit.IsRgbOrGrey()) return false;
    return target.rgb_only || (target.by_wavelength && whole_.fit.channels().wavelengths_nm.empty());
  }

  // The error is that against the fit's own R, G, B.
  void MakeRgb(const ChannelMap& map) {
    const FittedBrdf& fit = whole_.fit;
    const auto meter =
        std::make_shared<const ErrorMeter>(Apply(map, fit.function(), fit.material().channels.size()), map.channels,
                                           fit.reflectance().lobe_shapes(), fit.material().source.file);
    rgb_ = std::make_unique<Subject>(Subject{FittedBrdf(RgbFit(determined_->fit, map)), meter, determined_->changes});
    rgb_->changes.push_back({Feature::kChannels, Carries::kApproximately, map.description});
  }

  Subject whole_;
  std::unique_ptr<Subject> determined_, rgb_;
  std::string no_rgb_;
};

std::vector<std::string> Header(const Material& material, const ExportOptions& options, const ExportResult& result,
                                const std::vector<std::string>& remarks) {
  std::string fit_error;
  for (const MetricError& error : material.errors) fit_error += fmt::format("  {} {:.3g}", error.metric, error.rms);
  std::vector<std::string> lines = {
      fmt::format("{}: exported by lobefit {} from {}", options.name, Version(), options.material_file),
      fmt::format("measurement: {}", material.source.file),
      fmt::format("error of the fit (root mean square):{}", fit_error), fmt::format("command: {}", options.command)};
  lines.insert(lines.end(), remarks.begin(), remarks.end());
  if (result.numbers == "copied" || result.numbers == "refitted") {
    lines.push_back(fmt::format("numbers {}; error of this material relative to the fit's f_r: {}", result.numbers,
                                ErrorWords(result.error)));
  }
  AddLosses(result.carries, &lines);
  return lines;
}

// What counts is the file: it is read back where it can be.
void Complete(const WrittenFiles& written, const ErrorMeter& meter, Clock::time_point start, ExportResult* result) {
  result->error = {};
  result->error.albedo = std::numeric_limits<double>::quiet_NaN();
  if (written.brdf) result->error = meter.Compare(written.brdf);
  result->files = written.files;
  result->notes = written.notes;
  for (const std::filesystem::path& file : result->files) result->bytes += std::filesystem::file_size(file);
  result->seconds = std::chrono::duration<double>(Clock::now() - start).count();
}

// Chooses between the fit's numbers and those of the target's own model fitted to it; fills numbers, choice and errors.
std::optional<FittedBrdf> ChooseNumbers(const Target& target, const Subject& subject, const ExportOptions& options,
                                        ExportResult* result) {
  result->numbers = "copied";
  result->error = subject.meter->Compare(target.evaluate(subject.fit));
  if (options.numbers == Numbers::kCopied) {
    result->choice = "as asked";
    return std::nullopt;
  }
  std::optional<FittedBrdf> refitted =
      Refit(subject.fit, target.own_model(subject.fit), *subject.meter, options.threads);
  if (!refitted) return std::nullopt;
  const ExportError error = subject.meter->Compare(target.evaluate(*refitted));
  const bool better = IsBetter(error, result->error), worse = IsBetter(result->error, error);
  if (options.numbers == Numbers::kRefitted || better) {
    result->choice = better ? "which is nearer" : worse ? "as asked, though not nearer" : "as asked, and as near";
    result->other = result->error;
    result->error = error;
    result->numbers = "refitted";
    return refitted;
  }
  result->choice = worse ? "which is nearer" : "which is as near";
  result->other = error;
  return std::nullopt;
}

// What was refitted is not carried unchanged, and may have fewer lobes and no coat; what was left out or converted
// before says so.
void CompleteRows(const Subject& subject, const std::vector<Carried>* refitted, std::vector<Carried>* rows) {
  for (const Feature feature : {Feature::kSecondLobe, Feature::kCoat}) {
    if (refitted == nullptr) break;
    const bool has =
        std::any_of(refitted->begin(), refitted->end(), [&](const Carried& r) { return r.feature == feature; });
    if (!has) Mark(rows, feature, Carries::kNot, "what was fitted has none");
  }
  for (Carried& row : *rows) {
    if (refitted != nullptr && row.how == Carries::kExactly && row.feature != Feature::kChannels) {
      row = {row.feature, Carries::kApproximately, "refitted"};
    }
  }
  for (const Carried& change : subject.changes) {
    if (change.feature == Feature::kChannels) {
      Mark(rows, change.feature, change.how, change.note);
    } else {
      rows->push_back(change);
    }
  }
}

ExportResult ExportTo(const Target& target, const Subject& subject, const ExportOptions& options,
                      const std::vector<std::string>& remarks) {
  const auto start = Clock::now();
  ExportResult result;
  result.target = &target;
  result.load = LoadText(target, options.name);
  std::optional<FittedBrdf> refitted;
  if (target.evaluate != nullptr) refitted = ChooseNumbers(target, subject, options, &result);
  const FittedBrdf& fit = refitted ? *refitted : subject.fit;
  result.carries = target.carries(subject.fit);
  const std::vector<Carried> of_refitted = refitted ? target.carries(*refitted) : std::vector<Carried>();
  CompleteRows(subject, refitted ? &of_refitted : nullptr, &result.carries);
  WrittenFiles written =
      target.write(fit, {options.folder, options.name, Header(subject.fit.material(), options, result, remarks),
                         options.map_path, options.old_mitsuba});
  if (target.evaluate == nullptr) result.numbers = written.exact ? "exact" : "tabulated";
  // A text that is not read back is the model: what was left out or converted before is its error.
  if (!written.brdf && !subject.changes.empty()) written.brdf = fit.function();
  Complete(written, *subject.meter, start, &result);
  return result;
}

ExportResult ExportSelTo(const Target& target, const Material& material, const ErrorMeter& meter,
                         const ExportOptions& options, const std::vector<std::string>& remarks) {
  const auto start = Clock::now();
  ExportResult result;
  result.target = &target;
  result.load = LoadText(target, options.name);
  result.carries = CarriesSel(material);
  result.numbers = "exact";
  Complete(target.write_sel(material, {options.folder, options.name, Header(material, options, result, remarks),
                                       options.map_path, options.old_mitsuba}),
           meter, start, &result);
  return result;
}

std::vector<std::string> EnergyRemarks(const ErrorMeter& meter) {
  const ErrorMeter::LargestAlbedo& largest = meter.largest_albedo();
  if (largest.albedo <= kWorthARemark) return {};
  return {
      fmt::format("the material reflects more than it receives: an albedo of {:.3f} in {}, seen at {:.0f} degrees from "
                  "the normal; renderers gain light from it",
                  largest.albedo, largest.channel, largest.theta_deg)};
}

// Splits the targets by `reason_of`; throws where none is left.
std::vector<const Target*> Accepted(const ExportOptions& options,
                                    const std::function<std::string(const Target&)>& reason_of,
                                    std::vector<Refusal>* refusals) {
  std::vector<const Target*> accepted;
  for (const Target* target : options.targets) {
    const std::string reason = reason_of(*target);
    if (reason.empty()) {
      accepted.push_back(target);
    } else {
      refusals->push_back({target, reason});
    }
  }
  if (!accepted.empty()) return accepted;
  std::vector<std::string> can;
  for (const Target& target : ExportTargets()) {
    if (reason_of(target).empty()) can.emplace_back(target.name);
  }
  throw InputError(
      fmt::format("{}: {}; targets that can: {}", options.material_file, RefusalText(*refusals), Join(can)));
}

void ExportAll(const std::vector<const Target*>& targets, const ExportOptions& options,
               const std::function<ExportResult(const Target&)>& export_to, ExportOutcome* outcome) {
  MakeFolder(options.folder);
  Progress progress("exporting", targets.size());
  for (const Target* target : targets) {
    outcome->results.push_back(export_to(*target));
    progress.Advance();
  }
}

ExportOutcome ExportSel(const Material& material, const ExportOptions& options) {
  ExportOutcome outcome;
  const auto reason_of = [](const Target& target) -> std::string {
    if (target.write_sel != nullptr) return "";
    return "it takes a model of the surface, and this is a table of squared ellipsoidal lobes for each incident "
           "direction";
  };
  const std::vector<const Target*> targets = Accepted(options, reason_of, &outcome.refusals);
  const ErrorMeter meter = SelErrorMeter(material);
  outcome.remarks = EnergyRemarks(meter);
  ExportAll(
      targets, options,
      [&](const Target& target) { return ExportSelTo(target, material, meter, options, outcome.remarks); }, &outcome);
  return outcome;
}

ExportOutcome ExportModel(const Material& material, const ExportOptions& options) {
  ExportOutcome outcome;
  const Subjects subjects(material);
  const std::vector<const Target*> targets = Accepted(
      options, [&](const Target& target) { return subjects.Refusal(target); }, &outcome.refusals);
  outcome.remarks = EnergyRemarks(*subjects.whole().meter);
  ExportAll(
      targets, options,
      [&](const Target& target) { return ExportTo(target, subjects.For(target), options, outcome.remarks); }, &outcome);
  return outcome;
}

}  // namespace

std::string LoadText(const Target& target, const std::string& name) {
  std::string text = Replaced(target.load, "{glsl}", GlslPrefix(name));
  text = Replaced(std::move(text), "{id}", Identifier(name));
  return Replaced(std::move(text), "{name}", name);
}

ExportOutcome ExportMaterial(const Material& material, const ExportOptions& options) {
  ExportOutcome outcome = material.sel ? ExportSel(material, options) : ExportModel(material, options);
  WriteFileAtomically(options.folder / (options.name + ".export.json"), ExportJson(material, options, outcome));
  return outcome;
}

}  // namespace lobefit

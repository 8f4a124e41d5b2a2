#include "lobefit/report/comparison/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/plot/layout.h"
#include "lobefit/plot/png.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/panels/page.h"

namespace lobefit {
namespace {

// Told apart with any colour vision, and by lightness in grey.
constexpr std::array<Rgb, kMostCompared> kModelColors = {style::kVermilion, style::kBlue,   style::kGreen,
                                                         style::kOrange,    style::kPurple, style::kInk};

constexpr std::array<std::optional<Panel> (*)(const Compared&), 4> kMakers = {
    ComparedErrorsPanel, ComparedCurvesPanel, ComparedRatiosPanel, ComparedSpheresPanel};

}  // namespace

void WriteComparisonPng(const std::vector<ComparedModel>& models, const Measurement& measurement,
                        const std::filesystem::path& path, const ReportOptions& options) {
  if (models.empty()) throw InputError(measurement.source + ": there is no model to compare");
  Compared compared;
  compared.threads = options.threads;
  const std::size_t count = std::min(models.size(), kMostCompared);
  for (std::size_t k = 0; k < count; ++k) {
    compared.models.push_back({std::make_unique<ReportData>(*models[k].material, measurement, options.threads),
                               models[k].label, models[k].note, kModelColors[k]});
  }
  std::array<std::optional<Panel>, kMakers.size()> made;
  ParallelFor(made.size(), options.threads, [&](std::size_t k) { made[k] = kMakers[k](compared); });
  std::vector<Panel> panels;
  for (std::optional<Panel>& panel : made) {
    if (panel) panels.push_back(std::move(*panel));
  }
  const std::string more =
      models.size() > count ? "the best " + std::to_string(count) + " of " + std::to_string(models.size()) + " models"
                            : std::to_string(count) + (count == 1 ? " model" : " models") + " on the same samples";
  const Canvas canvas =
      DrawStackedPage(measurement.source, more, panels, options.scale, std::make_shared<Fonts>(options.font_folders));
  WritePng(canvas.pixels(), 96 * options.scale, path, options.threads);
}

}  // namespace lobefit

// The errors of the compared models on all samples, one row a model.
#include <algorithm>
#include <map>

#include "lobefit/base/text/text.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/panels/page.h"

namespace lobefit {
namespace {

std::size_t FreeValues(const Material& material) {
  std::size_t free = 0;
  for (const FittedParameter& parameter : material.parameters) free += parameter.free ? parameter.values.size() : 0;
  // Of each lobe its shape, and an amplitude a channel; the constants.
  for (const SelSlice& slice : material.sel ? material.sel->slices : std::vector<SelSlice>()) {
    free += 5 * slice.lobes.size() + (slice.lobes.size() + 1) * slice.constant.size();
  }
  return free;
}

constexpr double kRow = 40, kHead = 22;

void DrawErrors(const Compared& compared, Canvas* canvas, const Box& content) {
  std::vector<std::string> metrics;
  for (const MetricError& error : compared.first().material.errors) metrics.push_back(error.metric);
  const double name_width = content.width * 0.5, free_width = 70;
  const double column =
      (content.width - name_width - free_width) / std::max<double>(1, static_cast<double>(metrics.size()));
  const auto right_of = [&](std::size_t k) {
    return content.x + name_width + free_width + column * static_cast<double>(k + 1);
  };
  canvas->Text({content.x + name_width + free_width, content.y + 12}, "free",
               style::Note(style::kSecondary, Align::kRight));
  for (std::size_t k = 0; k < metrics.size(); ++k)
    canvas->Text({right_of(k), content.y + 12}, "rms, " + metrics[k], style::Note(style::kSecondary, Align::kRight));
  std::map<std::string, double> least;
  const auto find = [](const Material& material, const std::string& metric) {
    for (const MetricError& error : material.errors) {
      if (error.metric == metric) return error.rms;
    }
    return std::nan("");
  };
  for (const std::string& metric : metrics) {
    least[metric] = std::nan("");
    for (const Compared::Entry& entry : compared.models)
      least[metric] = std::fmin(least[metric], find(entry.data->material, metric));
  }
  double y = content.y + kHead;
  for (const Compared::Entry& entry : compared.models) {
    const Material& material = entry.data->material;
    canvas->Line({content.x, y}, {content.right(), y}, {style::kRule, 1});
    canvas->Fill({content.x, y + 7, 18, 5}, entry.color);
    TextStyle name = style::Body();
    name.weight = Weight::kBold;
    canvas->Text({content.x + 28, y + 15}, canvas->Shorten(entry.label, name, name_width - 40), name);
    std::vector<std::string> words;
    if (!entry.note.empty()) words.push_back(entry.note);
    if (!material.termination.converged) words.emplace_back("not converged");
    words.push_back(ModelWords(material.model));
    canvas->Text({content.x + 28, y + 31}, canvas->Shorten(Join(words, "  ·  "), style::Note(), name_width - 40),
                 style::Note());
    canvas->Text({content.x + name_width + free_width, y + 15}, std::to_string(FreeValues(material)),
                 style::Body(style::kInk, Align::kRight));
    for (std::size_t k = 0; k < metrics.size(); ++k) {
      const double rms = find(material, metrics[k]);
      if (std::isnan(rms)) continue;
      TextStyle text = style::Body(style::kInk, Align::kRight);
      text.markup = true;
      if (rms <= least[metrics[k]]) text.weight = Weight::kBold;
      canvas->Text({right_of(k), y + 15}, Number(rms, 3), text);
    }
    y += kRow;
  }
}

}  // namespace

std::optional<Panel> ComparedErrorsPanel(const Compared& compared) {
  Panel panel;
  panel.id = "errors";
  panel.title = "Root mean square error on all samples; the least of each column is bold";
  panel.height = [&compared](Canvas*, double) { return kHead + kRow * static_cast<double>(compared.models.size()); };
  panel.draw = [&compared](Canvas* canvas, const Box& content) { DrawErrors(compared, canvas, content); };
  return panel;
}

}  // namespace lobefit

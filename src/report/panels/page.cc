#include "lobefit/report/panels/page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lobefit/base/process/parallel.h"
#include "lobefit/material/badge.h"
#include "lobefit/plot/layout.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

constexpr double kPageWidth = 1320, kMargin = 36, kGap = 28, kPanelHead = 34, kHeader = 92;

// From the right; what would run into the title, which ends at `left`, is left out.
void DrawLegend(Canvas* canvas, const std::vector<LegendEntry>& legend, double left, double right, double y) {
  double x = right;
  for (auto entry = legend.rbegin(); entry != legend.rend(); ++entry) {
    TextStyle text = style::Note();
    text.markup = true;
    const double text_width = canvas->TextWidth(entry->text, text);
    if (x - text_width - 24 < left) return;
    x -= text_width;
    canvas->Text({x, y}, entry->text, text);
    const double middle = y - 4;
    switch (entry->mark) {
      case LegendEntry::Mark::kNone:
        break;
      case LegendEntry::Mark::kDot:
        x -= 10;
        canvas->Disc({x + 3, middle}, 2.5, entry->color, 0.85);
        break;
      case LegendEntry::Mark::kLine:
        x -= 24;
        canvas->Line({x, middle}, {x + 18, middle}, {entry->color, 2});
        break;
      case LegendEntry::Mark::kBand:
        x -= 24;
        canvas->Fill({x, middle - 5, 18, 10}, entry->color, 0.22);
        break;
      case LegendEntry::Mark::kSwatch:
        x -= 15;
        canvas->Disc({x + 5, middle}, 4.5, entry->color);
        break;
    }
    x -= 16;
  }
}

void DrawPanel(Canvas* canvas, const Panel& panel, const Box& box) {
  canvas->Line({box.x, box.y}, {box.right(), box.y}, {style::kInk, 1});
  const TextStyle title = {
      .size = style::kPanelTitleSize, .color = style::kInk, .weight = Weight::kBold, .markup = true};
  canvas->Text({box.x, box.y + 21}, panel.title, title);
  DrawLegend(canvas, panel.legend, box.x + canvas->TextWidth(panel.title, title) + 16, box.right(), box.y + 20);
  panel.draw(canvas, Inset(box, 0, kPanelHead, 0, 0));
}

void DrawHeader(Canvas* canvas, const ReportData& data) {
  const Material& material = data.material;
  const Termination& end = material.termination;
  const double right = kPageWidth - kMargin;
  // The verdict first, so that the title knows its room.
  const auto [mark, verdict] = BadgeOf(material);
  const Rgb color = mark == BadgeMark::kGood ? style::kGreen : mark == BadgeMark::kRough ? style::kAmber : style::kRed;
  TextStyle chip = {
      .size = style::kBodySize, .color = {255, 255, 255}, .weight = Weight::kBold, .baseline = Baseline::kMiddle};
  const double chip_width = canvas->TextWidth(verdict, chip) + 24;
  canvas->Fill({right - chip_width, kMargin, chip_width, 25}, color);
  canvas->Text({right - chip_width + 12, kMargin + 12.5}, verdict, chip);
  const std::string after = std::to_string(end.iterations) + " iterations";
  canvas->Text({right, kMargin + 47}, after, style::Note(style::kSecondary, Align::kRight));

  const TextStyle title = {.size = style::kTitleSize, .color = style::kInk, .weight = Weight::kBold};
  const std::string file = material.source.file.empty() ? data.measurement.source : material.source.file;
  const std::string name = file.empty() ? "Measurement" : std::filesystem::path(file).filename().string();
  canvas->Text({kMargin, kMargin + 21}, canvas->Shorten(name, title, right - kMargin - chip_width - 30, true), title);
  const TextStyle sub = {.size = 13, .color = style::kSecondary};
  canvas->Text(
      {kMargin, kMargin + 47},
      canvas->Shorten(ModelWords(material.model), sub, right - kMargin - canvas->TextWidth(after, style::Note()) - 30),
      sub);
}

std::vector<std::string> FooterParts(const ReportData& data) {
  const Material& m = data.material;
  std::vector<std::string> parts;
  const auto add = [&parts](const std::string& label, const std::string& value) {
    if (!value.empty()) parts.push_back(label + " " + value);
  };
  add("format", m.source.format.empty() ? data.measurement.format : m.source.format);
  add("SHA-256", (m.source.sha256.empty() ? data.measurement.sha256 : m.source.sha256).substr(0, 16));
  add("recipe", m.recipe_name);
  add("metric", m.metric);
  add("weighting", m.weighting);
  add("loss", m.loss);
  if (m.theta_max_deg < 90) add("angle limit", Number(m.theta_max_deg, 3) + "°");
  for (const auto& [key, value] : m.source.conventions) add(key, value);
  return parts;
}

// Draws the foot from y, or measures it; returns the y under it.
double DrawFooter(Canvas* canvas, const ReportData& data, double y, bool draw) {
  const double width = kPageWidth - 2 * kMargin;
  std::vector<std::string> lines(1);
  for (const std::string& part : FooterParts(data)) {
    const std::string longer = lines.back().empty() ? part : lines.back() + "   ·   " + part;
    if (canvas->TextWidth(longer, style::Note()) > width && !lines.back().empty()) {
      lines.push_back(part);
    } else {
      lines.back() = longer;
    }
  }
  if (!data.material.recipe_reason.empty()) {
    for (const std::string& line : canvas->Wrap("Recipe: " + data.material.recipe_reason, style::Note(), width))
      lines.push_back(line);
  }
  if (draw) canvas->Line({kMargin, y}, {kPageWidth - kMargin, y}, {style::kRule, 1});
  y += 4;
  for (const std::string& line : lines) {
    y += 17;
    if (draw) canvas->Text({kMargin, y}, canvas->Shorten(line, style::Note(), width), style::Note());
  }
  return y + 6;
}

}  // namespace

std::string ModelWords(const Model& model) {
  // A model without any part stands where a table of lobes was fitted.
  std::string words;
  if (model.lobes.empty() && model.diffuse == Diffuse::kNone)
    return "squared ellipsoidal lobes for each incident direction";
  for (const Lobe& lobe : model.lobes) {
    if (!words.empty()) words += "  +  ";
    if (IsCoat(lobe.fresnel)) words += "coat over the others, ";
    if (lobe.direction == LobeDirection::kRetro) words += "about the back direction, ";
    words += Find(NdfChoices(), NameOf(NdfChoices(), lobe.ndf))->description;
  }
  if (!model.lobes.empty()) {
    words += std::string("  ·  masking ") + NameOf(MaskingChoices(), model.lobes[0].masking) + "  ·  Fresnel " +
             NameOf(FresnelChoices(), model.lobes[0].fresnel);
  }
  if (model.diffuse != Diffuse::kNone) words += std::string("  ·  diffuse ") + NameOf(DiffuseChoices(), model.diffuse);
  return words;
}

Canvas DrawPage(const ReportData& data, double scale, const std::shared_ptr<Fonts>& fonts,
                std::vector<std::string>* ids) {
  const std::vector<Panel> panels = MakePanels(data);
  if (ids != nullptr) {
    for (const Panel& panel : panels) ids->push_back(panel.id);
  }
  return DrawPage(data, panels, scale, fonts);
}

Canvas DrawPage(const ReportData& data, const std::vector<Panel>& panels, double scale,
                const std::shared_ptr<Fonts>& fonts) {
  const double width = kPageWidth - 2 * kMargin;
  Canvas ruler(1, 1, scale, fonts);
  std::vector<PanelSize> sizes;
  for (const Panel& panel : panels) {
    sizes.push_back(
        {panel.wide, [&panel, &ruler](double w) { return kPanelHead + panel.height(&ruler, w); }, panel.grows});
  }
  const PageLayout layout = ArrangePanels(sizes, kMargin, kHeader + kMargin / 2, width, kGap);
  const double foot = layout.height + kGap;
  Canvas canvas(kPageWidth, std::ceil(DrawFooter(&ruler, data, foot, false) + kMargin / 2), scale, fonts);
  DrawHeader(&canvas, data);
  // Half of the gap around a panel is its own: what it draws over its edge meets no other panel.
  ParallelFor(panels.size(), data.threads, [&](std::size_t i) {
    Canvas part = canvas.Part(Inset(layout.boxes[i], -kGap / 2, -kGap / 2, -kGap / 2, -kGap / 2));
    DrawPanel(&part, panels[i], layout.boxes[i]);
  });
  DrawFooter(&canvas, data, foot, true);
  return canvas;
}

Canvas DrawStackedPage(const std::string& title, const std::string& subtitle, const std::vector<Panel>& panels,
                       double scale, const std::shared_ptr<Fonts>& fonts) {
  const double width = kPageWidth - 2 * kMargin;
  Canvas ruler(1, 1, scale, fonts);
  double bottom = kHeader + kMargin / 2;
  std::vector<Box> boxes;
  for (const Panel& panel : panels) {
    boxes.push_back({kMargin, bottom, width, kPanelHead + panel.height(&ruler, width)});
    bottom = boxes.back().bottom() + kGap;
  }
  Canvas canvas(kPageWidth, std::ceil(bottom), scale, fonts);
  const TextStyle head = {.size = style::kTitleSize, .color = style::kInk, .weight = Weight::kBold};
  canvas.Text({kMargin, kMargin + 21}, canvas.Shorten(title, head, width, true), head);
  const TextStyle sub = {.size = 13, .color = style::kSecondary};
  canvas.Text({kMargin, kMargin + 47}, canvas.Shorten(subtitle, sub, width), sub);
  for (std::size_t i = 0; i < panels.size(); ++i) DrawPanel(&canvas, panels[i], boxes[i]);
  return canvas;
}

Canvas DrawPanelAlone(const Panel& panel, double width, double scale, const std::shared_ptr<Fonts>& fonts) {
  Canvas ruler(1, 1, scale, fonts);
  const double margin = 12, height = kPanelHead + panel.height(&ruler, width - 2 * margin) + 2 * margin;
  Canvas canvas(width, std::ceil(height), scale, fonts);
  DrawPanel(&canvas, panel, {margin, margin, width - 2 * margin, height - 2 * margin});
  return canvas;
}

}  // namespace lobefit

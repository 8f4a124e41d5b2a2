// A panel is one figure or table of a report. Each is made in a source file of its own, from the data; a maker returns
// nothing where the measurement cannot fill it, and the layout closes the gap.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/plot/canvas.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/figures/report_data.h"

namespace lobefit {

struct LegendEntry {
  enum class Mark { kNone, kDot, kLine, kBand, kSwatch };
  Mark mark = Mark::kDot;
  Rgb color;
  std::string text;
};

struct Panel {
  std::string id;  // stable name, for tests and anchors
  std::string title;
  std::vector<LegendEntry> legend;  // right of the title
  bool wide = true;                 // two thirds of the page; else one third
  bool grows = false;               // draws more where it is given more height
  // Height of the content for a width, page units; the layout may give more.
  std::function<double(Canvas*, double width)> height;
  std::function<void(Canvas*, const Box& content)> draw;
  std::vector<NamedField> fields;  // the numbers behind its pictures
};

using PanelMaker = std::optional<Panel> (*)(const ReportData& data);

std::optional<Panel> CurvesPanel(const ReportData& data);
std::optional<Panel> ParametersPanel(const ReportData& data);
std::optional<Panel> LobesPanel(const ReportData& data);
std::optional<Panel> MapsPanel(const ReportData& data);
std::optional<Panel> QualityPanel(const ReportData& data);
std::optional<Panel> BurleyPanel(const ReportData& data);
std::optional<Panel> SpherePanel(const ReportData& data);
std::optional<Panel> NdfPanel(const ReportData& data);
std::optional<Panel> ProfilePanel(const ReportData& data);
std::optional<Panel> FresnelPanel(const ReportData& data);
std::optional<Panel> ResidualsPanel(const ReportData& data);
std::optional<Panel> EnergyPanel(const ReportData& data);
std::optional<Panel> InstrumentPanel(const ReportData& data);
std::optional<Panel> CorrelationPanel(const ReportData& data);

// In the order of the page.
const std::vector<PanelMaker>& PanelMakers();
// Those that the measurement can fill, in that order.
std::vector<Panel> MakePanels(const ReportData& data);

}  // namespace lobefit

// The page of a report: heading, panels in their layout, and where the numbers come from at the foot.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobefit/plot/canvas.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {

// Ids of the panels that were drawn go to `ids` unless null.
Canvas DrawPage(const ReportData& data, double scale, const std::shared_ptr<Fonts>& fonts,
                std::vector<std::string>* ids = nullptr);
// The same with panels that were made before.
Canvas DrawPage(const ReportData& data, const std::vector<Panel>& panels, double scale,
                const std::shared_ptr<Fonts>& fonts);

// "isotropic GGX · masking ...": the choices of a model on one line.
std::string ModelWords(const Model& model);

// Panels of the whole width one below the other, under a heading of two lines.
Canvas DrawStackedPage(const std::string& title, const std::string& subtitle, const std::vector<Panel>& panels,
                       double scale, const std::shared_ptr<Fonts>& fonts);

// One panel alone, without the page around it, `width` units wide.
Canvas DrawPanelAlone(const Panel& panel, double width, double scale, const std::shared_ptr<Fonts>& fonts);

}  // namespace lobefit

#include "lobefit/report/panels/panel.h"

#include <utility>

#include "lobefit/base/process/parallel.h"

namespace lobefit {

const std::vector<PanelMaker>& PanelMakers() {
  static const std::vector<PanelMaker> makers = {
      CurvesPanel, LobesPanel,   ParametersPanel, QualityPanel,    SpherePanel, EnergyPanel,    MapsPanel,
      NdfPanel,    ProfilePanel, FresnelPanel,    InstrumentPanel, BurleyPanel, ResidualsPanel, CorrelationPanel};
  return makers;
}

std::vector<Panel> MakePanels(const ReportData& data) {
  std::vector<std::optional<Panel>> made(PanelMakers().size());
  ParallelFor(made.size(), data.threads, [&](std::size_t k) { made[k] = PanelMakers()[k](data); });
  std::vector<Panel> panels;
  for (std::optional<Panel>& panel : made) {
    if (panel) panels.push_back(std::move(*panel));
  }
  return panels;
}

}  // namespace lobefit

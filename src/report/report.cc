#include "lobefit/report/report.h"

#include <memory>

#include "lobefit/report/page.h"
#include "lobefit/report/png.h"

namespace lobefit {

const std::vector<PanelMaker>& PanelMakers() {
  static const std::vector<PanelMaker> makers = {CurvesPanel,    ParametersPanel, QualityPanel, SpherePanel,
                                                 EnergyPanel,    MapsPanel,       NdfPanel,     BurleyPanel,
                                                 ResidualsPanel, CorrelationPanel};
  return makers;
}

void WriteReportPng(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                    const ReportOptions& options) {
  const ReportData data(material, measurement, options.threads);
  const Canvas canvas = DrawPage(data, options.scale, std::make_shared<Fonts>(options.font_folders));
  WritePng(canvas.pixels(), 96 * options.scale, path);
}

}  // namespace lobefit

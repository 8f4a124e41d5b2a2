#include "lobefit/report/report.h"

#include <memory>

#include "lobefit/report/exr.h"
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

void WriteReportExr(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                    const ReportOptions& options) {
  const ReportData data(material, measurement, options.threads);
  std::vector<NamedField> fields;
  for (const PanelMaker maker : {MapsPanel, BurleyPanel}) {
    if (const std::optional<Panel> panel = maker(data))
      fields.insert(fields.end(), panel->fields.begin(), panel->fields.end());
  }
  WriteExr(fields, path);
}

}  // namespace lobefit

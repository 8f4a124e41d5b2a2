#include "lobefit/report/report.h"

#include <memory>

#include "lobefit/base/files/file.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/exr.h"
#include "lobefit/report/panels/page.h"
#include "lobefit/report/web/html.h"

namespace lobefit {

void WriteReport(const Material& material, const Measurement& measurement, const ReportPaths& paths,
                 const ReportOptions& options) {
  const ReportData data(material, measurement, options.threads);
  const std::vector<Panel> panels = MakePanels(data);
  const auto fonts = std::make_shared<Fonts>(options.font_folders);
  if (!paths.png.empty())
    WritePng(DrawPage(data, panels, options.scale, fonts).pixels(), 96 * options.scale, paths.png, options.threads);
  if (!paths.html.empty()) WriteFileAtomically(paths.html, ReportHtml(data, panels, fonts));
  if (paths.exr.empty()) return;
  std::vector<NamedField> fields;
  for (const Panel& panel : panels) fields.insert(fields.end(), panel.fields.begin(), panel.fields.end());
  WriteExr(fields, paths.exr);
}

void WriteReportPng(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                    const ReportOptions& options) {
  WriteReport(material, measurement, {path, {}, {}}, options);
}

void WriteReportHtml(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                     const ReportOptions& options) {
  WriteReport(material, measurement, {{}, path, {}}, options);
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

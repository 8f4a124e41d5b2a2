#include "lobefit/report/report.h"

#include <memory>

#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/exr.h"
#include "lobefit/report/panels/page.h"
#include "lobefit/report/web/html.h"

namespace lobefit {

void WriteReport(const Material& material, const Measurement& measurement, const ReportPaths& paths,
                 const ReportOptions& options) {
  const ReportData data(material, measurement, options.threads);
  const std::vector<Panel> panels = MakePanels(data);
  // Picture and page at the same time, each with fonts of its own, which are no shared state.
  std::string png, html;
  const std::size_t first = paths.png.empty() ? 1 : 0, last = paths.html.empty() ? 1 : 2;
  ParallelFor(last > first ? last - first : 0, options.threads, [&](std::size_t task) {
    const auto fonts = std::make_shared<Fonts>(options.font_folders);
    if (first + task == 0) {
      png = EncodePng(DrawPage(data, panels, options.scale, fonts).pixels(), 96 * options.scale);
    } else {
      html = ReportHtml(data, panels, fonts);
    }
  });
  if (!paths.png.empty()) WriteFileAtomically(paths.png, png);
  if (!paths.html.empty()) WriteFileAtomically(paths.html, html);
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

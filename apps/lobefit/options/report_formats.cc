#include "options/report_formats.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

std::vector<std::string> ReportFormats() { return {"png", "html", "exr"}; }

std::vector<std::string> ParseReportFormats(const std::string& text) {
  const std::vector<std::string> allowed = ReportFormats();
  std::vector<std::string> formats;
  for (const std::string_view field : Split(text, ',')) {
    const std::string format(Trim(field));
    if (std::find(allowed.begin(), allowed.end(), format) == allowed.end()) {
      throw UsageError(fmt::format("--format '{}' is unknown{}; allowed: {}", Excerpt(format),
                                   DidYouMean(format, allowed), Join(allowed)));
    }
    formats.push_back(format);
  }
  return formats;
}

namespace {

ReportPaths PathsOf(const std::vector<std::string>& formats, const std::filesystem::path& picture) {
  ReportPaths paths;
  for (const std::string& format : formats) {
    std::filesystem::path path = picture;
    path.replace_extension(format);
    (format == "png" ? paths.png : format == "html" ? paths.html : paths.exr) = path;
  }
  return paths;
}

}  // namespace

void CheckReports(const std::vector<std::string>& formats, const std::filesystem::path& picture,
                  const std::vector<std::filesystem::path>& inputs) {
  const ReportPaths paths = PathsOf(formats, picture);
  for (const std::filesystem::path& path : {paths.png, paths.html, paths.exr}) {
    if (!path.empty()) CheckOutput(path, inputs);
  }
}

std::string WriteReports(const std::vector<std::string>& formats, const Material& material,
                         const Measurement& measurement, const std::filesystem::path& picture,
                         const ReportOptions& options) {
  const ReportPaths paths = PathsOf(formats, picture);
  WriteReport(material, measurement, paths, options);
  std::string lines;
  if (!paths.png.empty()) lines += fmt::format("Picture: {}\n", PrintableName(paths.png));
  if (!paths.html.empty()) lines += fmt::format("Page:    {}\n", PrintableName(paths.html));
  if (!paths.exr.empty()) lines += fmt::format("Maps:    {}\n", PrintableName(paths.exr));
  return lines;
}

}  // namespace lobefit

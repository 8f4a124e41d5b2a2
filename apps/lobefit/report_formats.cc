#include "report_formats.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"

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

std::string WriteReports(const std::vector<std::string>& formats, const Material& material,
                         const Measurement& measurement, const std::filesystem::path& picture,
                         const ReportOptions& options) {
  ReportPaths paths;
  std::string lines;
  for (const std::string& format : formats) {
    std::filesystem::path path = picture;
    path.replace_extension(format);
    (format == "png" ? paths.png : format == "html" ? paths.html : paths.exr) = path;
    lines += fmt::format("{} {}\n",
                         format == "png"    ? "Picture:"
                         : format == "html" ? "Page:   "
                                            : "Maps:   ",
                         path.string());
  }
  WriteReport(material, measurement, paths, options);
  return lines;
}

}  // namespace lobefit

#include "report_formats.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"

namespace lobefit {

std::vector<std::string> ParseReportFormats(const std::string& text) {
  const std::vector<std::string> allowed = {"png", "html"};
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
  std::string lines;
  for (const std::string& format : formats) {
    if (format == "png") {
      WriteReportPng(material, measurement, picture, options);
      lines += fmt::format("Picture: {}\n", picture.string());
    } else {
      std::filesystem::path page = picture;
      page.replace_extension(".html");
      WriteReportHtml(material, measurement, page, options);
      lines += fmt::format("Page:    {}\n", page.string());
    }
  }
  return lines;
}

}  // namespace lobefit

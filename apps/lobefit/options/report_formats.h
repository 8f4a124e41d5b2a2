// The formats of a report: which files a verb writes for one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/report/report.h"

namespace lobefit {

// Every format; each is the extension of its file too.
std::vector<std::string> ReportFormats();

// "png,html" as a list. Throws UsageError that lists the formats.
std::vector<std::string> ParseReportFormats(const std::string& text);

// CheckOutput for each file that WriteReports would write.
void CheckReports(const std::vector<std::string>& formats, const std::filesystem::path& picture,
                  const std::vector<std::filesystem::path>& inputs);

// Writes `picture` with the extension of each format. Returns lines for people that name the files.
std::string WriteReports(const std::vector<std::string>& formats, const Material& material,
                         const Measurement& measurement, const std::filesystem::path& picture,
                         const ReportOptions& options);

}  // namespace lobefit

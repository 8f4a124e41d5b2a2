// Pictures by which a fit is judged: NAME.report.png and NAME.report.html.
#pragma once

#include <filesystem>

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/report/figures/report_options.h"
#include "lobefit/report/web/html.h"

namespace lobefit {

// Where a report is to be written; an empty path is left out.
struct ReportPaths {
  std::filesystem::path png, html, exr;
};

// Several formats at once, which share what is computed for them. Throws as the functions below; what comes before the
// failing one in the order png, html, exr is written.
void WriteReport(const Material& material, const Measurement& measurement, const ReportPaths& paths,
                 const ReportOptions& options = {});

// Draws `material` against the measurement that it was fitted to, as a PNG. Panels that the measurement cannot fill are
// left out. Throws InputError where the channels of the two differ or there are fewer than two samples, OutputError
// where the file cannot be written.
void WriteReportPng(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                    const ReportOptions& options = {});

// The float maps behind the pictures as OpenEXR, one part a map; throws OutputError too where the measurement fills no
// map.
void WriteReportExr(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                    const ReportOptions& options = {});

// The same content as one self-contained page, under 3 MB, with live spheres (WebGL 2), slices and parameters; needs no
// network. The page tests itself when it is opened with "#selftest". Throws as above.
void WriteReportHtml(const Material& material, const Measurement& measurement, const std::filesystem::path& path,
                     const ReportOptions& options = {});

}  // namespace lobefit

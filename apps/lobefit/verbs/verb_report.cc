// lobefit report: draws a fitted material against its measurement again.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "options/measurement_options.h"
#include "options/report_formats.h"
#include "tasks/stack_report.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/series.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"
#include "lobefit/report/report.h"

namespace lobefit {
namespace {

struct ReportVerb {
  MeasurementOptions measurement;
  std::vector<std::string> files;
  std::string material, out, format, encoding;
  double scale = 2;
};

// The picture's file: --out, a name in the folder --out, or beside the material.
std::filesystem::path PictureOf(const ReportVerb& verb) {
  std::string name = std::filesystem::path(verb.material).filename().string();
  for (const std::string_view ending : {".material.json", ".exr"}) {
    if (name.size() > ending.size() && name.ends_with(ending)) name.resize(name.size() - ending.size());
  }
  name += ".report.png";
  if (verb.out.empty()) return std::filesystem::path(verb.material).parent_path() / name;
  std::filesystem::path out = verb.out;
  if (std::filesystem::is_directory(out)) return out / name;
  const std::vector<std::string> formats = ReportFormats();
  const std::string extension = out.extension().string();
  if (extension.empty() || std::find(formats.begin(), formats.end(), extension.substr(1)) == formats.end()) {
    throw UsageError(fmt::format("--out '{}' is neither a folder nor the name of a picture; end it in .{}", verb.out,
                                 Join(formats, ", .")));
  }
  return out;
}

// --format, or what the name in --out ends in.
std::vector<std::string> FormatsOf(const ReportVerb& verb, const std::filesystem::path& picture) {
  return ParseReportFormats(verb.format.empty() ? picture.extension().string().substr(1) : verb.format);
}

int RunReport(const ReportVerb& verb, const CommonOptions& common) {
  const std::filesystem::path picture = PictureOf(verb);
  const std::vector<std::string> formats = FormatsOf(verb, picture);
  if (verb.material.ends_with(".maps.exr")) {
    if (verb.files.size() != 1) throw UsageError("maps are drawn against one image stack");
    return ReportMaps(verb.material, verb.files[0], {verb.encoding}, formats, picture, verb.scale);
  }
  std::vector<std::filesystem::path> inputs = InputPaths(verb.files);
  inputs.emplace_back(verb.material);
  CheckReports(formats, picture, inputs);
  const Material material = ReadMaterial(verb.material);
  Measurement measurement = verb.measurement.Load(verb.files);
  // The picture shows what was fitted.
  Selection limit;
  limit.theta_max = DegreesToRadians(material.theta_max_deg);
  Apply(limit, &measurement);
  ReportOptions options;
  options.threads = common.Threads();
  options.scale = verb.scale;
  Print(WriteReports(formats, material, measurement, picture, options));
  return kExitDone;
}

}  // namespace

std::function<int()> SetUpReport(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<ReportVerb>();
  app->add_option("MATERIAL", verb->material, "a *.material.json, or NAME.maps.exr of `lobefit maps`")->required();
  app->add_option("MEASUREMENT", verb->files,
                  "the measurement that it was fitted to: one file, or several and folders; of maps, the image stack")
      ->required();
  app->add_option("--out", verb->out,
                  "the picture, or the folder for it (default: NAME.report.png beside the material)");
  app->add_option("--format", verb->format,
                  "png, html (live), exr (the maps behind the pictures; not of maps), or several with commas between "
                  "(default: what the name in --out ends in, or png)");
  app->add_option("--scale", verb->scale, "pixels to one unit of the page, which is 1320 units wide (default 2)")
      ->check(CLI::Range(0.25, 4.0));
  app->add_option("--encoding", verb->encoding, "of an image stack: how pixels are stored: linear, srgb, gamma:G");
  verb->measurement.AddTo(app);
  return [=] { return RunReport(*verb, *common); };
}

}  // namespace lobefit

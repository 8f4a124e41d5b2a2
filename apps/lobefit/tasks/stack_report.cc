#include "tasks/stack_report.h"

#include <algorithm>
#include <cmath>

#include "options/report_formats.h"
#include "text/output.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/document.h"
#include "lobefit/maps/report/page.h"
#include "lobefit/maps/report/web/html.h"
#include "lobefit/maps/stack/reader.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double Share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

double MeanPsnr(const std::vector<RelitLight>& lights, bool fitted, std::size_t* count) {
  double sum = 0;
  *count = 0;
  for (const RelitLight& light : lights) {
    if (light.fitted == fitted && std::isfinite(light.psnr)) sum += light.psnr, ++*count;
  }
  return *count == 0 ? kNan : sum / static_cast<double>(*count);
}

}  // namespace

int ReportMaps(const std::filesystem::path& path, const std::filesystem::path& stack_path, const StackOptions& options,
               const std::vector<std::string>& formats, const std::filesystem::path& picture, double scale) {
  if (std::find(formats.begin(), formats.end(), "exr") != formats.end()) {
    throw UsageError("--format exr: maps are an EXR themselves; allowed for them: png, html");
  }
  const Stack stack = OpenStack(stack_path, options);
  std::vector<std::filesystem::path> inputs = stack.images;
  inputs.push_back(path);
  CheckReports(formats, picture, inputs);
  const Maps maps = ReadMapsExr(path);
  const MapsRecord record = ReadMapsRecord(std::filesystem::path(path).replace_extension(".json"));
  if (maps.rows.width != stack.width || maps.rows.rows != stack.height ||
      static_cast<std::size_t>(maps.channels) != stack.channels) {
    throw InputError(fmt::format("{}: maps of {} x {} texels and {} channels are not of the stack {}, {} x {} and {}",
                                 PrintableName(path), maps.rows.width, maps.rows.rows, maps.channels,
                                 PrintableName(stack_path), stack.width, stack.height, stack.channels));
  }
  MapsPage page;
  page.fallback = MedianFallback(maps);
  const Judgement judgement = JudgeLights(maps, stack, record.left_out, page.fallback);
  page.lights = judgement.lights;
  page.title = "One fit a texel: " + PrintableName(path.filename());
  std::size_t fitted, left_out;
  const double fitted_psnr = MeanPsnr(page.lights, true, &fitted), honest = MeanPsnr(page.lights, false, &left_out);
  page.subtitle = fmt::format("{} lights, {} x {} texels; fitted lights are met to {:.1f} dB (mean)",
                              stack.lights.size(), stack.width, stack.height, fitted_psnr);
  page.subtitle += left_out > 0 ? fmt::format(", {} that were left out to {:.1f} dB", left_out, honest)
                                : "; `maps --leave-out` shows how well a light is met that was not fitted";
  Print(page.subtitle + "\n");
  for (const std::string& remark : judgement.doubts.Remarks()) Print("Note: " + remark + "\n");
  for (const std::string& format : formats) {
    const std::filesystem::path file = std::filesystem::path(picture).replace_extension(format);
    if (format == "png") WriteMapsReport(maps, stack, page, scale, file);
    if (format == "html") WriteFileAtomically(file, MapsHtml(maps, stack, page));
    Print((format == "png" ? "Picture: " : "Page:    ") + PrintableName(file) + "\n");
  }
  return kExitDone;
}

int DescribeStack(const std::filesystem::path& path, const StackOptions& options, bool json) {
  const Stack stack = OpenStack(path, options);
  std::size_t values = 0, saturated = 0, dark = 0, negative = 0, invalid = 0;
  const std::size_t lights = stack.lights.size();
  {
    StackReader reader(stack);
    Progress progress("reading", stack.height);
    const std::size_t rows = RowsOfBand(stack);
    std::vector<float> texel;
    for (std::size_t first = 0; first < stack.height; first += rows) {
      const StackBand band = reader.Read(first, std::min(rows, stack.height - first));
      for (std::size_t t = 0; t < band.rows * stack.width; ++t) {
        if (!stack.Holds(first * stack.width + t)) continue;
        for (std::size_t c = 0; c < stack.channels; ++c) {
          const float* v = band.values.data() + (t * stack.channels + c) * lights;
          texel.assign(v, v + lights);
          std::sort(texel.begin(), texel.end());
          const float high = texel[(lights - 1) * 9 / 10];
          for (std::size_t l = 0; l < lights; ++l) {
            ++values;
            saturated += std::isinf(v[l]) ? 1 : 0, invalid += std::isnan(v[l]) ? 1 : 0;
            negative += v[l] < 0 ? 1 : 0;
            dark += v[l] < 0.1F * high ? 1 : 0;
          }
        }
      }
      progress.Advance(band.rows);
    }
  }
  double low = kPi, high = 0;
  for (const StackLight& light : stack.lights) {
    low = std::min(low, PolarAngle(light.direction)), high = std::max(high, PolarAngle(light.direction));
  }
  low = RadiansToDegrees(low), high = RadiansToDegrees(high);
  if (json) {
    const nlohmann::ordered_json document = {{"stack", path.filename().string()},
                                             {"layout", stack.layout},
                                             {"images", stack.images.size()},
                                             {"width", stack.width},
                                             {"height", stack.height},
                                             {"channels", stack.channels},
                                             {"texels", stack.Texels()},
                                             {"encoding", EncodingWord(stack.response)},
                                             {"calibrated", stack.calibrated},
                                             {"light_theta_deg", {low, high}},
                                             {"lights", stack.near ? "near" : "distant"},
                                             {"cameras", stack.cameras.size()},
                                             {"saturated", saturated},
                                             {"dark", dark},
                                             {"negative", negative},
                                             {"not_a_number", invalid},
                                             {"values", values},
                                             {"remarks", stack.remarks}};
    fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return kExitDone;
  }
  std::string text = fmt::format("{}: {}\n", PrintableName(path), stack.layout);
  text += fmt::format("  images       {} of {} x {}, {} channels, {}\n", stack.images.size(), stack.width, stack.height,
                      stack.channels, EncodingWord(stack.response));
  text += fmt::format("  texels       {}{}\n", stack.Texels(), stack.mask.empty() ? "" : " within the mask");
  text += fmt::format("  lights       theta {:.1f} to {:.1f} degrees, {}\n", low, high,
                      stack.near ? fmt::format("near: {:.4g} mm from the middle of a picture of {:.4g} mm (mean)",
                                               stack.near->reference_mm, stack.width_mm)
                                 : "distant");
  if (!stack.cameras.empty()) {
    text += fmt::format("  camera       at {}, z {:.4g} mm\n",
                        stack.cameras.size() == 1 ? "one place" : "a place for each photograph", stack.cameras[0].z);
  }
  text += fmt::format("  unit         {}\n",
                      stack.calibrated ? "f_r cos_theta_i, 1/sr" : "one unknown factor of f_r cos_theta_i");
  text += fmt::format(
      "  dark         {:.1f} % of the values, below a tenth of the texel's 90th percentile: set aside as shadow\n",
      Share(dark, values));
  text += fmt::format("  saturated    {:.2f} %\n", Share(saturated, values));
  if (negative + invalid > 0) text += fmt::format("  odd          {} negative, {} no number\n", negative, invalid);
  for (const std::string& remark : stack.remarks) text += "  note         " + remark + "\n";
  Print(text);
  return kExitDone;
}

}  // namespace lobefit

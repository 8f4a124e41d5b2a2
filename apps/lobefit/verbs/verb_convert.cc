// lobefit convert: from any format that can be read to any that can be written.
#include <filesystem>
#include <memory>
#include <optional>

#include "options/measurement_options.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/series.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/write.h"
#include "lobefit/measurement/checks/isotropy.h"

namespace lobefit {
namespace {

struct ConvertVerb {
  MeasurementOptions measurement;
  std::vector<std::string> files;  // inputs, then the output
  std::string format;
  bool isotropic = false;
};

std::string FormatNames() {
  std::string names;
  for (const WriteFormat& format : WriteFormats()) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

std::string ToJson(const Conversion& conversion, const std::string& shown_isotropic) {
  std::vector<std::string> files;
  for (const std::filesystem::path& file : conversion.files) files.push_back(file.string());
  const nlohmann::ordered_json json = {
      {"files", files},
      {"losses", conversion.losses},
      {"compared", conversion.difference.compared},
      {"not_compared", conversion.not_compared},
      {"isotropic_because", shown_isotropic},
      {"relative_difference", conversion.difference.compared == 0
                                  ? nlohmann::ordered_json()
                                  : nlohmann::ordered_json{{"median", conversion.difference.median},
                                                           {"maximum", conversion.difference.maximum}}}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int RunConvert(const ConvertVerb& verb, const CommonOptions& common) {
  const std::optional<std::string> name = verb.format.empty() ? std::nullopt : std::optional<std::string>(verb.format);
  if (verb.files.size() < 2) throw UsageError("convert needs a file to read and one to write");
  const std::vector<std::string> in(verb.files.begin(), verb.files.end() - 1);
  const std::string& out = verb.files.back();
  CheckOutput(out, InputPaths(in));
  const WriteFormat& format = FindWriteFormat(name, out);
  Measurement measurement = verb.measurement.Load(in);
  measurement.isotropic = measurement.isotropic || verb.isotropic;
  std::string shown;
  if (!measurement.isotropic && format.is_grid && HasOneAzimuth(measurement.samples)) {
    const IsotropicPairs pairs = CompareIsotropicPairs(measurement);
    measurement.isotropic = pairs.ShowIsotropy();
    if (measurement.isotropic) {
      shown = fmt::format(
          "light from one azimuth stands for all: {} pairs of samples that an isotropic surface alone makes equal "
          "differ by {:.2g} % in the median",
          pairs.pairs, 100 * pairs.median);
    }
  }
  WriteSource source;
  source.measurement = &measurement;
  source.channels = measurement.channels;
  source.isotropic = measurement.isotropic;
  // A file that defines its own interpolation is asked by it, unless its channels were chosen or mixed.
  if (measurement.conventions.count("channels") == 0) {
    const TabulatedFunction table = TabulatedBrdf(OnlyFile(in), measurement);
    source.brdf = table.brdf;
    source.covers = table.covers;
  }
  const Conversion conversion = Convert(source, format, {}, out);
  std::FILE* const messages = SummaryStream(out);
  if (common.json) {
    fmt::print(messages, "{}\n", ToJson(conversion, shown));
    return 0;
  }
  for (const std::filesystem::path& file : conversion.files)
    Print(fmt::format("{}: {}\n", PrintableName(file), format.description), messages);
  if (!shown.empty()) fmt::print(messages, "Isotropic: {}\n", shown);
  for (const std::string& loss : conversion.losses) Print(fmt::format("Lost: {}\n", loss), messages);
  if (conversion.difference.compared == 0) {
    Print(fmt::format("Not compared: {}\n", conversion.not_compared), messages);
    return 0;
  }
  fmt::print(messages, "Relative difference at {} values: median {:.2g}, largest {:.2g}\n",
             conversion.difference.compared, conversion.difference.median, conversion.difference.maximum);
  return 0;
}

}  // namespace

std::function<int()> SetUpConvert(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<ConvertVerb>();
  app->add_option("FILES", verb->files,
                  "IN [IN ...] OUT: measurement files or folders, read as one measurement, and last the file to write, "
                  "whose ending chooses the format")
      ->required();
  app->add_option("--to", verb->format, "format to write: " + FormatNames());
  app->add_flag("--isotropic", verb->isotropic,
                "the sample is isotropic: light from one azimuth stands for light from all");
  verb->measurement.AddTo(app);
  return [=] { return RunConvert(*verb, *common); };
}

}  // namespace lobefit

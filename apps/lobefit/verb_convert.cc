// lobefit convert: from any format that can be read to any that can be written.
#include <filesystem>
#include <memory>
#include <optional>

#include "measurement_options.h"
#include "verb.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/io/text/options.h"
#include "lobefit/io/write.h"

namespace lobefit {
namespace {

struct ConvertVerb {
  MeasurementOptions measurement;
  std::string in, out, format;
};

std::string FormatNames() {
  std::string names;
  for (const WriteFormat& format : WriteFormats()) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

std::string ToJson(const Conversion& conversion) {
  std::vector<std::string> files;
  for (const std::filesystem::path& file : conversion.files) files.push_back(file.string());
  const nlohmann::ordered_json json = {
      {"files", files},
      {"losses", conversion.losses},
      {"compared", conversion.difference.compared},
      {"relative_difference", {{"median", conversion.difference.median}, {"maximum", conversion.difference.maximum}}}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int RunConvert(const ConvertVerb& verb, const CommonOptions& common) {
  const std::optional<std::string> name = verb.format.empty() ? std::nullopt : std::optional<std::string>(verb.format);
  const WriteFormat& format = FindWriteFormat(name, verb.out);
  const Measurement measurement = verb.measurement.Load(verb.in);
  WriteSource source;
  source.measurement = &measurement;
  source.channels = measurement.channels;
  source.isotropic = measurement.isotropic;
  // A file that defines its own interpolation is asked by it, unless its channels were chosen or mixed.
  if (measurement.conventions.count("channels") == 0) source.brdf = TabulatedBrdf(verb.in, measurement);
  const Conversion conversion = Convert(source, format, {}, verb.out);
  if (common.json) {
    fmt::print("{}\n", ToJson(conversion));
    return 0;
  }
  for (const std::filesystem::path& file : conversion.files) fmt::print("{}: {}\n", file.string(), format.description);
  for (const std::string& loss : conversion.losses) fmt::print("Lost: {}\n", loss);
  fmt::print("Relative difference at {} values: median {:.2g}, largest {:.2g}\n", conversion.difference.compared,
             conversion.difference.median, conversion.difference.maximum);
  return 0;
}

}  // namespace

std::function<int()> SetUpConvert(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<ConvertVerb>();
  app->add_option("IN", verb->in, "measurement file")->required();
  app->add_option("OUT", verb->out, "file to write; its ending chooses the format")->required();
  app->add_option("--to", verb->format, "format to write: " + FormatNames());
  verb->measurement.AddTo(app);
  return [=] { return RunConvert(*verb, *common); };
}

}  // namespace lobefit

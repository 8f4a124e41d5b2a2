#include "options/measurement_options.h"

#include <algorithm>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/series.h"
#include "lobefit/io/text/options.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {

void MeasurementOptions::AddTo(CLI::App* app) {
  const std::string part = "Part of the file";
  app->add_option("--theta-i", theta_i_, "polar angles of the light to use, degrees: LOW:HIGH or one value")
      ->group(part);
  app->add_option("--phi-i", phi_i_, "azimuths of the light to use, degrees: LOW:HIGH or one value")->group(part);
  app->add_option(
         "--channels", channels_,
         "channels to use: all (default), rgb, luminance, or a list of names, wavelengths or ranges (550, 400:700)")
      ->group(part);
  const std::vector<ReadOptionEntry>& table = ReadOptionTable();
  words_.resize(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::vector<std::string>& formats = table[i].formats;
    // Those of formats that few have are in the help of the format.
    const bool listed = formats.empty() || std::find(formats.begin(), formats.end(), "csv") != formats.end();
    const std::string of = formats.empty() ? "all formats" : Join(formats);
    app->add_option(std::string("--") + table[i].name, words_[i], std::string(table[i].help) + " (" + of + ")")
        ->option_text(table[i].allowed)
        ->group(listed ? "What the file leaves open (of other formats: lobefit formats NAME)" : "");
  }
}

std::vector<std::pair<std::string, std::string*>> MeasurementOptions::Named() {
  std::vector<std::pair<std::string, std::string*>> named = {
      {"theta-i", &theta_i_}, {"phi-i", &phi_i_}, {"channels", &channels_}};
  words_.resize(ReadOptionTable().size());
  for (std::size_t i = 0; i < words_.size(); ++i) named.emplace_back(ReadOptionTable()[i].name, &words_[i]);
  return named;
}

std::map<std::string, std::string> MeasurementOptions::Words() const {
  std::map<std::string, std::string> words;
  MeasurementOptions copy = *this;
  for (const auto& [name, word] : copy.Named()) {
    if (!word->empty()) words[name] = *word;
  }
  return words;
}

void MeasurementOptions::FillFrom(const std::map<std::string, std::string>& words, const std::string& document) {
  const std::vector<std::pair<std::string, std::string*>> named = Named();
  for (const auto& entry : words) {
    const std::string& name = entry.first;
    const auto at = std::find_if(named.begin(), named.end(), [&](const auto& option) { return option.first == name; });
    if (at == named.end())
      throw InputError(document + ": the fit that it holds was read with --" + Excerpt(name) +
                       ", which this version does not have");
    if (at->second->empty()) *at->second = entry.second;
  }
  document_ = document;
}

std::filesystem::path OnlyFile(const std::vector<std::string>& files) {
  return files.size() == 1 ? ParseFileSpec(files[0]).path : std::filesystem::path();
}

std::string SeriesName(const std::vector<std::string>& files) {
  std::string name;
  for (std::size_t f = 0; f < files.size(); ++f) {
    std::filesystem::path path = ParseFileSpec(files[f]).path;
    if (!path.has_filename()) path = path.parent_path();  // a folder named with a slash at its end
    if (path == "-") path = "stdin";
    const std::string stem = std::filesystem::is_directory(path) ? path.filename().string() : path.stem().string();
    if (f == 0) name = stem;
    const auto differ = std::mismatch(name.begin(), name.end(), stem.begin(), stem.end());
    name.erase(differ.first, name.end());
  }
  while (name.size() > 1 && (name.back() == '_' || name.back() == '-' || name.back() == '.' || name.back() == ' ')) {
    name.pop_back();
  }
  return name.empty() || name == "." ? "series" : name;
}

ReadOptions MeasurementOptions::Read() const {
  ReadOptions options;
  options.channels = channels_;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    if (!words_[i].empty()) ReadOptionTable()[i].set(&options, words_[i]);
  }
  return options;
}

void MeasurementOptions::Check() const {
  Read();
  if (!theta_i_.empty()) ParseAngleRange(theta_i_, "--theta-i");
  if (!phi_i_.empty()) ParseAngleRange(phi_i_, "--phi-i");
}

Measurement MeasurementOptions::Load(const std::vector<std::string>& files) const {
  Measurement measurement = ReadSeries(files, Read());
  try {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (!words_[i].empty()) CheckOptionOf(ReadOptionTable()[i], measurement.format, files.front());
    }
  } catch (const UsageError& error) {
    if (document_.empty()) throw;
    throw UsageError(std::string(error.what()) + "; unless it was given here, it is of the fit in " + document_);
  }
  SelectDirections(&measurement);
  return measurement;
}

Measurement MeasurementOptions::LoadStated(const std::vector<std::string>& files) const {
  Measurement measurement = Load(files);
  const auto kind = measurement.conventions.find("value-kind");
  if (kind != measurement.conventions.end() && kind->second.ends_with("(not stated)")) {
    throw InputError(measurement.source + ": does not say what its values are; state it with --value-kind, one of " +
                     AllowedValueKinds());
  }
  return measurement;
}

void MeasurementOptions::Select(Measurement* measurement) const {
  SelectDirections(measurement);
  if (!channels_.empty() && channels_ != "all") Apply(MakeChannelMap(channels_, measurement->channels), measurement);
}

void MeasurementOptions::SelectDirections(Measurement* measurement) const {
  Selection selection;
  if (!theta_i_.empty()) selection.theta_i = ParseAngleRange(theta_i_, "--theta-i");
  if (!phi_i_.empty()) selection.phi_i = ParseAngleRange(phi_i_, "--phi-i");
  Apply(selection, measurement);
}

}  // namespace lobefit

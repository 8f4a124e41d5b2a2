#include "measurement_options.h"

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
    app->add_option(std::string("--") + table[i].name, words_[i], table[i].help)
        ->option_text(table[i].allowed)
        ->group("What the file leaves open");
  }
}

Measurement MeasurementOptions::Load(const std::string& path) const {
  ReadOptions options;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    if (!words_[i].empty()) ReadOptionTable()[i].set(&options, words_[i]);
  }
  Measurement measurement = ReadMeasurement(path, options);
  Select(&measurement);
  return measurement;
}

void MeasurementOptions::Select(Measurement* measurement) const {
  Selection selection;
  if (!theta_i_.empty()) selection.theta_i = ParseAngleRange(theta_i_, "--theta-i");
  if (!phi_i_.empty()) selection.phi_i = ParseAngleRange(phi_i_, "--phi-i");
  Apply(selection, measurement);
  if (!channels_.empty() && channels_ != "all") Apply(MakeChannelMap(channels_, measurement->channels), measurement);
}

}  // namespace lobefit

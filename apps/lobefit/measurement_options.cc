#include "measurement_options.h"

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/io/options.h"

namespace lobefit {
namespace {

template <class Enum>
Enum Require(std::optional<Enum> (*parse)(std::string_view), const std::string& text, const char* option,
             const std::string& allowed) {
  const std::optional<Enum> value = parse(text);
  if (!value) throw UsageError(fmt::format("{} '{}' is unknown; allowed: {}", option, Excerpt(text), allowed));
  return *value;
}

// One of two words.
template <class Enum>
Enum OneOf(const std::string& text, const char* option, const char* first, Enum first_value, const char* second,
           Enum second_value) {
  if (text == first) return first_value;
  if (text == second) return second_value;
  throw UsageError(fmt::format("{} '{}' is unknown; allowed: {}, {}", option, Excerpt(text), first, second));
}

}  // namespace

void MeasurementOptions::AddTo(CLI::App* app) {
  const std::string part = "Part of the file";
  app->add_option("--theta-i", theta_i_, "polar angles of the light to use, degrees: LOW:HIGH or one value")
      ->group(part);
  app->add_option("--phi-i", phi_i_, "azimuths of the light to use, degrees: LOW:HIGH or one value")->group(part);
  const std::string open = "What the file leaves open";
  app->add_option("--angle-unit", angle_unit_, "csv, astm: deg or rad")->group(open);
  app->add_option("--value-kind", value_kind_, "csv, alta, astm: " + AllowedValueKinds())->group(open);
  app->add_option("--incident", incident_,
                  "csv, astm, fred: the light's direction points 'towards' the source or along its 'propagation'")
      ->group(open);
  app->add_option("--value-column", value_column_, "csv: the column that holds the values, where there are several")
      ->group(open);
  app->add_option("--merl-cell", merl_cell_,
                  "merl: a sample sits at the 'centre' (default) or the lower 'edge' of its cell")
      ->group(open);
  app->add_option("--side", side_, "bsdf-xml, lighttools: 'front' or 'back' of the sample")->group(open);
  app->add_option("--xml-naming", xml_naming_, "bsdf-xml: 'window' (default; front is its Reflection Back) or 'plain'")
      ->group(open);
  app->add_option("--xml-wavelength", xml_wavelength_, "bsdf-xml: the wavelength block to read")->group(open);
  app->add_option("--zemax-rotation-sign", zemax_rotation_sign_, "zemax: +1 (default) or -1, sense of SampleRotation")
      ->check(CLI::IsMember({1, -1}))
      ->group(open);
  app->add_option("--lighttools-azimuth", lighttools_azimuth_,
                  "lighttools: azimuth of the light in its plane of incidence, degrees (default 90)")
      ->group(open);
  app->add_option("--alta-interval", alta_interval_, "alta: two interval columns are 'bounds' or 'offsets'")
      ->group(open);
  app->add_option("--mountain-azimuth", mountain_azimuth_,
                  "mountain: azimuths as in the 'file' (default) or turned so that 'up' is +y")
      ->group(open);
}

ReadOptions MeasurementOptions::Options() const {
  ReadOptions options;
  if (!angle_unit_.empty()) options.angle_unit = Require(&ParseAngleUnit, angle_unit_, "--angle-unit", "deg, rad");
  if (!value_kind_.empty())
    options.value_kind = Require(&ParseValueKind, value_kind_, "--value-kind", AllowedValueKinds());
  if (!incident_.empty())
    options.incident_sense = Require(&ParseIncidentSense, incident_, "--incident", "towards, propagation");
  if (!value_column_.empty()) options.value_column = value_column_;
  if (!merl_cell_.empty()) options.merl_cell = Require(&ParseCellPosition, merl_cell_, "--merl-cell", "centre, edge");
  if (!side_.empty()) options.side = OneOf(side_, "--side", "front", Side::kFront, "back", Side::kBack);
  if (!xml_naming_.empty())
    options.xml_naming = OneOf(xml_naming_, "--xml-naming", "window", XmlNaming::kWindow, "plain", XmlNaming::kPlain);
  if (!xml_wavelength_.empty()) options.xml_wavelength = xml_wavelength_;
  options.zemax_rotation_sign = zemax_rotation_sign_;
  options.lighttools_azimuth_deg = lighttools_azimuth_;
  if (!alta_interval_.empty()) {
    options.alta_interval =
        OneOf(alta_interval_, "--alta-interval", "bounds", IntervalKind::kBounds, "offsets", IntervalKind::kOffsets);
  }
  if (!mountain_azimuth_.empty()) {
    options.mountain_azimuth =
        OneOf(mountain_azimuth_, "--mountain-azimuth", "file", MountainAzimuth::kFile, "up", MountainAzimuth::kUp);
  }
  return options;
}

Measurement MeasurementOptions::Load(const std::string& path) const {
  Selection selection;
  if (!theta_i_.empty()) selection.theta_i = ParseAngleRange(theta_i_, "--theta-i");
  if (!phi_i_.empty()) selection.phi_i = ParseAngleRange(phi_i_, "--phi-i");
  Measurement measurement = ReadMeasurement(path, Options());
  Apply(selection, &measurement);
  return measurement;
}

}  // namespace lobefit

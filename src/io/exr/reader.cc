// BRDF images in OpenEXR: slices over half and difference angles, hemispheres of one incident direction, UTIA tables.
// What the pixels are stands in attributes whose names begin with "brdf.", or in options. NaN is a hole.
#include "lobefit/io/exr/reader.h"

#include <cmath>
#include <cstring>
#include <map>
#include <mutex>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/columns.h"
#include "lobefit/io/exr/head.h"
#include "lobefit/io/exr/map.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/utia/grid.h"
#include "lobefit/io/utia/value.h"

namespace lobefit {
namespace {

constexpr char kMagic[] = {0x76, 0x2f, 0x31, 0x01};
constexpr int kLargestSide = 8192;
constexpr std::size_t kMostValues = std::size_t{1} << 26;
// No compression of OpenEXR packs even a constant image closer than this.
constexpr std::size_t kMostValuesPerByte = 2048;

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}

  bool read(char* target, int count) override {
    if (count < 0 || static_cast<std::size_t>(count) > bytes_.size() - at_) {
      throw std::runtime_error("the file ends at byte " + std::to_string(bytes_.size()) +
                               ", in the middle of its data");
    }
    std::memcpy(target, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) {
      throw std::runtime_error("its tables point behind the end of the file at byte " + std::to_string(bytes_.size()));
    }
    at_ = static_cast<std::size_t>(position);
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

[[noreturn]] void Fail(const InputFile& file, const std::string& what) {
  throw InputError(file.path.string() + ": " + what);
}

struct ImageChannel {
  std::string exr_name;
  std::string name;
  double wavelength_nm = 0;
};

// "550nm", or "S0.550,00nm" as spectral EXR files name the unpolarised part.
std::optional<ImageChannel> AsWavelength(const std::string& exr_name) {
  std::string name = exr_name;
  if (name.starts_with("S0.")) name.erase(0, 3);
  if (!name.ends_with("nm")) return std::nullopt;
  for (char& c : name) c = c == ',' ? '.' : c;
  const CsvColumn column = ClassifyColumn(name);
  if (!(column.wavelength_nm > 0)) return std::nullopt;
  return ImageChannel{exr_name, column.channel, column.wavelength_nm};
}

std::vector<ImageChannel> ChooseChannels(const InputFile& file, const Imf::Header& header) {
  std::vector<std::string> names;
  std::map<double, ImageChannel> spectral;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      Fail(file, "channel '" + Excerpt(channel.name()) + "' is subsampled; every pixel must have a value");
    }
    names.emplace_back(channel.name());
    if (const auto wavelength = AsWavelength(channel.name())) spectral.emplace(wavelength->wavelength_nm, *wavelength);
  }
  const auto has = [&](const char* name) { return header.channels().findChannel(name) != nullptr; };
  std::vector<ImageChannel> chosen;
  for (const char* triple : {"RGB", "XYZ"}) {
    bool all = true;
    for (const char c : std::string_view(triple)) all = all && has(std::string(1, c).c_str());
    if (!all) continue;
    for (const char c : std::string_view(triple)) chosen.push_back({std::string(1, c), std::string(1, c)});
    return chosen;
  }
  if (!spectral.empty()) {
    for (const auto& [nm, channel] : spectral) chosen.push_back(channel);
    return chosen;
  }
  if (has("Y")) return {{"Y", "Y"}};
  if (names.size() == 1) return {{names[0], "Y"}};
  Fail(file, "has the channels " + Excerpt(Join(names), 120) +
                 "; allowed are R G B, X Y Z, Y, one channel, or wavelengths as 550nm");
}

std::optional<std::string> StringAttribute(const Imf::Header& header, const std::string& name) {
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
  if (attribute == nullptr) return std::nullopt;
  return attribute->value();
}

// Options first, then the file's attributes, then defaults; each choice is echoed.
class MapReader {
 public:
  MapReader(const InputFile& file, const Imf::Header& header, const ReadOptions& options, Measurement* notes)
      : file_(file), header_(header), options_(options), notes_(notes) {}

  ExrMap Read(std::size_t width, std::size_t height) {
    const bool utia_size = width == kUtiaDirections && height == kUtiaDirections;
    std::optional<ExrAxes> axes =
        Choose("axes", options_.exr_axes, ParseExrAxes, "slice, slice-sqrt, hemisphere, utia");
    if (!axes && utia_size) {
      axes = ExrAxes::kUtia;
      notes_->conventions["exr-axes"] = "utia (288 x 288 pixels)";
    }
    if (!axes) {
      Fail(file_,
           "has no attribute brdf.axes, so that it is not known what its pixels are; choose "
           "--exr-axes slice|slice-sqrt|hemisphere|utia");
    }
    ExrMap map;
    map.axes = *axes;
    if (map.axes == ExrAxes::kUtia) {
      if (!utia_size) {
        Fail(file_,
             "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; a UTIA image has 288 x 288");
      }
    } else if (map.axes == ExrAxes::kHemisphere) {
      map.projection =
          Choose("projection", options_.exr_projection, ParseExrProjection, "equidistant, equal-area, concentric")
              .value_or(ExrProjection::kEquidistant);
      notes_->conventions.emplace("exr-projection", "equidistant (default)");
      const std::optional<double> theta_i = Angle("theta_i", options_.exr_theta_i_deg);
      if (!theta_i) {
        Fail(file_,
             "has no attribute brdf.theta_i, so that the light is not known; give --exr-theta-i and --exr-phi-i in "
             "degrees");
      }
      map.theta_i = DegreesToRadians(*theta_i);
      map.phi_i = DegreesToRadians(Angle("phi_i", options_.exr_phi_i_deg).value_or(0));
      notes_->conventions.emplace("exr-phi-i", "0 (default)");
    } else {
      map.rows = Choose("rows", options_.exr_rows, ParseExrRows, "up, down").value_or(ExrRows::kUp);
      notes_->conventions.emplace("exr-rows", "up (default)");
      map.phi_d = DegreesToRadians(Angle("phi_d", options_.exr_phi_d_deg).value_or(90));
      notes_->conventions.emplace("exr-phi-d", "90 (default)");
    }
    return map;
  }

  ValueKind ReadValueKind() {
    const std::optional<ValueKind> kind = Choose("value", options_.value_kind, ParseValueKind, AllowedValueKinds());
    notes_->conventions.erase("exr-value");
    notes_->conventions["value-kind"] = Name(kind.value_or(ValueKind::kBrdf)) + (options_.value_kind ? " (option)"
                                                                                 : kind              ? " (attribute)"
                                                                                                     : " (default)");
    return kind.value_or(ValueKind::kBrdf);
  }

 private:
  template <class Value, class Parse>
  std::optional<Value> Choose(const std::string& key, const std::optional<Value>& option, Parse parse,
                              const std::string& allowed) {
    if (option) {
      notes_->conventions["exr-" + key] = Name(*option) + " (option)";
      return option;
    }
    const std::optional<std::string> word = StringAttribute(header_, "brdf." + key);
    if (!word) return std::nullopt;
    const std::optional<Value> value = parse(*word);
    if (!value) Fail(file_, "attribute brdf." + key + " is '" + Excerpt(*word) + "'; allowed are " + allowed);
    notes_->conventions["exr-" + key] = Name(*value) + " (attribute)";
    return value;
  }

  // Degrees.
  std::optional<double> Angle(const std::string& key, const std::optional<double>& option) {
    std::string option_name = "exr-" + key;
    for (char& c : option_name) c = c == '_' ? '-' : c;
    if (option) {
      notes_->conventions[option_name] = FormatDouble(*option) + " (option)";
      return option;
    }
    const auto* attribute = header_.findTypedAttribute<Imf::FloatAttribute>("brdf." + key);
    if (attribute == nullptr) return std::nullopt;
    const double degrees = static_cast<double>(attribute->value());
    if (!(std::fabs(degrees) <= 360)) {
      Fail(file_, "attribute brdf." + key + " is " + FormatDouble(degrees) + "; -360 to 360 degrees are allowed");
    }
    notes_->conventions[option_name] = FormatDouble(degrees) + " (attribute)";
    return degrees;
  }

  const InputFile& file_;
  const Imf::Header& header_;
  const ReadOptions& options_;
  Measurement* notes_;
};

struct Image {
  std::size_t width, height;
  std::vector<std::vector<float>> planes;
};

Image ReadPixels(const InputFile& file, Imf::InputFile& exr, const std::vector<ImageChannel>& channels) {
  const Imath::Box2i window = exr.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  const bool sane = width >= 1 && height >= 1 && width <= kLargestSide && height <= kLargestSide;
  const std::size_t values = sane ? static_cast<std::size_t>(width * height) * channels.size() : kMostValues + 1;
  if (values > kMostValues || values / kMostValuesPerByte > file.bytes.size()) {
    Fail(file, "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels x " +
                   std::to_string(channels.size()) + " channels in " + std::to_string(file.bytes.size()) +
                   " bytes; at most " + std::to_string(kLargestSide) + " a side, 2^26 values and " +
                   std::to_string(kMostValuesPerByte) + " values a byte are allowed");
  }
  Image image = {static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
  image.planes.assign(channels.size(), std::vector<float>(image.width * image.height));
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    buffer.insert(channels[c].exr_name, Imf::Slice::Make(Imf::FLOAT, image.planes[c].data(), window, sizeof(float),
                                                         sizeof(float) * image.width));
  }
  exr.setFrameBuffer(buffer);
  exr.readPixels(window.min.y, window.max.y);
  return image;
}

Measurement MakeMeasurement(const Image& image, const std::vector<ImageChannel>& channels, const ExrMap& map,
                            ValueKind kind, const ReadOptions& options) {
  Channels names;
  for (const ImageChannel& channel : channels) {
    names.names.push_back(channel.name);
    if (channel.wavelength_nm > 0) names.wavelengths_nm.push_back(channel.wavelength_nm);
  }
  MeasurementBuilder builder(names);
  std::vector<double>& solid_angle = builder.measurement().samples.solid_angle;
  std::vector<double> values(channels.size());
  for (std::size_t pixel = 0; pixel < image.width * image.height; ++pixel) {
    Vec3 wi = {}, wo = {};
    double measure = 0;
    if (!map.Directions(pixel % image.width, pixel / image.width, image.width, image.height, &wi, &wo, &measure)) {
      builder.Skip(SetAsideReason::kBelowHorizon);
      continue;
    }
    const double factor = BrdfFactor(kind, wi.z, wo.z);
    bool hole = false;
    for (std::size_t c = 0; c < values.size(); ++c) {
      const double stored = static_cast<double>(image.planes[c][pixel]);
      hole = hole || std::isnan(stored);
      values[c] = factor * (map.axes == ExrAxes::kUtia && std::isfinite(stored) ? UtiaValue(stored, options) : stored);
    }
    if (hole) {
      builder.Skip(SetAsideReason::kHole);
    } else if (builder.Add(wi, wo, values.data(), static_cast<std::uint32_t>(pixel))) {
      solid_angle.push_back(measure);
    }
  }
  Measurement measurement = builder.Finish();
  ScaleToMeanOne(&measurement.samples.solid_angle);
  measurement.isotropic = map.axes == ExrAxes::kSlice || map.axes == ExrAxes::kSliceSqrt;
  if (map.axes == ExrAxes::kUtia) EchoUtiaOptions(options, &measurement);
  return measurement;
}

// OpenEXR allocates by the header before anything of the image is seen; its own limits are process-wide.
void LimitOpenExr() {
  static std::once_flag once;
  std::call_once(once, [] {
    Imf::Header::setMaxImageSize(kLargestSide, kLargestSide);
    Imf::Header::setMaxTileSize(kLargestSide, kLargestSide);
  });
}

}  // namespace

bool IsExr(std::string_view bytes) { return bytes.starts_with(std::string_view(kMagic, sizeof(kMagic))); }

Measurement ReadExr(const InputFile& file, const ReadOptions& options) {
  LimitOpenExr();
  CheckExrHead(file, file.bytes.size());
  try {
    MemoryStream stream(file.bytes);
    Imf::InputFile exr(stream, 0);
    const std::vector<ImageChannel> channels = ChooseChannels(file, exr.header());
    const Image image = ReadPixels(file, exr, channels);
    Measurement notes;
    MapReader reader(file, exr.header(), options, &notes);
    const ExrMap map = reader.Read(image.width, image.height);
    const ValueKind kind = reader.ReadValueKind();
    Measurement measurement = MakeMeasurement(image, channels, map, kind, options);
    measurement.conventions.insert(notes.conventions.begin(), notes.conventions.end());
    return measurement;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    // OpenEXR puts the stream's name in front of its reason.
    constexpr std::string_view kPrefix = "Cannot read image file \"memory\". ";
    std::string_view reason = error.what();
    if (reason.starts_with(kPrefix)) reason.remove_prefix(kPrefix.size());
    while (reason.ends_with('.')) reason.remove_suffix(1);
    Fail(file, "cannot be read as an OpenEXR image: " + Excerpt(reason, 200) + "; fetch the file again");
  }
}

}  // namespace lobefit

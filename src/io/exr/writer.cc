#include "lobefit/io/exr/writer.h"

#include <limits>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/threads.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/io/text/options.h"

namespace lobefit {
namespace {

void AddAttributes(const ExrMap& map, const std::string& source, Imf::Header* header) {
  const auto text = [&](const char* name, const std::string& value) {
    header->insert(name, Imf::StringAttribute(value));
  };
  const auto degrees = [&](const char* name, double radians) {
    header->insert(name, Imf::FloatAttribute(static_cast<float>(RadiansToDegrees(radians))));
  };
  text("brdf.axes", Name(map.axes));
  text("brdf.value", Name(ValueKind::kBrdf));
  text("brdf.source", source);
  if (map.axes == ExrAxes::kHemisphere) {
    text("brdf.projection", Name(map.projection));
    degrees("brdf.theta_i", map.theta_i);
    degrees("brdf.phi_i", map.phi_i);
  } else if (map.axes != ExrAxes::kUtia) {
    text("brdf.rows", Name(map.rows));
    degrees("brdf.phi_d", map.phi_d);
  }
}

}  // namespace

void WriteExr(const BrdfFunction& brdf, const Channels& channels, const ExrMap& map, std::size_t width,
              std::size_t height, const std::string& source, const std::filesystem::path& path, int threads) {
  std::vector<std::vector<float>> planes(channels.size(), std::vector<float>(width * height));
  ParallelFor(height, ThreadsFor(threads), [&](std::size_t row) {
    std::vector<double> values(channels.size());
    for (std::size_t column = 0; column < width; ++column) {
      Vec3 wi = {}, wo = {};
      double measure = 0;
      const bool physical = map.Directions(column, row, width, height, &wi, &wo, &measure);
      if (physical) brdf(wi, wo, values.data());
      for (std::size_t c = 0; c < values.size(); ++c) {
        planes[c][row * width + column] =
            physical ? static_cast<float>(values[c]) : std::numeric_limits<float>::quiet_NaN();
      }
    }
  });
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  AddAttributes(map, source, &header);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels.names[c], Imf::Channel(Imf::FLOAT));
    buffer.insert(channels.names[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), header.dataWindow(), sizeof(float),
                                                      sizeof(float) * width));
  }
  Imf::StdOSStream bytes;
  try {
    Imf::OutputFile exr(bytes, header, 0);
    exr.setFrameBuffer(buffer);
    exr.writePixels(static_cast<int>(height));
  } catch (const std::exception& error) {
    throw OutputError(PrintableName(path) + ": cannot be written as EXR: " + Printable(error.what()));
  }
  WriteFileAtomically(path, bytes.str());
}

}  // namespace lobefit

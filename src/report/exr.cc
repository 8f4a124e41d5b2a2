#include "lobefit/report/exr.h"

#include <algorithm>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

std::string Encode(const std::vector<NamedField>& fields) {
  // Parts of a file share one display window.
  int width = 0, height = 0;
  for (const NamedField& field : fields) {
    width = std::max(width, field.image->width), height = std::max(height, field.image->height);
  }
  std::vector<Imf::Header> headers;
  for (const NamedField& field : fields) {
    const Imath::Box2i display(Imath::V2i(0, 0), Imath::V2i(width - 1, height - 1));
    const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(field.image->width - 1, field.image->height - 1));
    Imf::Header header(display, window, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    header.setName(field.name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* channel : {"measured", "fitted", "log_ratio"})
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  Imf::StdOSStream bytes;
  {
    Imf::MultiPartOutputFile file(bytes, headers.data(), static_cast<int>(headers.size()), false, 0);
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const FieldImage& image = *fields[k].image;
      Imf::FrameBuffer buffer;
      const auto add = [&](const char* channel, const std::vector<float>& values) {
        // The library takes a pointer that is not const and only reads.
        auto* base = static_cast<char*>(static_cast<void*>(const_cast<float*>(values.data())));
        buffer.insert(channel, Imf::Slice(Imf::FLOAT, base, sizeof(float),
                                          sizeof(float) * static_cast<std::size_t>(image.width)));
      };
      add("measured", image.measured);
      add("fitted", image.fitted);
      add("log_ratio", image.log_ratio);
      Imf::OutputPart part(file, static_cast<int>(k));
      part.setFrameBuffer(buffer);
      part.writePixels(image.height);
    }
  }
  return bytes.str();
}

}  // namespace

void WriteExr(const std::vector<NamedField>& fields, const std::filesystem::path& path) {
  if (fields.empty())
    throw OutputError(path.string() +
                      ": the measurement fills no map, so there is nothing to write as EXR; take png or html");
  std::string bytes;
  try {
    bytes = Encode(fields);
  } catch (const std::exception& error) {
    throw OutputError(PrintableName(path) + ": cannot be written as EXR: " + Printable(error.what()));
  }
  WriteFileAtomically(path, bytes);
}

}  // namespace lobefit

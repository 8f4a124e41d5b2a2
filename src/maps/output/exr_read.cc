#include <fstream>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/output/exr.h"

namespace lobefit {
namespace {

int PartIndex(const Imf::MultiPartInputFile& file, const char* name) {
  for (int p = 0; p < file.parts(); ++p) {
    if (file.header(p).hasName() && file.header(p).name() == name) return p;
  }
  return -1;
}

}  // namespace

bool IsMapsExr(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  char head[4] = {};
  if (!in.read(head, 4) || std::string(head, 4) != "\x76\x2f\x31\x01") return false;
  try {
    const Imf::MultiPartInputFile file(path.c_str(), 0);
    return PartIndex(file, "parameters") >= 0;
  } catch (const std::exception&) {
    return false;
  }
}

Maps ReadMapsExr(const std::filesystem::path& path, const std::function<bool(const MapPlane&)>& wanted) {
  const auto fail = [&](const std::string& why) -> InputError {
    return InputError(PrintableName(path) + ": no maps of `lobefit maps`: " + why);
  };
  try {
    Imf::MultiPartInputFile file(path.c_str(), 0);
    const int parameters = PartIndex(file, "parameters");
    if (parameters < 0) throw fail("it has no part 'parameters'");
    const Imf::Header& header = file.header(parameters);
    const Imf::ChannelList& list = header.channels();
    Maps maps;
    maps.channels = list.findChannel("diffuse.R") != nullptr ? 3 : 1;
    maps.lobe = list.findChannel("tilt_x_deg") != nullptr ? MapLobe::kEllipsoid
                : list.findChannel("alpha_x") != nullptr  ? MapLobe::kGgxAnisotropic
                : list.findChannel("alpha") != nullptr    ? MapLobe::kGgx
                                                          : MapLobe::kNone;
    const int quality = PartIndex(file, PartName(MapPart::kQuality));
    const bool clusters = quality >= 0 && file.header(quality).channels().findChannel("cluster") != nullptr;
    const bool doubt = quality >= 0 && file.header(quality).channels().findChannel("normal.doubt_deg") != nullptr;
    maps.planes = PlanesFor({maps.lobe, maps.channels, clusters, doubt});
    const Imath::Box2i window = header.dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (window.min.x != 0 || window.min.y != 0 || width > 65536 || height > 65536) throw fail("an unusual window");
    maps.rows = {0, static_cast<std::size_t>(height), static_cast<std::size_t>(width), {}};
    maps.rows.values.resize(maps.planes.size());
    for (std::size_t k = 0; k < maps.planes.size(); ++k) {
      if (wanted(maps.planes[k])) maps.rows.values[k].resize(maps.rows.rows * maps.rows.width);
    }
    for (const MapPart part : {MapPart::kParameters, MapPart::kErrors, MapPart::kQuality}) {
      const int p = PartIndex(file, PartName(part));
      if (p < 0 || file.header(p).type() != Imf::TILEDIMAGE || file.header(p).dataWindow() != window) {
        throw fail(std::string("the part '") + PartName(part) + "' is missing or differs in size");
      }
      Imf::TiledInputPart tiles(file, p);
      Imf::FrameBuffer buffer;
      for (std::size_t k = 0; k < maps.planes.size(); ++k) {
        if (maps.planes[k].part != part || maps.rows.values[k].empty()) continue;
        if (file.header(p).channels().findChannel(maps.planes[k].name) == nullptr) {
          throw fail("the channel '" + maps.planes[k].name + "' is missing");
        }
        char* base = static_cast<char*>(static_cast<void*>(maps.rows.values[k].data()));
        buffer.insert(maps.planes[k].name,
                      Imf::Slice(Imf::FLOAT, base, sizeof(float), sizeof(float) * static_cast<std::size_t>(width)));
      }
      tiles.setFrameBuffer(buffer);
      tiles.readTiles(0, tiles.numXTiles() - 1, 0, tiles.numYTiles() - 1);
    }
    return maps;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw fail(Printable(error.what()));
  }
}

}  // namespace lobefit

#include "lobefit/io/bsdf_xml/writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/bsdf_xml/radiance_color.h"
#include "lobefit/io/bsdf_xml/tensor_tree.h"

namespace lobefit {
namespace {

// All cells of the finest level, last axis fastest; values[block][cell].
class Grid {
 public:
  Grid(const BrdfFunction& brdf, std::size_t channels, const TensorTreeOptions& options)
      : rank_(options.isotropic ? 3 : 4),
        size_(std::size_t{1} << options.log2_resolution),
        tolerance_(options.tolerance) {
    std::size_t cells = size_;
    for (std::size_t axis = 1; axis < rank_; ++axis) cells *= size_;
    values_.assign(channels, std::vector<float>(cells, 0.0F));
    const std::size_t slab = cells / size_;
    ParallelFor(size_, HardwareThreads(), [&](std::size_t first) {
      std::vector<double> sample(channels);
      for (std::size_t cell = first * slab; cell < (first + 1) * slab; ++cell) {
        Vec3 wi, wo;
        if (!Directions(cell, &wi, &wo)) continue;
        brdf(wi, wo, sample.data());
        for (std::size_t c = 0; c < channels; ++c) values_[c][cell] = static_cast<float>(sample[c]);
      }
    });
  }

  // Y, u', v' instead of R, G, B.
  void ToYuv() {
    for (std::size_t i = 0; i < values_[0].size(); ++i) {
      const std::array<double, 3> yuv = RadianceYuv(At(i));
      for (std::size_t c = 0; c < 3; ++c) values_[c][i] = static_cast<float>(yuv[c]);
    }
  }

  // Whether the three channels are equal everywhere, to single precision.
  bool IsGrey() const {
    for (std::size_t i = 0; i < values_[0].size(); ++i) {
      const auto [low, high] = std::minmax({values_[0][i], values_[1][i], values_[2][i]});
      if (high - low > 1e-6F * std::fabs(high)) return false;
    }
    return true;
  }

  // Of R, G, B, over the cells whose directions are above the horizon.
  double LeastLuminance() const {
    double least = HUGE_VAL;
    Vec3 wi, wo;
    for (std::size_t i = 0; i < values_[0].size(); ++i) {
      if (Directions(i, &wi, &wo)) least = std::min(least, RadianceYuv(At(i))[0]);
    }
    return least;
  }

  void Write(std::ostream& out, std::size_t block) const { WriteNode(out, values_[block], {0, 0, 0, 0}, size_); }

 private:
  using Index = std::array<std::size_t, 4>;

  std::array<double, 3> At(std::size_t cell) const {
    return {static_cast<double>(values_[0][cell]), static_cast<double>(values_[1][cell]),
            static_cast<double>(values_[2][cell])};
  }

  std::size_t CellAt(const Index& index) const {
    std::size_t cell = 0;
    for (std::size_t axis = 0; axis < rank_; ++axis) cell = cell * size_ + index[axis];
    return cell;
  }

  bool Directions(std::size_t cell, Vec3* wi, Vec3* wo) const {
    std::array<double, 4> centre = {};
    for (std::size_t axis = rank_; axis-- > 0; cell /= size_) {
      centre[axis] = (static_cast<double>(cell % size_) + 0.5) / static_cast<double>(size_);
    }
    if (rank_ == 3) {
      if (centre[0] >= 0.5) return false;  // sin(theta_i) = 1 - 2 u: this half of the axis is not used
      *wi = OnHemisphere({-(1 - 2 * centre[0]), 0});
      *wo = OnHemisphere(SquareToDisk({centre[1], centre[2]}));
    } else {
      // The incident position is that of the propagation: opposite to the light's.
      const Vec2 incident = SquareToDisk({centre[0], centre[1]});
      *wi = OnHemisphere({-incident.x, -incident.y});
      *wo = OnHemisphere(SquareToDisk({centre[2], centre[3]}));
    }
    return wi->z > 1e-6 && wo->z > 1e-6;
  }

  template <class Take>
  void ForCube(const Index& corner, std::size_t edge, Take&& take) const {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < rank_; ++axis) count *= edge;
    for (std::size_t n = 0; n < count; ++n) {
      Index index = corner;
      std::size_t rest = n;
      for (std::size_t axis = rank_; axis-- > 0; rest /= edge) index[axis] += rest % edge;
      take(CellAt(index));
    }
  }

  void WriteNode(std::ostream& out, const std::vector<float>& values, const Index& corner, std::size_t edge) const {
    double low = HUGE_VAL, high = -HUGE_VAL, sum = 0, count = 0;
    ForCube(corner, edge, [&](std::size_t cell) {
      const double value = static_cast<double>(values[cell]);
      low = std::min(low, value);
      high = std::max(high, value);
      sum += value;
      ++count;
    });
    const double mean = sum / count;
    out << '{';
    if (high - mean <= tolerance_ * std::fabs(mean) && mean - low <= tolerance_ * std::fabs(mean)) {
      out << FormatDouble(mean);
    } else if (edge == 2) {
      ForCube(corner, edge, [&](std::size_t cell) { out << ' ' << FormatDouble(static_cast<double>(values[cell])); });
    } else {
      for (std::size_t n = 0; n < std::size_t{1} << rank_; ++n) {
        Index child = corner;
        for (std::size_t axis = 0; axis < rank_; ++axis) child[axis] += ((n >> axis) & 1) != 0 ? edge / 2 : 0;
        WriteNode(out, values, child, edge / 2);
      }
    }
    out << "}\n";
  }

  std::size_t rank_, size_;
  double tolerance_;
  std::vector<std::vector<float>> values_;
};

struct Wavelength {
  std::string unit, name;
};

// Radiance takes what exceeds 0.01 / pi everywhere out of a tree as its Lambertian part.
constexpr double kDiffuseLuminance = 0.005 / kPi;
constexpr int kFinestOfRank4 = 7;

}  // namespace

void WriteTensorTree(const BrdfFunction& brdf, const Channels& channels, const TensorTreeOptions& options,
                     const std::filesystem::path& path) {
  const int finest = options.isotropic ? 8 : kFinestOfRank4;
  if (options.log2_resolution < 2 || options.log2_resolution > finest) {
    throw UsageError("a tensor tree of 2^" + std::to_string(options.log2_resolution) +
                     " cells along an axis cannot be written; 2 to " + std::to_string(finest) +
                     " halvings are allowed");
  }
  std::vector<Wavelength> wavelengths;
  const bool rgb = channels.names == std::vector<std::string>{"R", "G", "B"};
  if (rgb) {
    wavelengths = {{"Integral", "Visible"}, {"Integral", "CIE-u"}, {"Integral", "CIE-v"}};
  } else if (!channels.wavelengths_nm.empty()) {
    for (const double nm : channels.wavelengths_nm) wavelengths.push_back({"Nanometer", FormatDouble(nm)});
  } else if (channels.size() == 1) {
    wavelengths = {{"Integral", "Visible"}};
  } else {
    throw UsageError("a tensor tree holds R G B, one channel or wavelengths, not " + Excerpt(Join(channels.names), 80) +
                     "; convert them with --channels rgb");
  }
  auto grid = std::make_unique<Grid>(brdf, channels.size(), options);
  bool isotropic = options.isotropic;
  if (rgb && grid->IsGrey()) {
    wavelengths.resize(1);
  } else if (rgb) {
    if (isotropic && grid->LeastLuminance() > kDiffuseLuminance) {
      TensorTreeOptions rank4 = options;
      rank4.isotropic = isotropic = false;
      rank4.log2_resolution = std::min(options.log2_resolution, kFinestOfRank4);
      grid = std::make_unique<Grid>(brdf, channels.size(), rank4);
    }
    grid->ToYuv();
  }
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
           "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n"
           "<Material>\n<Name>lobefit</Name>\n<Manufacturer>lobefit</Manufacturer>\n</Material>\n"
           "<DataDefinition>\n<IncidentDataStructure>TensorTree"
        << (isotropic ? 3 : 4) << "</IncidentDataStructure>\n</DataDefinition>\n";
    for (std::size_t block = 0; block < wavelengths.size(); ++block) {
      out << "<WavelengthData>\n<LayerNumber>System</LayerNumber>\n<Wavelength unit=\"" << wavelengths[block].unit
          << "\">" << wavelengths[block].name
          << "</Wavelength>\n<WavelengthDataBlock>\n"
             "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
             "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringDataType>BRDF</ScatteringDataType>\n"
             "<ScatteringData>\n";
      grid->Write(out, block);
      out << "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n";
    }
    out << "</Layer>\n</Optical>\n</WindowElement>\n";
  });
}

}  // namespace lobefit

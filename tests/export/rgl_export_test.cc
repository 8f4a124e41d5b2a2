// The exported RGL tables, read by a reader written here from the format's description alone (container, warp, value):
// how far the tabulated material is from the fit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include "tests/export/materials.h"
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/export.h"
#include "lobefit/export/targets.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

// Name -> float32 values and shape; bytes become floats.
struct Tensor {
  std::vector<std::size_t> shape;
  std::vector<double> data;
};

template <class T>
T At(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::map<std::string, Tensor> ReadTensors(std::string_view bytes) {
  EXPECT_EQ(bytes.substr(0, 12), std::string_view("tensor_file\0", 12));
  EXPECT_EQ(bytes[12], 1);
  EXPECT_EQ(bytes[13], 0);
  std::map<std::string, Tensor> tensors;
  std::size_t at = 18;
  for (std::uint32_t field = 0; field < At<std::uint32_t>(bytes, 14); ++field) {
    const auto length = At<std::uint16_t>(bytes, at);
    const std::string name(bytes.substr(at + 2, length));
    at += 2 + length;
    const auto dimensions = At<std::uint16_t>(bytes, at);
    const auto type = At<std::uint8_t>(bytes, at + 2);
    const auto offset = At<std::uint64_t>(bytes, at + 3);
    at += 11;
    Tensor tensor;
    std::size_t count = 1;
    for (int d = 0; d < dimensions; ++d, at += 8) {
      tensor.shape.push_back(At<std::uint64_t>(bytes, at));
      count *= tensor.shape.back();
    }
    EXPECT_EQ(offset % 8, 0U) << name << " is mapped in place";
    for (std::size_t i = 0; i < count; ++i) {
      tensor.data.push_back(type == 10 ? static_cast<double>(At<float>(bytes, offset + 4 * i))
                                       : At<std::uint8_t>(bytes, offset + i));
    }
    tensors[name] = std::move(tensor);
  }
  return tensors;
}

double BilinearAt(const double* grid, std::size_t height, std::size_t width, double x, double y) {
  const double px = std::clamp(x, 0.0, 1.0) * static_cast<double>(width - 1);
  const double py = std::clamp(y, 0.0, 1.0) * static_cast<double>(height - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(px), width - 2),
                    j = std::min(static_cast<std::size_t>(py), height - 2);
  const double s = px - static_cast<double>(i), t = py - static_cast<double>(j);
  const double* g = grid + j * width + i;
  return (1 - t) * ((1 - s) * g[0] + s * g[1]) + t * ((1 - s) * g[width] + s * g[width + 1]);
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path, const char* values)
      : tensors_(ReadTensors(FileBytes(path).bytes())), spectra_(tensors_.at(values)) {
    const Tensor& vndf = tensors_.at("vndf");
    height_ = vndf.shape[2], width_ = vndf.shape[3];
    // Each slice integrates to 1 over the square, by the trapezoidal rule of a bilinear function.
    const std::size_t size = height_ * width_;
    density_ = vndf.data;
    for (std::size_t slice = 0; slice * size < density_.size(); ++slice) {
      double sum = 0;
      for (std::size_t j = 0; j < height_; ++j) {
        for (std::size_t i = 0; i < width_; ++i) {
          const double edge = (i == 0 || i + 1 == width_ ? 0.5 : 1) * (j == 0 || j + 1 == height_ ? 0.5 : 1);
          sum += edge * density_[slice * size + j * width_ + i];
        }
      }
      EXPECT_GT(sum, 0);
      const double scale = static_cast<double>((width_ - 1) * (height_ - 1)) / sum;
      for (std::size_t k = 0; k < size; ++k) density_[slice * size + k] *= scale;
    }
  }

  const std::map<std::string, Tensor>& tensors() const { return tensors_; }

  // f_r of every channel; t is the table's direction (the viewer), s the light.
  std::vector<double> Evaluate(const Vec3& t, const Vec3& s) const {
    const Vec3 m = Normalized(t + s);
    const double ux = std::sqrt(2 * PolarAngle(m) / kPi), tx = std::sqrt(2 * PolarAngle(t) / kPi);
    double uy = (Azimuth(m) + kPi) / (2 * kPi), ty = (Azimuth(t) + kPi) / (2 * kPi);
    uy -= std::floor(uy);
    // The four slices about t and their weights.
    std::array<std::size_t, 4> slices = {};
    std::array<double, 4> weights = {};
    const Tensor &phi = tensors_.at("phi_i"), &theta = tensors_.at("theta_i");
    const auto place = [](const std::vector<double>& nodes, double v, double* share) {
      std::size_t k = 0;
      while (k + 2 < nodes.size() && nodes[k + 1] <= v) ++k;
      *share = std::clamp((v - nodes[k]) / (nodes[k + 1] - nodes[k]), 0.0, 1.0);
      return k;
    };
    double p = 0, q = 0;
    const std::size_t a = place(phi.data, Azimuth(t), &p), b = place(theta.data, PolarAngle(t), &q);
    for (std::size_t k = 0; k < 4; ++k) {
      slices[k] = (a + k / 2) * theta.data.size() + b + k % 2;
      weights[k] = (k / 2 == 1 ? p : 1 - p) * (k % 2 == 1 ? q : 1 - q);
    }
    std::vector<double> grid(width_ * height_);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < grid.size(); ++i) grid[i] += weights[k] * density_[slices[k] * grid.size() + i];
    }
    // Cumulative distributions of the bilinear density: rows first, then along the row.
    std::vector<double> rows(height_);
    for (std::size_t j = 0; j < height_; ++j) {
      for (std::size_t i = 0; i + 1 < width_; ++i) {
        rows[j] += (grid[j * width_ + i] + grid[j * width_ + i + 1]) / 2 / static_cast<double>(width_ - 1);
      }
    }
    const auto cumulative = [](const std::vector<double>& nodes, double x) {
      const double position = x * static_cast<double>(nodes.size() - 1);
      const std::size_t cell = std::min(static_cast<std::size_t>(position), nodes.size() - 2);
      const double share = position - static_cast<double>(cell);
      double below = 0, all = 0;
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const double area = (nodes[k] + nodes[k + 1]) / 2;
        all += area;
        if (k < cell) below += area;
      }
      return (below + share * nodes[cell] + share * share / 2 * (nodes[cell + 1] - nodes[cell])) / all;
    };
    const double py = cumulative(rows, uy);
    const double row = uy * static_cast<double>(height_ - 1);
    const std::size_t j = std::min(static_cast<std::size_t>(row), height_ - 2);
    const double share = row - static_cast<double>(j);
    std::vector<double> line(width_);
    for (std::size_t i = 0; i < width_; ++i) {
      line[i] = (1 - share) * grid[j * width_ + i] + share * grid[(j + 1) * width_ + i];
    }
    const double px = cumulative(line, ux);

    const Tensor &ndf = tensors_.at("ndf"), &sigma = tensors_.at("sigma");
    const double factor = BilinearAt(ndf.data.data(), ndf.shape[0], ndf.shape[1], ux, uy) /
                          (4 * BilinearAt(sigma.data.data(), sigma.shape[0], sigma.shape[1], tx, ty)) / s.z;
    const std::size_t side = spectra_.shape[3], channels = spectra_.shape[2];
    std::vector<double> values(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double* table = spectra_.data.data() + (slices[k] * channels + c) * side * side;
        values[c] += weights[k] * BilinearAt(table, side, side, px, py) * factor;
      }
    }
    return values;
  }

 private:
  std::map<std::string, Tensor> tensors_;
  const Tensor& spectra_;
  std::size_t height_ = 0, width_ = 0;
  std::vector<double> density_;
};

double Quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class RglExport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("rgl_export_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ExportResult Export(const SyntheticCase& synthetic) const {
    ExportOptions options;
    options.targets = {&FindTarget("rgl")};
    options.folder = folder_;
    options.name = "sample";
    options.threads = 2;
    return ExportMaterial(test::MaterialOf(synthetic), options).results[0];
  }

  // Values and albedos of the rgb file against the fit.
  void CheckErrors(SyntheticCase synthetic, const std::string& name) {
    synthetic.model.lobes[0].masking = Masking::kSmithHeight;
    const ExportResult result = Export(synthetic);
    const TableReader reader(folder_ / "sample_rgb.bsdf", "rgb");
    EXPECT_EQ(reader.tensors().count("wavelengths"), 0U);
    EXPECT_EQ(reader.tensors().at("jacobian").data, std::vector<double>{1});
    const FittedBrdf fit(test::MaterialOf(synthetic));
    const BrdfFunction exact = fit.function();

    std::mt19937 engine(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto direction = [&](double most) {
      return FromSpherical(std::acos(1 - uniform(engine) * (1 - std::cos(DegreesToRadians(most)))),
                           2 * kPi * uniform(engine));
    };
    std::vector<double> errors;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 t = direction(75), s = direction(80);
      std::array<double, 3> wanted = {};
      exact(s, t, wanted.data());
      const std::vector<double> found = reader.Evaluate(t, s);
      for (std::size_t c = 0; c < 3; ++c) errors.push_back(std::fabs(found[c] / wanted[c] - 1));
    }
    EXPECT_LE(Quantile(errors, 0.5), 0.006) << name;
    EXPECT_LE(Quantile(errors, 0.9), 0.025) << name;
    RecordProperty(name + "_median_percent", std::to_string(100 * Quantile(errors, 0.5)));
    RecordProperty(name + "_percentile_90_percent", std::to_string(100 * Quantile(errors, 0.9)));
    RecordProperty(name + "_bytes", std::to_string(result.bytes));
    RecordProperty(name + "_seconds", std::to_string(result.seconds));

    for (const double theta : {15.0, 50.0, 70.0}) {
      const Vec3 t = FromSpherical(DegreesToRadians(theta), 0.7);
      double table = 0, fitted = 0;
      constexpr int kRings = 60, kSteps = 120;
      for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < kSteps; ++j) {
          const Vec3 s = FromSpherical(std::asin(std::sqrt((i + 0.5) / kRings)), 2 * kPi * (j + 0.5) / kSteps);
          std::array<double, 3> wanted = {};
          exact(s, t, wanted.data());
          fitted += wanted[0];
          table += reader.Evaluate(t, s)[0];
        }
      }
      EXPECT_NEAR(table / fitted, 1, 0.01) << name << ' ' << theta;
    }
  }

  std::filesystem::path folder_;
};

// Tilted, rotated, anisotropic: widths 0.35 and 0.15, 14 degrees of tilt, turned by half a radian; and brushed metal of
// aspect 1:3.2.
TEST_F(RglExport, TiltedRotatedAnisotropicFits) {
  CheckErrors(OneLobe(Ndf::kEllipsoid, 0.35, 0.15, 10, -10, 28.6, {0.6, 0.5, 0.4}, {0.1, 0.1, 0.1}), "turned");
  CheckErrors(OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25, {0.71, 0.66, 0.58}, {0.02, 0.018, 0.015}), "brushed");
}

// The spectrum's R, G, B under the standard observer are the fit's.
TEST_F(RglExport, SpectrumHasTheColours) {
  Export(test::Plastic());
  const TableReader reader(folder_ / "sample_spec.bsdf", "spectra");
  Channels channels;
  for (const double nm : reader.tensors().at("wavelengths").data) {
    channels.wavelengths_nm.push_back(nm);
    channels.names.push_back(std::to_string(nm));
  }
  ASSERT_GE(channels.size(), 8U);
  EXPECT_EQ(reader.tensors().at("phi_i").data.size(), 1U) << "isotropic";
  const ChannelMap to_rgb = MakeChannelMap("rgb", channels);
  // One azimuth in the table, and the reader above needs two: both files are compared node by node.
  const Tensor& spectra = reader.tensors().at("spectra");
  const std::size_t nodes = spectra.shape[3] * spectra.shape[4], node = nodes / 2;
  std::vector<double> spectrum;
  for (std::size_t c = 0; c < channels.size(); ++c) spectrum.push_back(spectra.data[c * nodes + node]);
  std::array<double, 3> rgb = {}, fitted = {};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < spectrum.size(); ++k) rgb[c] += to_rgb.matrix[c][k] * spectrum[k];
  }
  const TableReader colours(folder_ / "sample_rgb.bsdf", "rgb");
  const Tensor& table = colours.tensors().at("rgb");
  for (std::size_t c = 0; c < 3; ++c) fitted[c] = table.data[c * nodes + node];
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c] / fitted[c], 1, 1e-5) << c;
}

}  // namespace
}  // namespace lobefit

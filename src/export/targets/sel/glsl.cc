#include "lobefit/export/targets/sel/glsl.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/shader_text.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {
namespace {

constexpr const char* kEvaluation =
#include "lobefit/export/targets/sel/sel.glsl.inc"
    ;

std::string Array(const char* type, const char* name, const std::vector<std::string>& values) {
  std::string text = fmt::format("const {0} {1}[{2}] = {0}[{2}](", type, name, values.size());
  constexpr std::size_t kInLine = 10;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) text += ",";
    text += (k % kInLine == 0 && values.size() > kInLine ? "\n  " : k > 0 ? " " : "") + values[k];
  }
  return text + ");\n";
}

// The slices in the order of the rings. Widths as the matrix of their logarithms, in which the table interpolates:
// mean, and half the difference times cosine and sine of twice psi.
std::string TableText(const SelReflectance& reflectance) {
  const SelTable& table = reflectance.table();
  std::vector<std::string> theta, begin = {"0"}, phi, shape, level;
  for (const SelReflectance::Ring& ring : reflectance.rings()) {
    theta.push_back(FloatLiteral(ring.theta));
    for (const std::size_t s : ring.slices) {
      const SelSlice& slice = table.slices[s];
      phi.push_back(FloatLiteral(slice.phi_i - 2 * kPi * std::floor(slice.phi_i / (2 * kPi))));
      for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
        const SelShape& lobe = slice.lobes[l];
        const double x = std::log(lobe.alpha_x), y = std::log(lobe.alpha_y);
        for (const double value : {0.5 * (x + y), 0.5 * (x - y) * std::cos(2 * lobe.psi),
                                   0.5 * (x - y) * std::sin(2 * lobe.psi), lobe.offset_in, lobe.offset_across}) {
          shape.push_back(FloatLiteral(value));
        }
        for (const double amplitude : slice.amplitude[l]) level.push_back(FloatLiteral(amplitude));
      }
      for (const double constant : slice.constant) level.push_back(FloatLiteral(constant));
    }
    begin.push_back(std::to_string(phi.size()));
  }
  std::string text = fmt::format(
      "const int lobefit_rings = {}, lobefit_lobes = {}, lobefit_channels = {};\n"
      "// Whether the table holds f_r cos_theta_o, and whether the lobes of the first ring keep to the surface's "
      "axes.\n"
      "const bool lobefit_times_cosine = {}, lobefit_fixed_normal = {};\n",
      theta.size(), table.slices[0].lobes.size(), reflectance.channels(), table.quantity == SelQuantity::kBrdfCosineO,
      reflectance.rings()[0].fixed);
  text += "// Rings of equal theta_i, radians; the first slice of each; phi_i of each slice.\n";
  text += Array("float", "lobefit_ring_theta", theta) + Array("int", "lobefit_ring_begin", begin) +
          Array("float", "lobefit_slice_phi", phi);
  text +=
      "// Five numbers a slice and lobe: mean of the logarithms of the widths, half their difference times cosine and\n"
      "// sine of twice the orientation, offset in and across the plane of incidence.\n" +
      Array("float", "lobefit_shape", shape);
  return text + "// A slice: amplitudes a lobe and channel, then the constants.\n" +
         Array("float", "lobefit_level", level);
}

std::string BoundName(const SelTable& table) {
  return table.quantity == SelQuantity::kBrdfCosineO ? "f_r_cos_bound" : "f_r_bound";
}

// The two functions for R G B or grey as vec3, or for other channels as arrays.
std::string Interface(const SelTable& table, const Channels& channels, bool rgb_or_grey) {
  const bool cosine = table.quantity == SelQuantity::kBrdfCosineO;
  const std::string contract = fmt::format(
      "// f_r in 1/sr, without a cosine. wi points to the light, wo to the viewer, unit vectors in the frame of\n"
      "// tangent, bitangent and normal.\n");
  const std::string bound_contract = fmt::format(
      "// {} is at most this at every wo within half_angle (radians) of the unit vector axis; as tight as 1 % a lobe\n"
      "// but for lobes very narrow against the cone.\n",
      cosine ? "f_r cos(theta_o)" : "f_r");
  const std::string bound_name = "lobefit_" + BoundName(table);
  if (!rgb_or_grey) {
    const std::size_t n = channels.size();
    return fmt::format(
        "{}// Channels: {}\nvoid lobefit_f_r(vec3 wi, vec3 wo, out float f_r[{}]) {{ lobefit_table_f_r(wi, wo, f_r); "
        "}}\n"
        "{}void {}(vec3 wi, vec3 axis, float half_angle, out float bound[{}]) {{\n"
        "  lobefit_table_bound(wi, axis, half_angle, bound);\n}}\n",
        contract, Join(channels.names), n, bound_contract, bound_name, n);
  }
  const std::string values = channels.size() == 1 ? "vec3(x[0])" : "vec3(x[0], x[1], x[2])";
  return fmt::format(
      "{0}vec3 lobefit_f_r(vec3 wi, vec3 wo) {{\n  float x[lobefit_channels];\n  lobefit_table_f_r(wi, wo, x);\n"
      "  return {1};\n}}\n{2}vec3 {3}(vec3 wi, vec3 axis, float half_angle) {{\n  float x[lobefit_channels];\n"
      "  lobefit_table_bound(wi, axis, half_angle, x);\n  return {1};\n}}\n",
      contract, values, bound_contract, bound_name);
}

}  // namespace

std::string SelGlslText(const SelReflectance& reflectance, const Channels& channels, const std::string& name,
                        const std::vector<std::string>& header) {
  const std::string prefix = GlslPrefix(name);
  std::string text =
      TableText(reflectance) + kEvaluation + Interface(reflectance.table(), channels, IsRgbOrGrey(channels));
  text = Replaced(text, "lobefit_", prefix);
  text = Replaced(text, "Lobefit", "Lobefit_" + prefix.substr(std::string("lobefit_").size()));
  const std::string bound = BoundName(reflectance.table());
  return CommentLines(header, "//") + text + GlslShortName("f_r", prefix + "f_r") +
         GlslShortName(bound, prefix + bound);
}

}  // namespace lobefit

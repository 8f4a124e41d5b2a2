// [Loubet] integrals of the GGX slope distribution over triangles, and sampling inside them.
#include "lobefit/core/slopes/slope_integral.h"
#include "lobefit/core/slopes/slope_sampling.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

Quantity TriangleQuantity() {
  Quantity q;
  q.name = "triangle_ggx";
  q.description = "integral of the centred GGX slope distribution over a triangle of slopes";
  q.source = "[Loubet] after eq 12, stable form";
  q.inputs = {Positive("alpha_x", "roughness along x"), Positive("alpha_y", "roughness along y")};
  for (const char* vertex : {"p0", "p1", "p2"}) {
    q.inputs.push_back(AnyNumber(std::string(vertex) + "x", "1", "slope of a corner along x"));
    q.inputs.push_back(AnyNumber(std::string(vertex) + "y", "1", "slope of a corner along y"));
  }
  q.results = {{"integral", "1", "integral, whatever the orientation of the triangle"}};
  AddDerivatives(&q, "integral", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    GgxTriangleGradient g;
    out[0] = GgxTriangleIntegral({Vec2{in[2], in[3]}, Vec2{in[4], in[5]}, Vec2{in[6], in[7]}}, in[0], in[1], &g);
    out[1] = g.dalpha_x;
    out[2] = g.dalpha_y;
    for (std::size_t i = 0; i < 3; ++i) {
      out[3 + 2 * i] = g.dvertices[i].x;
      out[4 + 2 * i] = g.dvertices[i].y;
    }
  };
  return q;
}

Quantity TruncatedRadiusQuantity() {
  Quantity q;
  q.name = "truncated_radius";
  q.description = "radius of a GGX slope drawn between two radii";
  q.source = "[Loubet] eq 16-19, corrected";
  q.inputs = {Positive("alpha", "roughness"), AnyNumber("r_min", "1", "smallest radius"),
              AnyNumber("r_max", "1", "largest radius, at least r_min"),
              Within("V", "1", "uniform random number", 0, 1)};
  q.inputs[1].low = q.inputs[2].low = 0;
  q.results = {{"N_R", "1", "integral of r P dr between the radii, eq 17"}, {"s_r", "1", "radius, eq 19"}};
  for (const char* input : {"alpha", "rmin", "rmax", "V"}) {
    q.results.push_back({std::string("ds_d") + input, "1", ""});
  }
  q.check = [](const double* in) -> std::optional<DomainError> {
    if (in[1] <= in[2]) return std::nullopt;
    return DomainError{2, "the largest radius is smaller than r_min; allowed: r_max >= r_min"};
  };
  q.evaluate = [](const double* in, double* out) {
    TruncatedRadiusGradient g;
    out[0] = TruncatedRadiusMass(in[0], in[1], in[2]);
    out[1] = TruncatedRadius(in[0], in[1], in[2], in[3], &g);
    out[2] = g.dalpha;
    out[3] = g.dr_min;
    out[4] = g.dr_max;
    out[5] = g.dv;
  };
  return q;
}

}  // namespace

std::vector<Quantity> LoubetQuantities() { return {TriangleQuantity(), TruncatedRadiusQuantity()}; }

}  // namespace lobefit

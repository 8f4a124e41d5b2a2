// [SEL] squared spheroidal and ellipsoidal lobes.
#include "lobefit/core/sel/sel.h"
#include "lobefit/math/rotation.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

Quantity SslQuantity() {
  Quantity q;
  q.name = "ssl";
  q.description = "squared spheroidal lobe";
  q.source = "[SEL] first equation";
  q.inputs = {Within("alpha", "1", "roughness", 0, 1, true), Within("theta", "rad", "angle from the axis", 0, kPi)};
  q.results = {{"K", "1", "lobe, 1 on its axis"}};
  AddDerivatives(&q, "K", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) { out[0] = Ssl(in[0], in[1], out + 1, out + 2); };
  return q;
}

std::vector<InputColumn> SelAlphas() {
  return {Within("alpha_x", "1", "roughness along the first axis", 0, 1, true),
          Within("alpha_y", "1", "roughness along the second axis", 0, 1, true)};
}

Quantity SelQuantity() {
  Quantity q;
  q.name = "sel";
  q.description = "squared ellipsoidal lobe; the derivatives by the alphas are nan where these are equal";
  q.source = "[SEL] last equation";
  q.inputs = SelAlphas();
  for (const char* name : {"rot_x", "rot_y", "rot_z"}) {
    q.inputs.push_back(AnyNumber(name, "rad", "rotation vector from the world to the lobe"));
  }
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "w", "direction in the world");
  q.results = {{"vx", "1", "direction in the lobe's frame, x"},
               {"vy", "1", "direction in the lobe's frame, y"},
               {"vz", "1", "direction in the lobe's frame, z"},
               {"K", "1", "lobe, 1 on its axis"}};
  AddDerivatives(&q, "K", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Vec3 rotation = {in[2], in[3], in[4]}, w = {in[5], in[6], in[7]};
    // Near the axis of a narrow lobe K hangs on components of v that are small differences.
    const Vec3 v = RotatedDirectionToTheUlp(rotation, w);
    SelGradient g;
    Sel(in[0], in[1], rotation, DirectionAt(in + 5), &g);
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
    out[3] = SelLobe(in[0], in[1], v);
    out[4] = g.dalpha_x;
    out[5] = g.dalpha_y;
    out[6] = g.drotation.x;
    out[7] = g.drotation.y;
    out[8] = g.drotation.z;
  };
  return q;
}

Quantity SelIntegralQuantity() {
  Quantity q;
  q.name = "sel_integral";
  q.description = "integral of the squared ellipsoidal lobe; the derivatives are nan where the alphas are equal";
  q.source = "[SEL] with Carlson's elliptic integrals";
  q.inputs = SelAlphas();
  q.results = {{"integral", "sr", "integral of K over the sphere"}};
  AddDerivatives(&q, "integral", "sr", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) { out[0] = SelIntegral(in[0], in[1], out + 1, out + 2); };
  return q;
}

}  // namespace

std::vector<Quantity> SelQuantities() { return {SslQuantity(), SelQuantity(), SelIntegralQuantity()}; }

}  // namespace lobefit

// Building blocks of the tables of quantities, one of which each paper's file holds.
#pragma once

#include <string>
#include <vector>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/radial/slope_distribution.h"
#include "lobefit/core/radial/smith.h"
#include "lobefit/math/vec.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit {

// Of differences of numbers that are nearly equal.
using Real = long double;

// The parts of Quantities().
std::vector<Quantity> WalterQuantities();
std::vector<Quantity> HeitzQuantities();
std::vector<Quantity> SelQuantities();
std::vector<Quantity> DEonQuantities();
std::vector<Quantity> LoubetQuantities();
std::vector<Quantity> InstrumentQuantities();
std::vector<Quantity> ProfileQuantities();
std::vector<Quantity> LayerQuantities();

// Input columns.
InputColumn Positive(const std::string& name, const std::string& meaning);
InputColumn AnyNumber(const std::string& name, const std::string& unit, const std::string& meaning);
InputColumn Within(const std::string& name, const std::string& unit, const std::string& meaning, double low,
                   double high, bool low_open = false, bool high_open = false);
std::vector<InputColumn> EllipsoidColumns();
std::vector<InputColumn> SlopeShapeColumns();  // alpha_x, alpha_y, r, slope_x, slope_y
std::vector<InputColumn> SlopeColumns();       // kind, then those five
// Results c, q, a, Lambda, sigma.
std::vector<ResultColumn> MaskingColumns();

// Appends the three columns of a direction to the quantity.
void AddDirection(Quantity* quantity, const std::string& prefix, const std::string& meaning);
// The same for a direction that must be above the horizon.
void AddUpperDirection(Quantity* quantity, const std::string& prefix, const std::string& meaning);
// Appends d<value>_d<x> for the inputs named, with the unit of the one over that of the other. By
// value: the names may be those of the quantity's own columns.
void AddDerivatives(Quantity* quantity, std::string value, std::string value_unit,
                    const std::vector<std::string>& inputs);
// All inputs that are neither words nor directions.
std::vector<std::string> ParameterNames(const Quantity& quantity);

// Values from consecutive inputs.
inline Ellipsoid EllipsoidAt(const double* in) { return {in[0], in[1], in[2], in[3], in[4]}; }
inline SlopeDistribution SlopesAt(const double* in) {
  return {in[0] == 0 ? Family::kBeckmann : Family::kGgx, in[1], in[2], in[3], in[4], in[5]};
}
// The unit vector, rounded once.
Vec3 DirectionAt(const double* in);
// c, q, a of smith.h for the five of a slope distribution and a direction, which is normalised and summed in extended
// precision: the terms of c cancel where the mean surface is seen edge-on, and steep tails hang on the last digits of
// a.
ProjectedSlopes ExtendedProjection(const double* slopes, const double* u);

}  // namespace lobefit

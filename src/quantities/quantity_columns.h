// Building blocks of the tables of quantities, one of which each paper's file holds.
#pragma once

#include <string>
#include <vector>

#include "lobefit/core/ndf/ellipsoid.h"
#include "lobefit/core/ndf/slope_distribution.h"
#include "lobefit/math/vec.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit {

// The parts of Quantities().
std::vector<Quantity> WalterQuantities();
std::vector<Quantity> HeitzQuantities();
std::vector<Quantity> SelQuantities();
std::vector<Quantity> DEonQuantities();
std::vector<Quantity> LoubetQuantities();
std::vector<Quantity> InstrumentQuantities();

// Input columns.
InputColumn Positive(const std::string& name, const std::string& meaning);
InputColumn AnyNumber(const std::string& name, const std::string& unit, const std::string& meaning);
InputColumn Within(const std::string& name, const std::string& unit, const std::string& meaning, double low,
                   double high, bool low_open = false, bool high_open = false);
std::vector<InputColumn> EllipsoidColumns();
std::vector<InputColumn> SlopeColumns();  // kind, then the five of a slope distribution

// Appends the three columns of a direction to the quantity.
void AddDirection(Quantity* quantity, const std::string& prefix, const std::string& meaning);
// Appends d<value>_d<x> for the inputs named, with the unit of the one over that of the other. By
// value: the names may be those of the quantity's own columns.
void AddDerivatives(Quantity* quantity, std::string value, std::string value_unit,
                    const std::vector<std::string>& inputs);
// All inputs that are neither words nor directions.
std::vector<std::string> ParameterNames(const Quantity& quantity);

// Values from consecutive inputs.
inline Ellipsoid EllipsoidAt(const double* in) { return {in[0], in[1], in[2], in[3], in[4]}; }
inline SlopeDistribution SlopesAt(const double* in) {
  return {in[0] == 0 ? SlopeKind::kBeckmann : SlopeKind::kGgx, in[1], in[2], in[3], in[4], in[5]};
}
// The unit vector, rounded once.
Vec3 DirectionAt(const double* in);

}  // namespace lobefit

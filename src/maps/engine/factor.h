// Systems of a few unknowns.
#pragma once

#include "lobefit/maps/engine/kernels.h"

namespace lobefit {

// L D L^T = the part of `matrix` (read from the diagonal up) whose unknowns are not held, in place: D L^T above the
// diagonal, which holds 1 / D, L below; rows and columns of held ones become those of the identity. False where it is
// not positive definite. Domain: 1 to kMostUnknowns unknowns.
bool Factorise(int unknowns, const std::array<bool, kMostUnknowns>& held, MapMatrix* matrix);
void SolveFactorised(int unknowns, const MapMatrix& factor, MapVector* x);
// The inverse; 0 in rows and columns of held unknowns.
MapMatrix InverseOf(int unknowns, const std::array<bool, kMostUnknowns>& held, const MapMatrix& factor);

}  // namespace lobefit

// The words by which users and file headers choose what a file leaves open.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lobefit/io/read.h"

namespace lobefit {

// Case does not matter; nothing for a word that is not known.
std::optional<AngleUnit> ParseAngleUnit(std::string_view word);          // deg, degrees, rad, radians
std::optional<ValueKind> ParseValueKind(std::string_view word);          // see AllowedValueKinds()
std::optional<IncidentSense> ParseIncidentSense(std::string_view word);  // towards, propagation
std::optional<CellPosition> ParseCellPosition(std::string_view word);    // centre, center, edge
std::string AllowedValueKinds();

std::string Name(AngleUnit unit);
std::string Name(ValueKind kind);
std::string Name(IncidentSense sense);
std::string Name(CellPosition position);

// f_r / value. A direction at or below the horizon, which is set aside anyway, gives 1 for its cosine.
double BrdfFactor(ValueKind kind, double cos_theta_i, double cos_theta_o);

}  // namespace lobefit

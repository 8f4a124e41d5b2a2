// Angles as a file states them, checked for what the directions no longer show: a unit that is not said, names that are
// exchanged.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace lobefit {

// Least and largest number of each angle, in degrees as the file was read, by name: theta_i, phi_i, theta_o, phi_o,
// dphi.
using StatedAngles = std::map<std::string, std::pair<double, double>>;

// A remark, with the option that cures it, for each of these that holds:
// - every polar angle is below 1.6 degrees and every azimuth within 6.3 (radians); or azimuths alone are, or one of the
//   two polar angles;
// - polar angles run beyond 100 degrees beside azimuths within 90, or the light stands still in theta and moves in phi;
// - without azimuths the viewer's angle runs from less than 80 degrees to more than 100 (counted from the surface).
std::vector<std::string> FindImplausibleAngles(const StatedAngles& angles, std::size_t rows);

}  // namespace lobefit

#include "lobefit/io/csv/rows/stated_angles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace lobefit {
namespace {

using Range = std::pair<double, double>;

std::optional<Range> Find(const StatedAngles& angles, const char* name) {
  const auto found = angles.find(name);
  return found == angles.end() ? std::nullopt : std::optional(found->second);
}

double Size(const Range& range) { return std::max(std::fabs(range.first), std::fabs(range.second)); }

std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::optional<std::string> CheckRadians(const Range& theta_i, const Range& theta_o, const std::optional<Range>& phi) {
  const bool azimuths_small = !phi || Size(*phi) <= 6.3;
  if (Size(theta_i) < 1.6 && Size(theta_o) < 1.6 && Size(theta_o) > 0.2 && azimuths_small) {
    return "all polar angles are below 1.6 degrees" + std::string(phi ? " and all azimuths within 6.3" : "") +
           ": are they radians? --angle-unit rad";
  }
  // Of one polar angle alone: it moves through more than 57 degrees if these are radians, and through one if they are
  // not.
  const auto one_alone = [](const Range& angle, const Range& other, const std::string& name) -> std::string {
    if (!(Size(other) >= 10 && Size(angle) < 1.6 && angle.second - angle.first > 1)) return "";
    return "the other polar angle runs to " + Short(Size(other)) + " degrees, but " + name + " only to " +
           Short(Size(angle)) + ": is it in radians? Write the unit into its name, or use --columns \"" + name +
           " (rad)=NAME\"";
  };
  for (const std::string& remark : {one_alone(theta_o, theta_i, "theta_o"), one_alone(theta_i, theta_o, "theta_i")}) {
    if (!remark.empty()) return remark;
  }
  if (phi && Size(theta_o) > 6.3 && azimuths_small && phi->second - phi->first > 1.5) {
    return "polar angles run to " + Short(Size(theta_o)) + " degrees, but azimuths only to " + Short(Size(*phi)) +
           ": are the azimuths radians? Write the unit into their names, or use --columns \"phi_o (rad)=NAME\"";
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> FindImplausibleAngles(const StatedAngles& angles, std::size_t rows) {
  const std::optional<Range> theta_i = Find(angles, "theta_i"), theta_o = Find(angles, "theta_o"),
                             phi_i = Find(angles, "phi_i");
  const bool relative = angles.count("phi_o") == 0;
  const std::optional<Range> phi = Find(angles, relative ? "dphi" : "phi_o");
  const std::string phi_name = relative ? "dphi" : "phi_o";
  std::vector<std::string> remarks;
  if (!theta_i || !theta_o || rows < 8) return remarks;
  if (const std::optional<std::string> radians = CheckRadians(*theta_i, *theta_o, phi)) remarks.push_back(*radians);
  if (phi && Size(*theta_o) > 100 && Size(*phi) <= 90) {
    remarks.push_back("theta_o runs to " + Short(Size(*theta_o)) + " degrees and " + phi_name + " only to " +
                      Short(Size(*phi)) +
                      ": are the names of polar angle and azimuth exchanged? --columns theta_o=NAME," + phi_name +
                      "=NAME says which is which");
  }
  // In a plane from one side of the surface to the other, through the normal at 90.
  if (!phi && !phi_i && theta_o->first >= 0 && theta_o->first < 80 && theta_o->second > 100) {
    remarks.push_back("theta_o runs from " + Short(theta_o->first) + " to " + Short(theta_o->second) +
                      " degrees without an azimuth, and directions beyond 90 are set aside: are angles counted from "
                      "the surface? --columns \"elevation_i=NAME,elevation_o=NAME\"");
  }
  const bool still = theta_i->second - theta_i->first < 1e-9, moves = phi_i && phi_i->second - phi_i->first > 5;
  // At another angle a sample was turned under the light, as it should be.
  if (still && moves && Size(*phi_i) <= 90 && Size(*theta_i) < 1e-9) {
    remarks.push_back("theta_i is 0 throughout and phi_i runs from " + Short(phi_i->first) + " to " +
                      Short(phi_i->second) +
                      ": are the names exchanged? --columns theta_i=NAME,phi_i=NAME says which is which");
  }
  return remarks;
}

}  // namespace lobefit

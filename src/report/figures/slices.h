// Slices of a measurement in the plane of incidence: one direction stays, the other sweeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Samples grouped by the direction that stays while the other one sweeps.
struct Staying {
  // The direction that stays is wo (a fixed detector and a moving source, or a table by viewing direction) and not wi.
  bool outgoing = false;
  // Gathered to whole degrees, because the table lists no directions (isotropic tables over half and difference
  // angles).
  bool gathered = false;
  double resolution = 0;  // radians
  // group[sample] is an index into `directions`, which are ordered by polar angle, then azimuth; azimuth 0 where
  // isotropic.
  std::vector<std::uint32_t> group;
  std::vector<Vec3> directions;
};
Staying GroupByStayingDirection(const Measurement& measurement);

struct SlicePoint {
  double theta =
      0;  // signed polar angle of the sweeping direction, radians; positive on the side of the mirror direction
  std::size_t sample = 0;  // index into the measurement
};

struct Slice {
  double theta = 0;                // of the direction that stays, radians
  double phi = 0;                  // its azimuth; 0 for an isotropic measurement
  std::vector<SlicePoint> points;  // ascending
};

struct Slices {
  bool outgoing_stays = false;
  bool gathered = false;
  // Samples are taken as in the plane up to this angle from it, radians.
  double tolerance = 0;
  // Ordered by azimuth, then polar angle.
  std::vector<Slice> slices;
};

// Every slice that holds at least `fewest` samples. Measured tables without a list of incidences (isotropic ones) are
// gathered within half a degree of whole degrees; their points are moved along the slice by as much as theta_i was
// moved, so that theta_h is kept.
Slices GatherSlices(const Measurement& measurement, const Staying& staying, std::size_t fewest = 6);

// At most rows x columns of them, spread over azimuths (rows, where there are several) and polar angles; `*rows_used`
// and
// `*columns_used` say in what arrangement. One azimuth: polar angles run on over the rows.
std::vector<const Slice*> ChooseSlices(const Slices& slices, std::size_t rows, std::size_t columns,
                                       std::size_t* rows_used, std::size_t* columns_used);

// Directions of a point of a slice: the one that stays and the one at the signed angle `theta`.
void SliceDirections(const Slices& slices, const Slice& slice, double theta, Vec3* wi, Vec3* wo);

}  // namespace lobefit

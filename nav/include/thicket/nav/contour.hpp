// The nearest matter in every direction, as the robot's sensor tells it.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "thicket/scan/scan.hpp"

namespace thicket {

/// A point of matter in the vehicle's frame.
struct ContourPoint {
  glm::dvec2 position{0.0, 0.0};  ///< m; meaningless where the distance is infinite
  double distance = 0.0;          ///< from the vehicle's axis, m; +inf: the beam has no echo
  double bearing = 0.0;           ///< rad in [-pi, pi], counter-clockwise from forward
};

/// One point a beam: its first echo, projected to the plane; of a beam with an opening, which may have met it anywhere in there, an arc of points. Whatever gives an echo is taken to stop motion: a
/// robot cannot know more. A sensor inside visible matter gives a point at the sensor.
using Contour = std::vector<ContourPoint>;

/// `contour` is overwritten; its memory is used again.
void read_contour(const Scan& scan, Contour& contour);

}  // namespace thicket

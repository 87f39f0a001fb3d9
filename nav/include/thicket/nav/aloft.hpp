// Scans of a vehicle that flies, as one that is level would have made them.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "thicket/scan/scan.hpp"

namespace thicket {

/// How a vehicle is in space, as it knows itself.
struct Aloft {
  glm::dquat tilt{1.0, 0.0, 0.0, 0.0};  ///< turns its own frame into the level one that looks the same way
  double altitude = 0.0;                ///< m, of its frame above the floor, which is at z = 0
};

/// What a contour is made of, with the mount in the level frame: beams and their first echoes, without profiles. An echo that can only be from the floor is left out: whatever of the beam's elevation opening gave it, it
/// lies no higher than 5 cm or three sigmas of the sensor's range noise. `level` is overwritten; its memory is used again.
void make_level(const Scan& scan, const Aloft& aloft, Scan& level);

}  // namespace thicket

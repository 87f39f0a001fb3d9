// The nearest matter in every direction, as the robot's sensors tell it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

inline constexpr std::uint32_t no_arc = std::numeric_limits<std::uint32_t>::max();

/// A point of matter in the vehicle's frame.
struct ContourPoint {
  glm::dvec2 position{0.0, 0.0};  ///< m; meaningless where the distance is infinite
  double distance = 0.0;          ///< from the vehicle's axis, m; +inf: the beam has no echo
  double bearing = 0.0;           ///< rad in [-pi, pi], counter-clockwise from forward
  std::uint32_t arc = no_arc;     ///< the same for all points of one arc: the matter is somewhere on it; `no_arc`: a point by itself
};

/// One point a beam: its first echo, projected to the plane; of a beam with an opening, which may have met it anywhere in there, an arc of points. Whatever gives an echo is taken to stop motion: a
/// robot cannot know more. A sensor inside visible matter gives a point at the sensor.
using Contour = std::vector<ContourPoint>;

/// Makes contours of the scans of one sensor. It remembers where the sensor's beams point, which is the same in every scan but for sensors with rays at random places.
class ContourReader {
 public:
  /// Adds the points of a scan that was made where the vehicle is now.
  void add(const Scan& scan, Contour& contour);
  /// The same of a scan that was made when the vehicle was at `then`, which is given in the vehicle's frame of now.
  void add(const Scan& scan, const Pose2& then, Contour& contour);

 private:
  /// A thin beam, seen from above in the vehicle's frame.
  struct Ray {
    glm::dvec2 along{0.0, 0.0};  ///< the part of its unit vector in the plane
    double flat = 1.0;           ///< the length of that
    double bearing = 0.0;        ///< rad
  };
  void learn(const Scan& scan);

  glm::dquat mount_{0.0, 0.0, 0.0, 0.0};  ///< the orientation that `rays_` are for; none at first
  double opening_ = 0.0;
  std::vector<glm::dvec3> directions_;    ///< of the beams that `rays_` are made of
  std::vector<Ray> rays_;                 ///< equally many for each of them
};

/// `contour` is overwritten with one scan's; its memory is used again. Where many scans of one sensor are read, a `ContourReader` does it faster.
void read_contour(const Scan& scan, Contour& contour);

}  // namespace thicket

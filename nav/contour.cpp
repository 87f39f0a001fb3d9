#include "thicket/nav/contour.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "fan.hpp"

namespace thicket {

void read_contour(const Scan& scan, Contour& contour) {
  constexpr double spacing = 0.035;  // rad, 2 degrees
  contour.clear();
  for (const Beam& beam : scan.beams) {
    const auto echoes = scan.echoes_of(beam);
    const bool sees = beam.starts_inside || !echoes.empty();
    const double range = beam.starts_inside || !sees ? 0.0 : echoes.front().range;
    for_fan(scan, beam, spacing, [&](const glm::dvec3& direction) {
      const glm::dvec3 along = scan.mount_orientation * direction;
      if (!sees) return contour.push_back({{0.0, 0.0}, std::numeric_limits<double>::infinity(), std::atan2(along.y, along.x)});
      const glm::dvec2 at(scan.mount_position + range * along);
      contour.push_back({at, glm::length(at), std::atan2(at.y, at.x)});
    });
  }
}

}  // namespace thicket

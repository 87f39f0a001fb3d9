#include "thicket/nav/contour.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace thicket {

void read_contour(const Scan& scan, Contour& contour) {
  contour.clear();
  for (const Beam& beam : scan.beams) {
    const glm::dvec3 along = scan.mount_orientation * beam.direction;
    double range = 0.0;
    if (!beam.starts_inside) {
      const auto echoes = scan.echoes_of(beam);
      if (echoes.empty()) {
        contour.push_back({{0.0, 0.0}, std::numeric_limits<double>::infinity(), std::atan2(along.y, along.x)});
        continue;
      }
      range = echoes.front().range;
    }
    const glm::dvec2 at(scan.mount_position + range * along);
    contour.push_back({at, glm::length(at), std::atan2(at.y, at.x)});
  }
}

}  // namespace thicket

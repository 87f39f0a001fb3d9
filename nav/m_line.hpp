// The M-line: the segment from where a boundary was hit, or from the start, to the goal. Private to the room.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "boundary_walk.hpp"

namespace thicket {

/// Whether the last step of a walk came upon the segment from `from` to `to`: by a change of side, so that neither a step across nor a steep line is missed; or to within `beside` m of it,
/// for a boundary that the line only touches is not crossed at all.
inline bool on_m_line(const BoundaryWalk& walk, const glm::dvec2& from, const glm::dvec2& to, double beside) {
  const glm::dvec2 line = to - from;
  const double length = glm::length(line);
  if (length == 0.0) return false;
  const auto side = [&](const glm::dvec2& p) { return (line.x * (p.y - from.y) - line.y * (p.x - from.x)) / length; };
  const double before = side(walk.previous()), after = side(walk.current());
  if ((before > 0.0) == (after > 0.0) && std::abs(after) > beside) return false;
  const double along = glm::dot(walk.current() - from, line) / length;
  return along > 0.0 && along < length;
}

}  // namespace thicket

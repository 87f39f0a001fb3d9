// The M-line. Private to the room.
#pragma once

#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "boundary_walk.hpp"

namespace thicket {

/// Where the last step of a walk crossed the segment from `from` to `to`: by a change of side, so that neither a step across nor a steep line is missed.
inline std::optional<glm::dvec2> crossing(const BoundaryWalk& walk, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 line = to - from;
  const auto side = [&](const glm::dvec2& p) { return line.x * (p.y - from.y) - line.y * (p.x - from.x); };
  const double before = side(walk.previous()), after = side(walk.current());
  if ((before > 0.0) == (after > 0.0)) return std::nullopt;
  const glm::dvec2 at = glm::mix(walk.previous(), walk.current(), before / (before - after));
  const double along = glm::dot(at - from, line) / glm::dot(line, line);
  if (along <= 0.0 || along >= 1.0) return std::nullopt;
  return at;
}

}  // namespace thicket

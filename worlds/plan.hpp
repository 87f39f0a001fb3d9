// The plan of a solid between two heights, in convex pieces. Private to truth.
#pragma once

#include <functional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/world.hpp"

namespace thicket::plan {

/// All points within `radius` of a convex polygon. One corner makes a disc, two make a capsule.
struct Piece {
  std::vector<glm::dvec2> corners;  ///< counter-clockwise, at least one; some may be equal
  double radius = 0.0;
};

/// Takes a solid's plan apart.
struct Visitor {
  std::function<void(const Piece&)> piece;
  /// An edge of the closed mesh's section at one height in the slab, all edges running the same way round. What no piece covers is in matter over the whole slab
  /// or nowhere: where the winding number of these edges is not 0, it is.
  std::function<void(const glm::dvec2& from, const glm::dvec2& to)> section_edge;
};

/// The plan between z_low and z_high, as truth.hpp defines it: the union of the pieces and of what the section's edges enclose.
void visit(const Solid& solid, double z_low, double z_high, const Visitor& visitor);

/// From the solid's frame to the world's, from the three turns one after the other (not world.hpp's closed form: an oracle has its own).
glm::dmat3 turn_of(const Solid& solid);

}  // namespace thicket::plan

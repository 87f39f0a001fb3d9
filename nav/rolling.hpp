// The boundary of the grown obstacles near the robot: the way of its axis when a disc of the distance that it keeps rolls along the matter. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "surroundings.hpp"

namespace thicket {

/// A piece of the boundary of a union of discs, as a polyline.
struct BoundaryPath {
  struct Point {
    glm::dvec2 position{0.0, 0.0};
    std::size_t disc = 0;   ///< on whose circle it lies
    double along = 0.0;     ///< m from the path's start
    bool corner = false;    ///< an inner corner: here the circle of `disc` is left for that of the next point
  };
  std::vector<Point> points;
};

/// Rolls from the place of the boundary that is nearest to `robot` on the side of `contact` (the last known point of matter under the hand), counter-clockwise
/// about the matter (`turn` > 0, matter on the left) or clockwise, for `length` metres. False if no disc is near the contact, or if no part of its circle is free.
bool roll(const std::vector<GrownDisc>& discs, const glm::dvec2& contact, const glm::dvec2& robot, int turn, double near, double length, BoundaryPath& path);

}  // namespace thicket

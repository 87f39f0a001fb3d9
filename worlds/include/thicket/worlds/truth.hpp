// What is really there, by code that shares nothing with the ray tracer or the mappers: for scores and for oracles. Sensors and planners do not see it.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/world.hpp"

namespace thicket {

/// Whether a point lies inside a solid.
bool inside(const Solid& solid, const glm::dvec3& point);

/// Whether a point lies in any matter; with `only_stops_motion`, in matter that stops motion.
bool in_matter(const World& world, const glm::dvec3& point, bool only_stops_motion = false);

/// A raster of the plane: cell (column, row) has its centre at low + (column + 0.5, row + 0.5) * resolution.
struct TruthGrid {
  glm::dvec2 low{0.0};
  double resolution = 0.1;
  int width = 0, height = 0;
  std::vector<std::uint8_t> blocked;  ///< row by row from the bottom

  glm::dvec2 centre(int column, int row) const { return low + glm::dvec2(column + 0.5, row + 0.5) * resolution; }
  bool contains(const glm::dvec2& point) const;
  std::size_t index_at(const glm::dvec2& point) const;  ///< of the cell that a point lies in; the point must be contained
};

/// Where the axis of a hull may not be: cells whose centre is nearer than `grow` to matter that stops motion and reaches into the heights between z_low and z_high.
/// The distance is exact (no raster of the matter in between), in closed form for every shape.
TruthGrid grown_obstacles(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low, double z_high);

/// Whether two points are joined by free cells, 4-connected. False if either lies in a blocked cell or outside.
bool connected(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to);

}  // namespace thicket

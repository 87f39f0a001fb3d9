// What is really there, by code that shares nothing with the ray tracer or the mappers: for scores and for oracles. Sensors and planners do not see it.
//
// A world is taken as it stands in its data; of one that moves, the caller gives `world_at(world, time)`.
//
// Plans. The plan of a solid between two heights z_low <= z_high is what of it is seen from above when everything outside the open slab z_low < z < z_high is cut
// away (for z_low == z_high: its section at that height). What only touches the slab has no plan. Plans are closed and exact in closed form, with two exceptions:
// a tilted cylinder is a prism of 2304 sides inscribed in it (1e-6 of its radius too little), and a sheet (an open mesh) reaches up to half its thickness too far
// where it leaves the slab.
//
// Matter in a mesh. A closed one: where its winding number is not 0, so that overlapping parts are one and an inner shell that faces inward is a cavity. An open
// one: within half of its sheet_thickness of a triangle.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/result.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// Whether a point lies inside a solid. The faces of boxes, spheres, cylinders and walls belong to them; on those of prisms and meshes either may be told.
bool inside(const Solid& solid, const glm::dvec3& point);

/// Whether a point lies in any matter; with `only_stops_motion`, in matter that stops motion.
bool in_matter(const World& world, const glm::dvec3& point, bool only_stops_motion = false);

/// What the solids at a point amount to.
struct Matter {
  bool any = false;
  double attenuation_db_per_m = 0.0;  ///< the highest, one way
  bool stops_motion = false;          ///< if any of them does
};
Matter matter_at(const World& world, const glm::dvec3& point);

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

/// The largest grid that is made: 2^28 cells.
inline constexpr double max_truth_cells = 268435456.0;

/// When a cell is occupied. Both are judged on the plan itself, without a raster in between, so that any_overlap holds every cell of cell_centre.
/// `touch` below is 1e-6 of a cell: what lies on a border or a centre to the rounding of doubles (coordinates up to 1e7 m) is told the same way everywhere.
enum class Convention : std::uint8_t {
  cell_centre,  ///< its centre lies in the plan or within `touch` of it: an edge through the centre counts
  any_overlap,  ///< the plan meets the cell's square less a rim of `touch`: a wall whose face lies on the border of a cell leaves that cell free
};

/// The occupancy of [low, high] (to whole cells, from `low` on) by matter between two heights; with `only_stops_motion`, by matter that stops motion.
/// Errors: a resolution that is not greater than 0, bounds or heights that are empty or not finite, more than `max_truth_cells`.
Result<TruthGrid> occupancy(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double z_low, double z_high,
                            Convention convention, bool only_stops_motion = true);

/// Where the axis of a hull may not be: cells whose centre is nearer than `grow` (m, >= 0; with 0 there are none) to the plan of matter that stops motion.
/// The distance is exact: no raster of the matter in between. Errors as `occupancy`.
Result<TruthGrid> grown_obstacles(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low, double z_high);

/// Whether two points are joined by free cells, 4-connected. False if either lies in a blocked cell or outside.
bool connected(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to);

struct GridPath {
  double length_m = 0.0;           ///< octile: steps to a neighbour of one or sqrt(2) cells
  std::vector<glm::dvec2> points;  ///< the centres of its cells, from the one that `from` lies in to that of `to`
};
/// A shortest way over free cells to any of eight neighbours, to a diagonal one only if both cells beside the step are free (the rule of the MovingAI benchmarks):
/// it exists where the points are `connected`. A* with the octile distance; of several shortest ways always the same. Takes 9 bytes a cell.
std::optional<GridPath> shortest_path(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to);

}  // namespace thicket

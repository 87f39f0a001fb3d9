// Where the axis of a hull may be, for oracles: distances from matter, the components of the free space after growth, and the closed lines that bound them.
//
// Everything follows from the distance to the plan of matter that stops motion (truth.hpp), exact at the nodes of a square grid and linear between neighbours. Nodes are
// the cell centres of a `TruthGrid`: what is blocked here for a growth is what `grown_obstacles` blocks, to rounding. Outside of the grid there is nothing: free space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// Distances from matter at the nodes low + (column + 0.5, row + 0.5) * resolution.
struct DistanceGrid {
  glm::dvec2 low{0.0};
  double resolution = 0.1;  ///< m
  int width = 0, height = 0;
  double limit = 0.0;           ///< m; distances of this and more are told as this
  std::vector<float> distance;  ///< m, row by row from the bottom; 0 in matter

  glm::dvec2 node(int column, int row) const { return low + glm::dvec2(column + 0.5, row + 0.5) * resolution; }
  bool contains(const glm::dvec2& point) const;
  /// At the node of the cell that a point lies in; the limit outside of the grid.
  double at(const glm::dvec2& point) const;
};

/// Distances up to `limit` (m, > 0) from the plan, between two heights, of matter that stops motion. Errors as `occupancy`.
Result<DistanceGrid> distance_to_matter(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double limit, double z_low, double z_high);

/// A closed line between free and grown: its last point is followed by its first.
struct GrownContour {
  std::vector<glm::dvec2> points;
  double length_m = 0.0;
  std::uint32_t component = 0;  ///< of the free space that it bounds
};

/// The free space after growth: nodes at least `grow` from matter, 4-connected, and all that is outside of the grid, which is one.
class FreeSpace {
 public:
  /// `grow` in metres, between 0 and the grid's limit (what is more is taken as the limit).
  FreeSpace(const DistanceGrid& distances, double grow);

  double grow() const { return grow_; }
  /// The component of the cell that a point lies in, from 1; 0 where it is blocked.
  std::uint32_t component_at(const glm::dvec2& point) const;
  std::uint32_t component_at(int column, int row) const { return labels_[static_cast<std::size_t>(row + 1) * stride() + static_cast<std::size_t>(column + 1)]; }
  std::uint32_t outside() const { return labels_[0]; }
  /// The lines of all components, in the order of their lowest, leftmost edges. Linear between nodes (marching squares, Lorensen & Cline 1987, in the plane; blocked
  /// nodes are 8-connected): lengths of smooth lines are good to a few parts in a thousand where the grown matter is wider than some cells; of
  /// a notch between two grown pieces, what lies within one square of nodes is cut off.
  const std::vector<GrownContour>& contours() const { return contours_; }
  /// The free cells as a raster, for `shortest_path`.
  TruthGrid grid() const;

 private:
  std::size_t stride() const { return static_cast<std::size_t>(width_) + 2; }
  void label();
  void trace(const DistanceGrid& distances);

  glm::dvec2 low_;
  double resolution_, grow_;
  int width_, height_;
  std::vector<std::uint32_t> labels_;  ///< with a rim of one free node around the grid
  std::vector<GrownContour> contours_;
};

/// The lines that bound the component of the grown free space that holds `from`: the obstacles in it and its outer wall. None if `from` is blocked. Errors as
/// `grown_obstacles`.
Result<std::vector<GrownContour>> grown_contours(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low,
                                                 double z_high, const glm::dvec2& from);

/// How often a segment passes from one side of a contour to the other.
std::size_t crossings(const GrownContour& contour, const glm::dvec2& a, const glm::dvec2& b);

/// The least distance of a contour from a point, m.
double distance_from(const GrownContour& contour, const glm::dvec2& point);

/// Local minima of the distance from a point along a contour, at least one: those that one has to get away from by more than `depth` metres on either side.
std::size_t local_minima(const GrownContour& contour, const glm::dvec2& point, double depth);

}  // namespace thicket

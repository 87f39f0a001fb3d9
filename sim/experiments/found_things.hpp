// What of worlds/data/findings a map shows. Private to sim/experiments, a test, and the study that makes the table of docs/mapping.md, whose rules these are.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/nav/occupancy_map.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::finds {

/// A rectangle of the plan.
struct Plan {
  glm::dvec2 low{0.0}, high{0.0};
  double distance(const glm::dvec2& p) const { return glm::length(glm::max(glm::max(low - p, p - high), glm::dvec2(0.0))); }
  Plan moved(double x, double y) const { return {low + glm::dvec2(x, y), high + glm::dvec2(x, y)}; }
};

/// The plan of an upright box or cylinder of the world, by its name.
inline Plan plan_of(const World& world, const std::string& name) {
  for (const Solid& solid : world.solids) {
    if (solid.name != name) continue;
    const glm::dvec2 at(solid.position);
    if (const auto* box = std::get_if<Box>(&solid.shape)) return {at - 0.5 * glm::dvec2(box->size), at + 0.5 * glm::dvec2(box->size)};
    if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) return {at - cylinder->radius, at + cylinder->radius};
  }
  return {};
}

inline bool is_claimed(const CellView& view) { return view.known && view.probability > 0.5; }
inline bool is_free(const CellView& view) { return view.known && view.probability < 0.5 && !view.sensed_through; }

/// A map, asked by the metre.
class Look {
 public:
  explicit Look(const OccupancyMap& map) : map_(map), cell_(map.resolution()) {}

  bool claimed_near(const CellIndex& cell) const {
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column)
        if (is_claimed(map_.view({cell.column + column, cell.row + row}))) return true;
    return false;
  }

  /// Of the columns of cells across a piece of a wall that runs along x, the share in which a cell of the wall, or one beside it, is claimed.
  double claimed_share(const Plan& wall) const {
    int claimed = 0, all = 0;
    for (std::int64_t column = first(wall).column; column <= last(wall).column; ++column, ++all)
      claimed += any(first(wall).row - 1, last(wall).row + 1, [&](std::int64_t row) { return is_claimed(map_.view({column, row})); });
    return static_cast<double>(claimed) / all;
  }

  /// A doorway is found if a way over free cells (4 neighbours), no wider than it, leads from half a metre before the wall to half a metre behind it, and at least half of the wall is claimed for half a metre to either side.
  bool doorway(const Plan& door) const {
    const double width = door.high.x - door.low.x;
    Plan left = door, right = door;
    left.low.x = door.low.x - 0.5;
    left.high.x = door.low.x;
    right.low.x = door.high.x;
    right.high.x = door.high.x + 0.5;
    if (width <= 0.0 || claimed_share(left) < 0.5 || claimed_share(right) < 0.5) return false;
    Plan strip = door;
    strip.low.y -= 0.5;
    strip.high.y += 0.5;
    const CellIndex low = first(strip), high = last(strip);
    std::vector<CellIndex> open;
    for (std::int64_t column = low.column; column <= high.column; ++column) open.push_back({column, low.row});
    const auto reached = spread(std::move(open), false, [&](const CellIndex& c) {
      return c.column >= low.column && c.column <= high.column && c.row >= low.row && c.row <= high.row && is_free(map_.view(c));
    });
    return std::any_of(reached.begin(), reached.end(), [&](const CellIndex& c) { return c.row == high.row; });
  }

  /// Whether one sees through a piece of a wall that runs along x: at least half of it is claimed, and right behind at least half of it, 0.1 to 0.3 m from its plane, a free cell is known. (Farther behind, cells beside a
  /// window are seen through it aslant.) `behind` = +1: it is looked at along y, -1: against.
  bool seen_through(const Plan& pane, int behind) const {
    if (claimed_share(pane) < 0.5) return false;
    Plan beyond = pane.moved(0.0, behind * 0.2);
    beyond.low.y -= 0.1;
    beyond.high.y += 0.1;
    int seen = 0, all = 0;
    for (std::int64_t column = first(pane).column; column <= last(pane).column; ++column, ++all)
      seen += any(first(beyond).row, last(beyond).row, [&](std::int64_t row) { return is_free(map_.view({column, row})); });
    return 2 * seen >= all;
  }

  /// A window is found if one sees through it, and not through as much of the wall to its left and right, 0.8 m from it.
  bool window(const Plan& pane, int behind) const {
    const double aside = pane.high.x - pane.low.x + 0.8;
    return seen_through(pane, behind) && !seen_through(pane.moved(-aside, 0.0), behind) && !seen_through(pane.moved(aside, 0.0), behind);
  }

  /// A thing is found if at least half of the cells that its outline meets are claimed or beside a claimed cell, and of the claimed cells that hang together with it (8 neighbours) at least half are no farther from it than a
  /// cell's diagonal. So it must neither be smeared, nor run together with a wall.
  bool thing(const Plan& plan) const {
    std::vector<CellIndex> seeds;
    int outline = 0, shown = 0;
    const CellIndex low = first(plan), high = last(plan);
    for (std::int64_t row = low.row - 1; row <= high.row + 1; ++row)
      for (std::int64_t column = low.column - 1; column <= high.column + 1; ++column) {
        const bool within = column >= low.column && column <= high.column && row >= low.row && row <= high.row;
        const bool edge = within && (column == low.column || column == high.column || row == low.row || row == high.row);
        outline += edge;
        shown += edge && claimed_near({column, row});
        if (is_claimed(map_.view({column, row}))) seeds.push_back({column, row});
      }
    if (2 * shown < outline) return false;
    const auto group = spread(std::move(seeds), true, [&](const CellIndex& c) { return is_claimed(map_.view(c)); });
    const auto near = std::count_if(group.begin(), group.end(), [&](const CellIndex& c) {
      return plan.distance((glm::dvec2(static_cast<double>(c.column), static_cast<double>(c.row)) + 0.5) * cell_) <= std::sqrt(2.0) * cell_;
    });
    return 2 * near >= static_cast<std::ptrdiff_t>(group.size());
  }

 private:
  CellIndex first(const Plan& plan) const { return map_.cell_at(plan.low); }
  CellIndex last(const Plan& plan) const { return map_.cell_at(plan.high); }

  template <class Ask>
  static bool any(std::int64_t low, std::int64_t high, Ask&& ask) {
    for (std::int64_t row = low; row <= high; ++row)
      if (ask(row)) return true;
    return false;
  }

  /// Those of the cells that pass, and all that pass and hang together with them.
  template <class Passes>
  static std::vector<CellIndex> spread(std::vector<CellIndex> open, bool diagonal, Passes&& passes) {
    std::vector<CellIndex> reached;
    while (!open.empty()) {
      const CellIndex cell = open.back();
      open.pop_back();
      if (!passes(cell) || std::find(reached.begin(), reached.end(), cell) != reached.end()) continue;
      reached.push_back(cell);
      for (int row = -1; row <= 1; ++row)
        for (int column = -1; column <= 1; ++column)
          if (diagonal || row == 0 || column == 0) open.push_back({cell.column + column, cell.row + row});
    }
    return reached;
  }

  const OccupancyMap& map_;
  double cell_;
};

/// What is found of the four, in the world of findings/room.toml.
struct Found {
  bool doorway = false, window = false, postbox = false, sign = false;
  bool operator==(const Found&) const = default;
};
inline Found found(const OccupancyMap& map, const World& world) {
  const Look look(map);
  return {look.doorway(plan_of(world, "wall above the doorway")), look.window(plan_of(world, "window pane"), 1), look.thing(plan_of(world, "postbox")), look.thing(plan_of(world, "pole of the stop sign"))};
}

}  // namespace thicket::finds

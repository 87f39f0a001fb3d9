#include "thicket/worlds/truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

double distance_to_rectangle(const glm::dvec2& p, const glm::dvec2& low, const glm::dvec2& high) {
  const double dx = std::max({low.x - p.x, 0.0, p.x - high.x}), dy = std::max({low.y - p.y, 0.0, p.y - high.y});
  return std::hypot(dx, dy);
}

/// Distance in the plan from a point of the solid's frame, and the solid's height range there; for a sphere the plan is that of the slab.
struct PlanDistance {
  glm::dvec2 p;
  double z_low, z_high;  ///< relative to the solid

  static constexpr double none = std::numeric_limits<double>::infinity();
  bool misses(double low, double high) const { return high <= z_low || low >= z_high; }

  double operator()(const Box& b) const {
    if (misses(-0.5 * b.size.z, 0.5 * b.size.z)) return none;
    return distance_to_rectangle(p, -0.5 * glm::dvec2(b.size), 0.5 * glm::dvec2(b.size));
  }
  double operator()(const Sphere& s) const {
    const double dz = z_low > 0.0 ? z_low : z_high < 0.0 ? -z_high : 0.0;
    if (dz >= s.radius) return none;
    return std::max(0.0, glm::length(p) - std::sqrt((s.radius - dz) * (s.radius + dz)));
  }
  double operator()(const Cylinder& c) const {
    if (misses(-0.5 * c.height, 0.5 * c.height)) return none;
    return std::max(0.0, glm::length(p) - c.radius);
  }
  double operator()(const Wall& w) const {
    if (misses(0.0, w.height)) return none;
    double least = none;
    const double half = 0.5 * w.thickness;
    for (std::size_t i = 1; i < w.points.size(); ++i) {
      const glm::dvec2 along = w.points[i] - w.points[i - 1];
      const Pose2 segment{w.points[i - 1], bearing(along)};
      least = std::min(least, distance_to_rectangle(segment.to_inner(p), {0.0, -half}, {glm::length(along), half}));
      const bool joint = i + 1 < w.points.size() || w.points.back() == w.points.front();
      if (joint) least = std::min(least, std::max(0.0, glm::distance(p, w.points[i]) - half));
    }
    return least;
  }
  double operator()(const MapSolid& m) const {
    if (misses(0.0, m.height)) return none;
    double least = none;
    for (const CellBlock& b : m.blocks) {
      const double r = m.grid.resolution;
      least = std::min(least, distance_to_rectangle(p, glm::dvec2(b.column, b.row) * r, glm::dvec2(b.column + b.columns, b.row + b.rows) * r));
    }
    return least;
  }
  double operator()(const Prism&) const { return none; }
  double operator()(const MeshSolid&) const { return none; }
};

double plan_distance(const Solid& solid, const glm::dvec2& point, double z_low, double z_high) {
  const Pose2 frame{glm::dvec2(solid.position), solid.yaw};
  return std::visit(PlanDistance{frame.to_inner(point), z_low - solid.position.z, z_high - solid.position.z}, solid.shape);
}

}  // namespace

bool inside(const Solid& solid, const glm::dvec3& point) {
  constexpr double thin = 1e-9;  // a slab thin enough to stand for the point's height
  if (const auto* map = std::get_if<MapSolid>(&solid.shape)) {
    // By its cells, not by their merged blocks.
    const glm::dvec2 p = Pose2{glm::dvec2(solid.position), solid.yaw}.to_inner(glm::dvec2(point)) / map->grid.resolution;
    const double z = point.z - solid.position.z;
    const bool on_map = p.x >= 0.0 && p.y >= 0.0 && p.x < map->grid.width && p.y < map->grid.height && z >= 0.0 && z < map->height;
    return on_map && map->matter(static_cast<int>(p.x), static_cast<int>(p.y));
  }
  return plan_distance(solid, glm::dvec2(point), point.z - thin, point.z + thin) <= 0.0;
}

bool in_matter(const World& world, const glm::dvec3& point, bool only_stops_motion) {
  return std::any_of(world.solids.begin(), world.solids.end(),
                     [&](const Solid& solid) { return (!only_stops_motion || world.materials[solid.material].stops_motion) && inside(solid, point); });
}

bool TruthGrid::contains(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low) / resolution;
  return p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height;
}

std::size_t TruthGrid::index_at(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low) / resolution;
  return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(p.x);
}

TruthGrid grown_obstacles(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low, double z_high) {
  TruthGrid grid;
  grid.low = low;
  grid.resolution = resolution;
  grid.width = static_cast<int>(std::ceil((high.x - low.x) / resolution));
  grid.height = static_cast<int>(std::ceil((high.y - low.y) / resolution));
  grid.blocked.assign(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height), 0);
  for (const Solid& solid : world.solids) {
    if (!world.materials[solid.material].stops_motion) continue;
    const Bounds box = extent(solid);
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        std::uint8_t& cell = grid.blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(column)];
        const glm::dvec2 p = grid.centre(column, row);
        if (cell || distance_to_rectangle(p, glm::dvec2(box.low), glm::dvec2(box.high)) >= grow) continue;
        cell = plan_distance(solid, p, z_low, z_high) < grow;
      }
    }
  }
  return grid;
}

bool connected(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to) {
  if (!grid.contains(from) || !grid.contains(to)) return false;
  const std::size_t start = grid.index_at(from), goal = grid.index_at(to);
  if (grid.blocked[start] || grid.blocked[goal]) return false;
  std::vector<std::uint8_t> seen = grid.blocked;
  std::vector<std::size_t> open = {start};
  seen[start] = 1;
  const auto width = static_cast<std::size_t>(grid.width);
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (at == goal) return true;
    const std::size_t column = at % width;
    const auto visit = [&](bool exists, std::size_t next) {
      if (!exists || seen[next]) return;
      seen[next] = 1;
      open.push_back(next);
    };
    visit(column > 0, at - 1);
    visit(column + 1 < width, at + 1);
    visit(at >= width, at - width);
    visit(at + width < seen.size(), at + width);
  }
  return false;
}

}  // namespace thicket

#include "thicket/worlds/world.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

/// The plan of a shape: rectangle corners or centre lines, in the solid's frame, with the margin around them and the height range.
struct Plan {
  std::vector<glm::dvec2> points;
  double margin = 0.0;
  double z_low = 0.0, z_high = 0.0;
  bool turns = true;  ///< whether the solid's yaw moves the points
};

struct PlanOf {
  Plan operator()(const Box& b) const {
    const glm::dvec2 h = 0.5 * glm::dvec2(b.size);
    return {{{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}}, 0.0, -0.5 * b.size.z, 0.5 * b.size.z};
  }
  Plan operator()(const Sphere& s) const { return {{{0.0, 0.0}}, s.radius, -s.radius, s.radius}; }
  Plan operator()(const Cylinder& c) const { return {{{0.0, 0.0}}, c.radius, -0.5 * c.height, 0.5 * c.height}; }
  Plan operator()(const Wall& w) const { return {w.points, 0.5 * w.thickness, 0.0, w.height}; }
  Plan operator()(const MapSolid& m) const {
    Plan plan{{}, 0.0, 0.0, m.height};
    for (const CellBlock& b : m.blocks)
      for (const int i : {0, 1})
        for (const int j : {0, 1})
          plan.points.push_back(glm::dvec2(b.column + i * b.columns, b.row + j * b.rows) * m.grid.resolution);
    return plan;
  }
};

}  // namespace

Bounds join(const Bounds& a, const Bounds& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

Bounds extent(const Solid& solid) {
  const Plan plan = std::visit(PlanOf{}, solid.shape);
  const Pose2 frame{glm::dvec2(solid.position), solid.yaw};
  Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const glm::dvec2& p : plan.points) {
    const glm::dvec2 q = frame.to_outer(p);
    bounds = join(bounds, {glm::dvec3(q - plan.margin, solid.position.z + plan.z_low), glm::dvec3(q + plan.margin, solid.position.z + plan.z_high)});
  }
  return bounds;
}

std::optional<Bounds> extent(const World& world) {
  std::optional<Bounds> all;
  for (const Solid& solid : world.solids) {
    const Bounds one = extent(solid);
    if (!(one.low.x <= one.high.x)) continue;  // a map without matter
    all = all ? join(*all, one) : one;
  }
  return all;
}

double half_width_between(const Solid& solid, double z_low, double z_high) {
  const Bounds box = extent(solid);
  if (!(box.low.z <= z_high && box.high.z >= z_low)) return 0.0;
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
    const double dz = std::max({0.0, z_low - solid.position.z, solid.position.z - z_high});
    return std::sqrt(std::max(0.0, sphere->radius * sphere->radius - dz * dz));
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) return cylinder->radius;
  return 0.5 * glm::length(glm::dvec2(box.high) - glm::dvec2(box.low));
}

std::vector<CellBlock> merge_cells(const MapSolid& map) {
  const int width = map.grid.width, height = map.grid.height;
  std::vector<char> open(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto cell = [&](int column, int row) -> char& {
    return open[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) cell(column, row) = map.matter(column, row);

  std::vector<CellBlock> blocks;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (!cell(column, row)) continue;
      int columns = 1;
      while (column + columns < width && cell(column + columns, row)) ++columns;
      int rows = 1;
      const auto row_is_matter = [&](int r) {
        for (int c = column; c < column + columns; ++c)
          if (!cell(c, r)) return false;
        return true;
      };
      while (row + rows < height && row_is_matter(row + rows)) ++rows;
      for (int r = row; r < row + rows; ++r)
        for (int c = column; c < column + columns; ++c) cell(c, r) = 0;
      blocks.push_back({column, row, columns, rows});
    }
  }
  return blocks;
}

}  // namespace thicket

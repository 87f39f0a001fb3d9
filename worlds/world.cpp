#include "thicket/worlds/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

/// Points in the solid's frame whose hull, widened by `margin`, holds a shape.
struct Skeleton {
  std::vector<glm::dvec3> points;
  glm::dvec3 margin{0.0};  ///< of a solid that stands upright
};

void add_box(std::vector<glm::dvec3>& points, const glm::dvec3& low, const glm::dvec3& high) {
  for (const double x : {low.x, high.x})
    for (const double y : {low.y, high.y})
      for (const double z : {low.z, high.z}) points.emplace_back(x, y, z);
}

struct SkeletonOf {
  Skeleton operator()(const Box& b) const {
    Skeleton s;
    add_box(s.points, -0.5 * b.size, 0.5 * b.size);
    return s;
  }
  Skeleton operator()(const Sphere& s) const { return {{{0.0, 0.0, 0.0}}, glm::dvec3(s.radius)}; }
  Skeleton operator()(const Cylinder& c) const { return {{{0.0, 0.0, -0.5 * c.height}, {0.0, 0.0, 0.5 * c.height}}, {c.radius, c.radius, 0.0}}; }
  Skeleton operator()(const Wall& w) const {
    Skeleton s;
    for (const glm::dvec2& p : w.points)
      for (const double z : {0.0, w.height}) s.points.emplace_back(p, z);
    s.margin = {0.5 * w.thickness, 0.5 * w.thickness, 0.0};
    return s;
  }
  Skeleton operator()(const MapSolid& m) const {
    Skeleton s;
    const double r = m.grid.resolution;
    for (const CellBlock& b : m.blocks)
      add_box(s.points, {b.column * r, b.row * r, 0.0}, {(b.column + b.columns) * r, (b.row + b.rows) * r, m.height});
    return s;
  }
  Skeleton operator()(const Prism& p) const {
    Skeleton s;
    for (const glm::dvec2& q : p.outline)
      for (const double z : {0.0, p.height}) s.points.emplace_back(q, z);
    return s;
  }
  Skeleton operator()(const MeshSolid& m) const {
    Skeleton s;
    add_box(s.points, m.scale * m.mesh->low, m.scale * m.mesh->high);
    return s;
  }
};

}  // namespace

Bounds join(const Bounds& a, const Bounds& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

glm::dmat3 rotation_of(double yaw, double pitch, double roll) {
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  if (pitch == 0.0 && roll == 0.0) return {cy, sy, 0.0, -sy, cy, 0.0, 0.0, 0.0, 1.0};
  const double cp = std::cos(pitch), sp = std::sin(pitch), cr = std::cos(roll), sr = std::sin(roll);
  return {cy * cp, sy * cp, -sp,  //
          cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr,  //
          cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr};
}

Standing standing_at(const Solid& solid, double time) {
  if (!solid.motion) return {solid.position, solid.yaw, glm::dvec3(0.0), 0.0};
  const Motion& m = *solid.motion;
  Standing there{solid.position, solid.yaw + m.spin * time, glm::dvec3(0.0), m.spin};
  if (m.points.empty()) return there;
  // The way as legs: there, and for the modes that go on for ever back to the first point.
  const std::size_t count = m.points.size(), legs = m.mode == Motion::Mode::once ? count - 1 : m.mode == Motion::Mode::loop ? count : 2 * (count - 1);
  const auto point = [&](std::size_t i) { return m.points[i < count ? i : m.mode == Motion::Mode::loop ? i - count : 2 * (count - 1) - i]; };
  there.position = m.points.front();
  double way = std::max(0.0, time - m.start_s) * m.speed;
  if (m.mode != Motion::Mode::once) {
    double length = 0.0;
    for (std::size_t i = 0; i < legs; ++i) length += glm::distance(point(i), point(i + 1));
    if (!(length > 0.0)) return there;
    way = std::fmod(way, length);
  }
  for (std::size_t i = 0; i < legs; ++i) {
    const glm::dvec3 from = point(i), to = point(i + 1);
    const double leg = glm::distance(from, to);
    if (way < leg) {
      there.position = from + (way / leg) * (to - from);
      if (time >= m.start_s) there.velocity = (m.speed / leg) * (to - from);
      break;
    }
    way -= leg;
    there.position = to;
  }
  return there;
}

World world_at(const World& world, double time) {
  World there = world;
  for (Solid& solid : there.solids) {
    if (!solid.motion) continue;
    const Standing standing = standing_at(solid, time);
    solid.position = standing.position;
    solid.yaw = standing.yaw;
    solid.motion = nullptr;
  }
  return there;
}

Bounds extent(const Solid& solid) {
  const Skeleton skeleton = std::visit(SkeletonOf{}, solid.shape);
  const glm::dmat3 turn = rotation_of(solid);
  glm::dvec3 margin = skeleton.margin;
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape); cylinder && !solid.upright()) {
    for (int i = 0; i < 3; ++i) margin[i] = cylinder->radius * std::sqrt(std::max(0.0, 1.0 - turn[2][i] * turn[2][i]));
  } else if (!solid.upright()) {
    margin = glm::dvec3(std::max({margin.x, margin.y, margin.z}));
  }
  Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const glm::dvec3& p : skeleton.points) {
    const glm::dvec3 q = solid.position + turn * p;
    bounds = join(bounds, {q - margin, q + margin});
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

LevelCuts::LevelCuts(const World& world) {
  std::vector<glm::dvec2> sloping;
  for (const Solid& solid : world.solids) {
    const Bounds box = extent(solid);
    glm::dvec2 heights(box.low.z, box.high.z);
    bool level = solid.upright() && !std::holds_alternative<Sphere>(solid.shape) && !std::holds_alternative<MeshSolid>(solid.shape);
    if (solid.motion) {
      for (const glm::dvec3& point : solid.motion->points) {
        level = level && point.z == solid.motion->points.front().z;
        heights = {std::min(heights.x, point.z - solid.position.z + box.low.z), std::max(heights.y, point.z - solid.position.z + box.high.z)};
      }
    }
    if (!level) sloping.push_back(heights);
    changes_.push_back(heights.x);
    changes_.push_back(heights.y);
  }
  std::ranges::sort(changes_);
  changes_.erase(std::unique(changes_.begin(), changes_.end()), changes_.end());
  std::ranges::sort(sloping, {}, [](const glm::dvec2& heights) { return heights.x; });
  for (const glm::dvec2& heights : sloping) {
    if (sloping_.empty() || heights.x > sloping_.back().y) sloping_.push_back(heights);
    else sloping_.back().y = std::max(sloping_.back().y, heights.y);
  }
}

std::optional<glm::dvec2> LevelCuts::about(double z) const {
  constexpr double endless = std::numeric_limits<double>::infinity();
  const auto above = std::ranges::lower_bound(sloping_, z, {}, [](const glm::dvec2& heights) { return heights.y; });
  if (above != sloping_.end() && above->x <= z) return std::nullopt;
  const auto next = std::ranges::upper_bound(changes_, z);
  return glm::dvec2(next == changes_.begin() ? -endless : *std::prev(next), next == changes_.end() ? endless : *next);
}

double half_width_between(const Solid& solid, double z_low, double z_high) {
  const Bounds box = extent(solid);
  if (!(box.low.z <= z_high && box.high.z >= z_low)) return 0.0;
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
    const double dz = std::max({0.0, z_low - solid.position.z, solid.position.z - z_high});
    return std::sqrt(std::max(0.0, sphere->radius * sphere->radius - dz * dz));
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape); cylinder && solid.upright()) return cylinder->radius;
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

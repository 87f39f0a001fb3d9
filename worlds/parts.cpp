#include "parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "part_rays.hpp"
#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

class PartMaker {
 public:
  PartMaker(Parts& parts, const Solid& solid, std::uint32_t index, const glm::dvec3& origin)
      : parts_(parts), index_(index), position_(solid.position - origin), yaw_(solid.yaw) {}

  void operator()(const Box& b) const { add_box(position_, yaw_, -0.5 * b.size, 0.5 * b.size); }
  void operator()(const Sphere& s) const { parts_.spheres.push_back({index_, position_, s.radius}); }
  void operator()(const Cylinder& c) const { parts_.cylinders.push_back({index_, position_, c.radius, 0.5 * c.height}); }

  void operator()(const Wall& w) const {
    const Pose2 frame{glm::dvec2(position_), yaw_};
    const double half = 0.5 * w.thickness;
    for (std::size_t i = 1; i < w.points.size(); ++i) {
      const glm::dvec2 along = w.points[i] - w.points[i - 1];
      const glm::dvec2 start = frame.to_outer(w.points[i - 1]);
      add_box({start.x, start.y, position_.z}, yaw_ + bearing(along), {0.0, -half, 0.0}, {glm::length(along), half, w.height});
      const bool closes = i + 1 == w.points.size() && w.points.back() == w.points.front();
      if (i + 1 == w.points.size() && !closes) continue;  // a free end stays square
      const glm::dvec2 joint = frame.to_outer(w.points[i]);
      parts_.cylinders.push_back({index_, {joint.x, joint.y, position_.z + 0.5 * w.height}, half, 0.5 * w.height});
    }
  }

  void operator()(const MapSolid& m) const {
    const double cell = m.grid.resolution;
    for (const CellBlock& b : m.blocks)
      add_box(position_, yaw_, {b.column * cell, b.row * cell, 0.0}, {(b.column + b.columns) * cell, (b.row + b.rows) * cell, m.height});
  }

  void operator()(const Prism&) const {}
  void operator()(const MeshSolid&) const {}

 private:
  void add_box(const glm::dvec3& frame, double yaw, const glm::dvec3& low, const glm::dvec3& high) const {
    parts_.boxes.push_back({index_, frame, std::cos(yaw), std::sin(yaw), low, high});
  }

  Parts& parts_;
  std::uint32_t index_;
  glm::dvec3 position_;
  double yaw_;
};

}  // namespace

Parts make_parts(const World& world, const glm::dvec3& origin) {
  Parts parts;
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) std::visit(PartMaker(parts, world.solids[i], i, origin), world.solids[i].shape);
  return parts;
}

Bounds part_bounds(const SpherePart& part) { return {part.centre - part.radius, part.centre + part.radius}; }

Bounds part_bounds(const CylinderPart& part) {
  const glm::dvec3 half(part.radius, part.radius, part.half_height);
  return {part.centre - half, part.centre + half};
}

Bounds part_bounds(const BoxPart& part) {
  const glm::dvec3 middle = part.frame + out_of_frame(part, 0.5 * (part.low + part.high));
  const glm::dvec3 half = 0.5 * (part.high - part.low);
  const double c = std::abs(part.cosine), s = std::abs(part.sine);
  const glm::dvec3 reach(c * half.x + s * half.y, s * half.x + c * half.y, half.z);
  return {middle - reach, middle + reach};
}

double axis_distance(const SpherePart& part, const glm::dvec2& position, double z_low, double z_high) {
  const double dz = std::max({0.0, z_low - part.centre.z, part.centre.z - z_high});
  if (dz >= part.radius) return infinity;
  return glm::length(position - glm::dvec2(part.centre)) - std::sqrt(part.radius * part.radius - dz * dz);
}

double axis_distance(const CylinderPart& part, const glm::dvec2& position, double z_low, double z_high) {
  if (part.centre.z - part.half_height >= z_high || part.centre.z + part.half_height <= z_low) return infinity;
  return glm::length(position - glm::dvec2(part.centre)) - part.radius;
}

double axis_distance(const BoxPart& part, const glm::dvec2& position, double z_low, double z_high) {
  if (part.frame.z + part.low.z >= z_high || part.frame.z + part.high.z <= z_low) return infinity;
  const glm::dvec2 p(into_frame(part, glm::dvec3(position - glm::dvec2(part.frame), 0.0)));
  const glm::dvec2 outside = glm::max(glm::dvec2(part.low) - p, p - glm::dvec2(part.high));
  if (outside.x > 0.0 && outside.y > 0.0) return glm::length(outside);
  return std::max(outside.x, outside.y);
}

}  // namespace thicket

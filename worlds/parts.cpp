#include "parts.hpp"

#include <algorithm>
#include <array>
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

void add_parts(const Solid& solid, std::uint32_t index, const glm::dvec3& origin, Parts& parts) { std::visit(PartMaker(parts, solid, index, origin), solid.shape); }

bool needs_instance(const Solid& solid) {
  const bool is_mesh = std::holds_alternative<MeshSolid>(solid.shape) || std::holds_alternative<Prism>(solid.shape);
  return is_mesh || solid.motion || !(solid.upright() || std::holds_alternative<Sphere>(solid.shape));
}

double reach_of(const Solid& solid) {
  const Bounds box = extent(solid);
  return glm::length(glm::max(glm::abs(box.low - solid.position), glm::abs(box.high - solid.position)));
}

Bounds whole_extent(const Solid& solid) {
  const Bounds box = extent(solid);
  if (!solid.motion || !(box.low.x <= box.high.x)) return box;
  const double reach = reach_of(solid);
  Bounds all{solid.position - reach, solid.position + reach};
  for (const glm::dvec3& p : solid.motion->points) all = join(all, {p - reach, p + reach});
  return all;
}

std::optional<Bounds> whole_extent(const World& world) {
  std::optional<Bounds> all;
  for (const Solid& solid : world.solids)
    if (const Bounds one = whole_extent(solid); one.low.x <= one.high.x) all = all ? join(*all, one) : one;
  return all;
}

bool changes_height(const Motion& motion) {
  return std::ranges::any_of(motion.points, [&](const glm::dvec3& p) { return p.z != motion.points.front().z; });
}

double triangle_distance(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  double least = infinity;
  bool above = true;
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
    const glm::dvec3 along = to - from, off = point - from;
    above = above && glm::dot(glm::cross(along, off), normal) >= 0.0;
    const double length_squared = glm::dot(along, along);
    const double t = length_squared > 0.0 ? std::clamp(glm::dot(off, along) / length_squared, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::length(off - t * along));
  }
  const double size = glm::length(normal);
  return above && size > 0.0 ? std::min(least, std::abs(glm::dot(point - a, normal)) / size) : least;
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

namespace {

/// Keeps the part of a convex polygon with sign * z <= level.
template <class Points>
void keep_below(Points& points, double sign, double level) {
  Points kept;
  for (std::size_t i = 0; i < points.size; ++i) {
    const glm::dvec3 &a = points.at[i], &b = points.at[(i + 1) % points.size];
    const double below_a = level - sign * a.z, below_b = level - sign * b.z;
    if (below_a >= 0.0) kept.add(a);
    if ((below_a > 0.0 && below_b < 0.0) || (below_a < 0.0 && below_b > 0.0)) kept.add(a + (below_a / (below_a - below_b)) * (b - a));
  }
  points = kept;
}

struct FewPoints {
  std::array<glm::dvec3, 12> at;
  std::size_t size = 0;
  void add(const glm::dvec3& p) {
    if (size < at.size()) at[size++] = p;
  }
};

/// Least value of a convex function on [low, high], by golden sections.
template <class Function>
double least_of_convex(Function&& f, double low, double high) {
  constexpr double golden = 0.61803398874989484820;
  double a = high - golden * (high - low), b = low + golden * (high - low), at_a = f(a), at_b = f(b);
  for (int i = 0; i < 90 && a < b; ++i) {
    if (at_a <= at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = f(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = f(b);
    }
  }
  return std::min({at_a, at_b, f(low), f(high)});
}

}  // namespace

double axis_distance(std::span<const glm::dvec3> polygon, const glm::dvec2& position, double z_low, double z_high) {
  FewPoints points;
  double lowest = infinity, highest = -infinity;
  for (const glm::dvec3& p : polygon) {
    points.add({glm::dvec2(p) - position, p.z});
    lowest = std::min(lowest, p.z);
    highest = std::max(highest, p.z);
  }
  // What only touches the slab from outside is not in it; what lies flat in it is.
  if (lowest >= z_high || highest <= z_low) return infinity;
  if (lowest < z_low) keep_below(points, -1.0, -z_low);
  if (highest > z_high) keep_below(points, 1.0, z_high);
  double least_squared = infinity;
  bool left = false, right = false;
  for (std::size_t i = 0; i < points.size; ++i) {
    const glm::dvec2 a(points.at[i]), b(points.at[(i + 1) % points.size]);
    const glm::dvec2 along = b - a;
    const double length_squared = glm::dot(along, along);
    const double t = length_squared > 0.0 ? std::clamp(-glm::dot(a, along) / length_squared, 0.0, 1.0) : 0.0;
    const glm::dvec2 nearest = a + t * along;
    least_squared = std::min(least_squared, glm::dot(nearest, nearest));
    // Seen edge on, a polygon has no inside: what rounding leaves of its area must not count as one.
    const double turn = a.x * b.y - a.y * b.x, noise = 1e-12 * std::sqrt(length_squared * std::max(glm::dot(a, a), glm::dot(b, b)));
    left = left || turn > noise;
    right = right || turn < -noise;
  }
  if (left != right) return 0.0;  // the axis is on the same side of all edges
  return std::sqrt(least_squared);
}

double axis_distance(const Placing& placing, const SpherePart& part, const glm::dvec2& position, double z_low, double z_high) {
  return axis_distance(SpherePart{part.solid, placing.to_outer(part.centre), placing.scale * part.radius}, position, z_low, z_high);
}

double axis_distance(const Placing& placing, const CylinderPart& part, const glm::dvec2& position, double z_low, double z_high) {
  const glm::dvec3 centre = placing.to_outer(part.centre);
  const double half = placing.scale * part.half_height, radius = placing.scale * part.radius;
  glm::dvec3 axis = placing.turn[2];
  if (axis.z < 0.0) axis = -axis;
  const double lean = std::hypot(axis.x, axis.y);
  if (lean < 1e-12) return axis_distance(CylinderPart{part.solid, centre, radius, half}, position, z_low, z_high);
  // In a frame with x where the axis leans to, a point of the cylinder is (w axis.z + t lean, y, t axis.z - w lean) with |t| <= half and w^2 + y^2 <= radius^2.
  // For a given w, y reaches as far as the circle lets it and t is free between the heights: the distance is a convex function of w alone.
  const glm::dvec2 ahead = glm::dvec2(axis) / lean, off = position - glm::dvec2(centre);
  const double px = glm::dot(off, ahead), py = std::abs(ahead.x * off.y - ahead.y * off.x);
  const double low = z_low - centre.z, high = z_high - centre.z;
  // Which w have any t between the heights: w lean <= t axis.z - low for some |t| <= half, and the like.
  const double w_high = std::min(radius, (half * axis.z - low) / lean), w_low = std::max(-radius, (-half * axis.z - high) / lean);
  if (!(w_low < w_high)) return infinity;
  const auto distance_squared = [&](double w) {
    double t_low = -half, t_high = half;
    if (axis.z > 1e-12) {
      t_low = std::max(t_low, (low + w * lean) / axis.z);
      t_high = std::min(t_high, (high + w * lean) / axis.z);
    }
    const double t = std::clamp((px - w * axis.z) / lean, t_low, std::max(t_low, t_high));
    const double dx = px - (w * axis.z + t * lean), dy = std::max(0.0, py - std::sqrt(std::max(0.0, radius * radius - w * w)));
    return dx * dx + dy * dy;
  };
  return std::sqrt(least_of_convex(distance_squared, w_low, w_high));
}

double axis_distance(const Placing& placing, const BoxPart& part, const glm::dvec2& position, double z_low, double z_high) {
  std::array<glm::dvec3, 8> corner;
  double lowest = infinity, highest = -infinity;
  for (unsigned i = 0; i < 8; ++i) {
    const glm::dvec3 inner(i & 1 ? part.high.x : part.low.x, i & 2 ? part.high.y : part.low.y, i & 4 ? part.high.z : part.low.z);
    corner[i] = placing.to_outer(part.frame + out_of_frame(part, inner));
    lowest = std::min(lowest, corner[i].z);
    highest = std::max(highest, corner[i].z);
  }
  if (lowest >= z_high || highest <= z_low) return infinity;
  // Whether the axis itself is in the box between the heights.
  PartInterval interval;
  const glm::dvec3 from = placing.to_inner({position, z_low}), up = placing.direction_to_inner({0.0, 0.0, 1.0});
  if (cross(part, from, up, interval) && interval.leave > 0.0 && interval.enter < z_high - z_low) return 0.0;
  static constexpr unsigned faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  double least = infinity;
  for (const auto& face : faces) {
    const std::array<glm::dvec3, 4> polygon = {corner[face[0]], corner[face[1]], corner[face[2]], corner[face[3]]};
    least = std::min(least, axis_distance(polygon, position, z_low, z_high));
  }
  return least;
}

}  // namespace thicket

#include "parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/worlds/scene.hpp"

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

 private:
  void add_box(const glm::dvec3& frame, double yaw, const glm::dvec3& low, const glm::dvec3& high) const {
    parts_.boxes.push_back({index_, frame, std::cos(yaw), std::sin(yaw), low, high});
  }

  Parts& parts_;
  std::uint32_t index_;
  glm::dvec3 position_;
  double yaw_;
};

glm::dvec3 into_frame(const BoxPart& b, const glm::dvec3& v) { return {b.cosine * v.x + b.sine * v.y, b.cosine * v.y - b.sine * v.x, v.z}; }
glm::dvec3 out_of_frame(const BoxPart& b, const glm::dvec3& v) { return {b.cosine * v.x - b.sine * v.y, b.sine * v.x + b.cosine * v.y, v.z}; }

/// Cuts an interval with the slab low <= x < high. The half-open slab gives a ray that runs along a shared face to exactly one of its two boxes.
/// `face` is the code of the low side; the high side's is `face` + 1.
bool cut(double low, double high, double origin, double direction, std::int8_t face, PartInterval& interval) {
  if (direction == 0.0) return origin >= low && origin < high;
  double t_low = (low - origin) / direction, t_high = (high - origin) / direction;
  std::int8_t enter_face = face, leave_face = static_cast<std::int8_t>(face + 1);
  if (t_low > t_high) {
    std::swap(t_low, t_high);
    std::swap(enter_face, leave_face);
  }
  if (t_low > interval.enter) {
    interval.enter = t_low;
    interval.enter_face = enter_face;
  }
  if (t_high < interval.leave) {
    interval.leave = t_high;
    interval.leave_face = leave_face;
  }
  return interval.enter < interval.leave;
}

constexpr std::int8_t side = 6;  // the curved face of a sphere or cylinder; 0...5 are -x, +x, -y, +y, -z, +z

/// Ranges at which a t^2 + 2 b t + c = 0, given its discriminant b^2 - a c; false if there are none or the line only touches.
bool roots(double a, double b, double c, double discriminant, double& near, double& far) {
  if (!(discriminant > 0.0)) return false;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  near = q / a;
  far = q == 0.0 ? 0.0 : c / q;
  if (near > far) std::swap(near, far);
  return near < far;
}

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

bool cross(const SpherePart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
  // Solved about the point of the line that is nearest to the centre: as exact for a small sphere far away as for a near one.
  const glm::dvec3 to_centre = part.centre - origin;
  const double nearest = glm::dot(to_centre, direction);
  const glm::dvec3 off = to_centre - nearest * direction;
  const double half_squared = part.radius * part.radius - glm::dot(off, off);
  if (!(half_squared > 0.0)) return false;
  const double half = std::sqrt(half_squared);
  interval = {nearest - half, nearest + half, side, side};
  return true;
}

bool cross(const CylinderPart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
  const glm::dvec3 o = origin - part.centre;
  interval = {-infinity, infinity, side, side};
  const double a = direction.x * direction.x + direction.y * direction.y;
  const double c = o.x * o.x + o.y * o.y - part.radius * part.radius;
  if (a > 0.0) {
    // b^2 - a c by Lagrange's identity: b^2 and a c by themselves would cancel where the cylinder is thin and far away.
    const double off = o.x * direction.y - o.y * direction.x;
    const double discriminant = a * part.radius * part.radius - off * off;
    if (!roots(a, o.x * direction.x + o.y * direction.y, c, discriminant, interval.enter, interval.leave)) return false;
  } else if (!(c < 0.0)) {
    return false;
  }
  return cut(-part.half_height, part.half_height, o.z, direction.z, 4, interval);
}

bool cross(const BoxPart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
  const glm::dvec3 o = into_frame(part, origin - part.frame), d = into_frame(part, direction);
  interval = {-infinity, infinity, 0, 0};
  return cut(part.low.x, part.high.x, o.x, d.x, 0, interval) && cut(part.low.y, part.high.y, o.y, d.y, 2, interval) &&
         cut(part.low.z, part.high.z, o.z, d.z, 4, interval);
}

glm::dvec3 part_normal(const SpherePart& part, const glm::dvec3& point, int) { return glm::normalize(point - part.centre); }

namespace {
glm::dvec3 face_normal(int face) {
  glm::dvec3 normal(0.0);
  normal[face / 2] = face % 2 ? 1.0 : -1.0;
  return normal;
}
}  // namespace

glm::dvec3 part_normal(const CylinderPart& part, const glm::dvec3& point, int face) {
  if (face != side) return face_normal(face);
  return glm::normalize(glm::dvec3(point.x - part.centre.x, point.y - part.centre.y, 0.0));
}

glm::dvec3 part_normal(const BoxPart& part, const glm::dvec3&, int face) { return out_of_frame(part, face_normal(face)); }

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

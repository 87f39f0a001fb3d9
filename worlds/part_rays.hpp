// The exact answer of every part to a ray. In a header, because this is what tracing spends its time with. Private to the room.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "parts.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

inline glm::dvec3 into_frame(const BoxPart& b, const glm::dvec3& v) { return {b.cosine * v.x + b.sine * v.y, b.cosine * v.y - b.sine * v.x, v.z}; }
inline glm::dvec3 out_of_frame(const BoxPart& b, const glm::dvec3& v) { return {b.cosine * v.x - b.sine * v.y, b.sine * v.x + b.cosine * v.y, v.z}; }

/// Cuts an interval with the slab low <= x < high. The half-open slab gives a ray that runs along a shared face to exactly one of its two boxes.
/// `face` is the code of the low side; the high side's is `face` + 1.
inline bool cut(double low, double high, double origin, double direction, std::int8_t face, PartInterval& interval) {
  if (direction == 0.0) return origin >= low && origin < high;
  const bool down = direction < 0.0;  // the high side is met first
  const double enter = ((down ? high : low) - origin) / direction, leave = ((down ? low : high) - origin) / direction;
  if (enter > interval.enter) {
    interval.enter = enter;
    interval.enter_face = static_cast<std::int8_t>(face + down);
  }
  if (leave < interval.leave) {
    interval.leave = leave;
    interval.leave_face = static_cast<std::int8_t>(face + !down);
  }
  return interval.enter < interval.leave;
}

inline constexpr std::int8_t side = 6;  // the curved face of a sphere or cylinder; 0...5 are -x, +x, -y, +y, -z, +z

/// Ranges at which a t^2 + 2 b t + c = 0, given its discriminant b^2 - a c; false if there are none or the line only touches.
inline bool roots(double a, double b, double c, double discriminant, double& near, double& far) {
  if (!(discriminant > 0.0)) return false;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  near = q / a;
  far = q == 0.0 ? 0.0 : c / q;
  if (near > far) std::swap(near, far);
  return near < far;
}

/// Where a line is inside a part; false if it misses the part or only touches it.
inline bool cross(const SpherePart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
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

inline bool cross(const CylinderPart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
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

inline bool cross(const BoxPart& part, const glm::dvec3& origin, const glm::dvec3& direction, PartInterval& interval) {
  const glm::dvec3 o = into_frame(part, origin - part.frame), d = into_frame(part, direction);
  interval = {-infinity, infinity, 0, 0};
  return cut(part.low.x, part.high.x, o.x, d.x, 0, interval) && cut(part.low.y, part.high.y, o.y, d.y, 2, interval) &&
         cut(part.low.z, part.high.z, o.z, d.z, 4, interval);
}

/// Outward unit normal at a point of the surface.
inline glm::dvec3 part_normal(const SpherePart& part, const glm::dvec3& point, int) { return glm::normalize(point - part.centre); }

inline glm::dvec3 face_normal(int face) {
  const double along = face % 2 ? 1.0 : -1.0;
  return {face / 2 == 0 ? along : 0.0, face / 2 == 1 ? along : 0.0, face / 2 == 2 ? along : 0.0};
}

inline glm::dvec3 part_normal(const CylinderPart& part, const glm::dvec3& point, int face) {
  if (face != side) return face_normal(face);
  return glm::normalize(glm::dvec3(point.x - part.centre.x, point.y - part.centre.y, 0.0));
}

inline glm::dvec3 part_normal(const BoxPart& part, const glm::dvec3&, int face) { return out_of_frame(part, face_normal(face)); }

}  // namespace thicket

// The exact answer of a triangle to a ray: neighbours never both miss a ray on their common edge or corner, and never both take it. Private to the room.
//
// After Woop, Benthin & Wald, "Watertight ray/triangle intersection", JCGT 2013: the corners are sheared so that the ray becomes an axis, and the hit is decided in the
// plane. Two things are added: the sign of an edge is exact for the sheared corners, and a ray through an edge or a corner counts as moved by (e, e^2), e -> 0
// (Edelsbrunner & Mücke, "Simulation of simplicity", 1990). Each corner is sheared the same way for all its triangles, so a line crosses a closed mesh as
// often inward as outward: always, and not only nearly always.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace thicket {

/// A ray as triangles see it. The direction may have any length; ranges are in units of it.
struct ShearedRay {
  glm::dvec3 origin{0.0}, direction{1.0, 0.0, 0.0};
  int x = 1, y = 2, z = 0;  ///< z: the axis that the ray is nearest to
  double shear_x = 0.0, shear_y = 0.0;

  ShearedRay() = default;
  ShearedRay(const glm::dvec3& from, const glm::dvec3& along) : origin(from), direction(along) {
    const glm::dvec3 size(std::abs(along.x), std::abs(along.y), std::abs(along.z));
    z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    if (along[z] < 0.0) std::swap(x, y);  // keeps what is counter-clockwise
    shear_x = along[x] / along[z];
    shear_y = along[y] / along[z];
  }
};

struct TriangleHit {
  double range = 0.0;
  bool enters = false;  ///< the ray goes against the triangle's normal
};

namespace triangle_rays_detail {

struct Corner {
  double x, y, z;
};

inline Corner sheared(const ShearedRay& ray, const glm::dvec3& point) {
  // Through pointers: an index into a glm vector is a switch.
  const double *p = &point.x, *o = &ray.origin.x;
  const double z = p[ray.z] - o[ray.z];
  return {(p[ray.x] - o[ray.x]) - ray.shear_x * z, (p[ray.y] - o[ray.y]) - ray.shear_y * z, z};
}

/// Whether three numbers lie strictly on one side of 0.
inline bool one_side(double a, double b, double c) { return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0); }

/// On which side of the edge a -> b the moved axis passes: the sign of a.x b.y - a.y b.x, and of what the move adds where that is 0.
inline int edge_sign(const Corner& a, const Corner& b) {
  // Rounding is monotonic: products that differ after rounding differ the same way before it.
  const double p = a.x * b.y, q = a.y * b.x;
  if (p != q) return p > q ? 1 : -1;
  const double rest_p = std::fma(a.x, b.y, -p), rest_q = std::fma(a.y, b.x, -q);
  if (rest_p != rest_q) return rest_p > rest_q ? 1 : -1;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  if (a.x != b.x) return b.x > a.x ? 1 : -1;
  return 0;
}

/// Whether the origin is on the outer side of the triangle's plane; on the plane counts as outside, whatever the ray's direction.
inline bool outside_plane(const glm::dvec3& origin, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  using Long = glm::vec<3, long double>;
  const Long p = Long(a) - Long(origin), q = Long(b) - Long(origin), r = Long(c) - Long(origin);
  const Long normal = glm::cross(Long(b) - Long(a), Long(c) - Long(a));
  const long double height = glm::dot(normal, p);  // > 0: inside
  const long double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}) *
                           std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(r.x), std::abs(r.y), std::abs(r.z)});
  return height <= 1e-18L * size;
}

/// Whether a triangle is so thin that rounding turns its plane: by more than 1e-8.
inline bool needle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return glm::dot(normal, normal) < 1e-16 * longest * longest;
}

/// The depth of a needle where a ray passes it: how far along its longest edge, and then how far from there to its third corner, as it looks along the ray. What rounding makes of the second counts for no more than the
/// needle is wide.
inline double depth_of_needle(const Corner& p, const Corner& q, const Corner& r) {
  const auto square = [](const Corner& a, const Corner& b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); };
  const Corner *from = &p, *to = &q, *third = &r;
  if (square(q, r) > square(*from, *to)) from = &q, to = &r, third = &p;
  if (square(r, p) > square(*from, *to)) from = &r, to = &p, third = &q;
  const double x = to->x - from->x, y = to->y - from->y, z = to->z - from->z, length = x * x + y * y;
  if (!(length > 0.0)) return std::min({p.z, q.z, r.z});
  const auto edge_depth = [&](double px, double py) { return from->z + std::clamp((px * x + py * y) / length, 0.0, 1.0) * z; };
  const double off = y * from->x - x * from->y, third_off = x * (third->y - from->y) - y * (third->x - from->x);
  const double share = third_off != 0.0 ? std::clamp(off / third_off, 0.0, 1.0) : 0.0;
  return edge_depth(-from->x, -from->y) + share * (third->z - edge_depth(third->x - from->x, third->y - from->y));
}

}  // namespace triangle_rays_detail

/// The unit normal of a triangle; zero if it has no area. However small the triangle, its squares do not vanish.
inline glm::dvec3 unit_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  return size >= std::numeric_limits<double>::min() ? glm::normalize(normal / size) : glm::dvec3(0.0);
}

/// Whether a ray meets a triangle a, b, c (counter-clockwise from outside) at a range >= 0.
inline bool meet(const ShearedRay& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, TriangleHit& hit) {
  using namespace triangle_rays_detail;
  const Corner p = sheared(ray, a), q = sheared(ray, b), r = sheared(ray, c);
  // Most triangles that Embree offers lie beside the axis: the signs of their edges, which are exact, could not agree.
  if (one_side(p.x, q.x, r.x) || one_side(p.y, q.y, r.y)) return false;
  const int way = edge_sign(p, q);
  if (way == 0 || edge_sign(q, r) != way || edge_sign(r, p) != way) return false;
  hit.enters = way < 0;
  // By the plane, which is the same for all triangles of a flat face; but never nearer or farther than the corners are, however thin the triangle.
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double slope = glm::dot(normal, ray.direction);
  const auto [nearest, farthest] = std::minmax({p.z, q.z, r.z});
  const double along = ray.direction[ray.z];
  const double by_plane = slope != 0.0 && !needle(a, b, c, normal) ? glm::dot(normal, a - ray.origin) / slope * along : depth_of_needle(p, q, r);
  const double depth = std::clamp(by_plane, nearest, farthest);
  hit.range = depth / along;
  const double doubtful = 1e-9 * std::max({std::abs(p.z), std::abs(q.z), std::abs(r.z)});
  if (std::abs(depth) > doubtful) return hit.range > 0.0;
  // The origin is on the triangle, or nearly: decided by the plane alone, so that all rays from here agree on what they start inside of.
  if (outside_plane(ray.origin, a, b, c) != hit.enters) return false;
  hit.range = std::max(0.0, hit.range);
  return true;
}

}  // namespace thicket

// Truth at a point: every shape asked by its own formula.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "plan.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

/// Whether a ray to the east leaves a ring an odd number of times.
bool odd(const std::vector<glm::dvec2>& ring, const glm::dvec2& p) {
  bool in = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))) in = !in;
  }
  return in;
}

/// How often a closed mesh winds about a point: the solid angles of its triangles by 4 pi, each by van Oosterom & Strackee 1983, eq. 8.
double winding_number(const Mesh& mesh, const glm::dvec3& p) {
  double angle = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x] - p, b = mesh.vertices[t.y] - p, c = mesh.vertices[t.z] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    angle += 2.0 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return angle / (4.0 * pi);
}

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double square = glm::dot(along, along), t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * along);
}

double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double area = glm::length(normal);
  const auto within = [&](const glm::dvec3& from, const glm::dvec3& to) { return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0; };
  if (area > 0.0 && within(a, b) && within(b, c) && within(c, a)) return std::abs(glm::dot(p - a, normal)) / area;
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// Whether a point of the solid's frame lies in the shape.
struct Inside {
  glm::dvec3 p;

  bool operator()(const Box& b) const { return std::abs(p.x) <= 0.5 * b.size.x && std::abs(p.y) <= 0.5 * b.size.y && std::abs(p.z) <= 0.5 * b.size.z; }
  bool operator()(const Sphere& s) const { return glm::length(p) <= s.radius; }
  bool operator()(const Cylinder& c) const { return std::hypot(p.x, p.y) <= c.radius && std::abs(p.z) <= 0.5 * c.height; }
  bool operator()(const Wall& w) const {
    if (p.z < 0.0 || p.z > w.height) return false;
    const glm::dvec2 q(p);
    const double half = 0.5 * w.thickness;
    for (std::size_t i = 1; i < w.points.size(); ++i) {
      const glm::dvec2 leg = w.points[i] - w.points[i - 1], from_start = q - w.points[i - 1];
      const double length = glm::length(leg), ahead = glm::dot(from_start, leg) / length, aside = (leg.x * from_start.y - leg.y * from_start.x) / length;
      if (ahead >= 0.0 && ahead <= length && std::abs(aside) <= half) return true;
      const bool joint = i + 1 < w.points.size() || w.points.back() == w.points.front();
      if (joint && glm::distance(q, w.points[i]) <= half) return true;
    }
    return false;
  }
  bool operator()(const MapSolid& m) const {
    const glm::dvec2 cell = glm::dvec2(p) / m.grid.resolution;
    const bool on_map = cell.x >= 0.0 && cell.y >= 0.0 && cell.x < m.grid.width && cell.y < m.grid.height && p.z >= 0.0 && p.z < m.height;
    return on_map && m.matter(static_cast<int>(cell.x), static_cast<int>(cell.y));
  }
  bool operator()(const Prism& s) const {
    if (p.z < 0.0 || p.z > s.height) return false;
    bool in = odd(s.outline, glm::dvec2(p));
    for (const auto& hole : s.holes) in ^= odd(hole, glm::dvec2(p));
    return in;
  }
  bool operator()(const MeshSolid& m) const {
    const Mesh& mesh = *m.mesh;
    const glm::dvec3 q = p / m.scale;
    const double half = mesh.closed ? 0.0 : 0.5 * m.sheet_thickness / m.scale;
    for (int i = 0; i < 3; ++i)
      if (q[i] < mesh.low[i] - half || q[i] > mesh.high[i] + half) return false;
    if (mesh.closed) return std::abs(winding_number(mesh, q)) > 0.5;
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3& t) {
      return distance_to_triangle(q, mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]) <= half;
    });
  }
};

}  // namespace

bool inside(const Solid& solid, const glm::dvec3& point) {
  return std::visit(Inside{glm::transpose(plan::turn_of(solid)) * (point - solid.position)}, solid.shape);
}

bool in_matter(const World& world, const glm::dvec3& point, bool only_stops_motion) {
  return std::any_of(world.solids.begin(), world.solids.end(),
                     [&](const Solid& solid) { return (!only_stops_motion || world.materials[solid.material].stops_motion) && inside(solid, point); });
}

Matter matter_at(const World& world, const glm::dvec3& point) {
  Matter matter;
  for (const Solid& solid : world.solids) {
    if (!inside(solid, point)) continue;
    const Material& material = world.materials[solid.material];
    matter.any = true;
    matter.attenuation_db_per_m = std::max(matter.attenuation_db_per_m, material.attenuation_db_per_m);
    matter.stops_motion |= material.stops_motion;
  }
  return matter;
}

}  // namespace thicket

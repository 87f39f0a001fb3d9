// What rays and hulls meet, found the slow way by formulas of this file alone: every solid is asked, in extended precision, and nothing of
// the room's own tracing is used.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::brute {

using Real = long double;
using Vec2 = glm::vec<2, Real>;
using Vec3 = glm::vec<3, Real>;

/// A convex piece of a solid: a ball, a round pillar, or a block that stands on one of its faces.
struct Piece {
  enum class Kind { ball, pillar, block } kind;
  Vec3 centre;
  Vec3 half;        ///< half sizes; of a ball and a pillar x is the radius
  Vec2 axis{1, 0};  ///< of a block: where its own x points
};

inline Vec2 turned(const Vec2& v, Real yaw) {
  return {std::cos(yaw) * v.x - std::sin(yaw) * v.y, std::sin(yaw) * v.x + std::cos(yaw) * v.y};
}

struct PiecesOf {
  Vec3 position;
  Real yaw;
  std::vector<Piece> pieces;

  Vec2 placed(const Vec2& p) const { return Vec2(position) + turned(p, yaw); }
  void block(const Vec2& middle, const Vec2& half, const Vec2& axis, Real z_low, Real z_high) {
    pieces.push_back({Piece::Kind::block, Vec3(middle, (z_low + z_high) / 2), Vec3(half, (z_high - z_low) / 2), axis});
  }
  void operator()(const Box& b) {
    block(Vec2(position), Vec2(b.size) / Real(2), turned({1, 0}, yaw), position.z - Real(b.size.z) / 2, position.z + Real(b.size.z) / 2);
  }
  void operator()(const Sphere& s) { pieces.push_back({Piece::Kind::ball, position, Vec3(s.radius)}); }
  void operator()(const Cylinder& c) { pieces.push_back({Piece::Kind::pillar, position, Vec3(c.radius, c.radius, Real(c.height) / 2)}); }
  void operator()(const Wall& w) {
    const Real half = Real(w.thickness) / 2, top = position.z + Real(w.height);
    const bool ring = w.points.front() == w.points.back();
    for (std::size_t i = 0; i + 1 < w.points.size(); ++i) {
      const Vec2 a = placed(Vec2(w.points[i])), b = placed(Vec2(w.points[i + 1]));
      block((a + b) / Real(2), {glm::distance(a, b) / 2, half}, glm::normalize(b - a), position.z, top);
      if (i > 0 || ring) pieces.push_back({Piece::Kind::pillar, Vec3(a, (position.z + top) / 2), Vec3(half, half, (top - position.z) / 2)});
    }
  }
  void operator()(const MapSolid& m) {
    const Real cell = m.grid.resolution;
    for (int row = 0; row < m.grid.height; ++row)
      for (int column = 0; column < m.grid.width; ++column)
        if (m.matter(column, row))
          block(placed(Vec2(Real(column) + Real(0.5), Real(row) + Real(0.5)) * cell), Vec2(cell / 2), turned({1, 0}, yaw), position.z,
                position.z + Real(m.height));
  }
  void operator()(const Prism&) { throw std::logic_error("no pieces of a prism"); }
  void operator()(const MeshSolid&) { throw std::logic_error("no pieces of a mesh"); }
};

/// The pieces of a solid; a map cell by cell.
inline std::vector<Piece> pieces_of(const Solid& solid) {
  PiecesOf visitor{Vec3(solid.position), Real(solid.yaw), {}};
  std::visit(visitor, solid.shape);
  return visitor.pieces;
}

/// The pieces of all solids of a world.
inline std::vector<std::vector<Piece>> pieces_of(const World& world) {
  std::vector<std::vector<Piece>> all;
  for (const Solid& solid : world.solids) all.push_back(pieces_of(solid));
  return all;
}

// --- rays ---

struct Stretch {
  Real enter = -std::numeric_limits<Real>::infinity(), leave = std::numeric_limits<Real>::infinity();
  Vec3 enter_normal{0}, leave_normal{0};

  bool empty() const { return !(enter < leave); }
  /// Keeps the part of the line with normal . point <= level.
  void keep_behind(const Vec3& normal, Real level, const Vec3& origin, const Vec3& direction) {
    const Real slope = glm::dot(normal, direction), room = level - glm::dot(normal, origin);
    if (slope == 0) {
      if (room < 0) leave = -std::numeric_limits<Real>::infinity();
    } else if (slope < 0 && room / slope > enter) {
      enter = room / slope;
      enter_normal = normal;
    } else if (slope > 0 && room / slope < leave) {
      leave = room / slope;
      leave_normal = normal;
    }
  }
};

/// |start + t way| <= radius, in two or three dimensions: the quadratic formula of any textbook, from the point of the line that is nearest
/// to the middle.
template <class V>
bool round_stretch(const V& start, const V& way, Real radius, Real& enter, Real& leave) {
  const Real a = glm::dot(way, way);
  if (!(a > 0)) return false;
  const Real nearest = -glm::dot(start, way) / a;
  const V from = start + nearest * way;
  const Real b = 2 * glm::dot(from, way), c = glm::dot(from, from) - radius * radius;
  const Real discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return false;
  enter = nearest + (-b - std::sqrt(discriminant)) / (2 * a);
  leave = nearest + (-b + std::sqrt(discriminant)) / (2 * a);
  return true;
}

/// Whether the line passes the ball around a piece by more than rounding: a shortcut, nothing else.
inline bool far_off(const Piece& piece, const Ray& ray) {
  const glm::dvec3 o = ray.origin - glm::dvec3(piece.centre);
  const glm::dvec3 off = o - glm::dot(o, ray.direction) * ray.direction;
  const glm::dvec3 half(piece.half);
  const double reach = 1.001 * (piece.kind == Piece::Kind::ball ? half.x : glm::length(half)) + 0.001;
  return glm::dot(off, off) > reach * reach;
}

/// Where the whole line is inside a piece.
inline Stretch stretch(const Piece& piece, const Vec3& origin, const Vec3& direction) {
  Stretch s;
  const Vec3 o = origin - piece.centre;
  if (piece.kind == Piece::Kind::ball) {
    if (!round_stretch(o, direction, piece.half.x, s.enter, s.leave)) return {1, 0, {}, {}};
    s.enter_normal = glm::normalize(o + s.enter * direction);
    s.leave_normal = glm::normalize(o + s.leave * direction);
    return s;
  }
  if (piece.kind == Piece::Kind::pillar) {
    if (round_stretch(Vec2(o), Vec2(direction), piece.half.x, s.enter, s.leave)) {
      s.enter_normal = Vec3(glm::normalize(Vec2(o + s.enter * direction)), 0);
      s.leave_normal = Vec3(glm::normalize(Vec2(o + s.leave * direction)), 0);
    } else if (glm::length(Vec2(o)) >= piece.half.x || Vec2(direction) != Vec2(0)) {
      return {1, 0, {}, {}};
    }
  } else {
    const Vec3 x(piece.axis, 0), y(-piece.axis.y, piece.axis.x, 0);
    s.keep_behind(x, piece.half.x, o, direction);
    s.keep_behind(-x, piece.half.x, o, direction);
    s.keep_behind(y, piece.half.y, o, direction);
    s.keep_behind(-y, piece.half.y, o, direction);
  }
  s.keep_behind({0, 0, 1}, piece.half.z, o, direction);
  s.keep_behind({0, 0, -1}, piece.half.z, o, direction);
  return s;
}

/// All crossings of a ray with a world as `Scene::crossings` promises them: parts of one solid that touch are one, what ends behind the ray
/// or begins beyond its range is left out, and sorted by (enter, leave, solid).
inline std::vector<Crossing> crossings(const std::vector<std::vector<Piece>>& solids, const Ray& ray) {
  constexpr Real touching = 1e-12L;
  std::vector<Crossing> all;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    std::vector<Stretch> list;
    for (const Piece& piece : solids[i]) {
      if (far_off(piece, ray)) continue;
      const Stretch s = stretch(piece, Vec3(ray.origin), Vec3(ray.direction));
      if (!s.empty()) list.push_back(s);
    }
    std::sort(list.begin(), list.end(), [](const Stretch& a, const Stretch& b) { return a.enter < b.enter; });
    std::vector<Stretch> joined;
    for (const Stretch& s : list) {
      if (joined.empty() || s.enter > joined.back().leave + touching) {
        joined.push_back(s);
      } else if (s.leave > joined.back().leave) {
        joined.back().leave = s.leave;
        joined.back().leave_normal = s.leave_normal;
      }
    }
    for (const Stretch& s : joined) {
      if (!(s.leave > 0) || s.enter > Real(ray.range_max)) continue;
      Crossing c;
      c.solid = static_cast<std::uint32_t>(i);
      c.starts_inside = s.enter < 0;
      c.enter = static_cast<double>(std::max(Real(0), s.enter));
      c.leave = static_cast<double>(s.leave);
      c.enter_normal = c.starts_inside ? glm::dvec3(0.0) : glm::dvec3(s.enter_normal);
      c.leave_normal = glm::dvec3(s.leave_normal);
      all.push_back(c);
    }
  }
  std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
    if (a.enter != b.enter) return a.enter < b.enter;
    return a.leave != b.leave ? a.leave < b.leave : a.solid < b.solid;
  });
  return all;
}

// --- hulls ---

/// What a piece has between two heights, seen from above: a disc, or a rectangle. Nothing if it only touches that slab.
struct Plan {
  bool any = false;
  Vec2 centre{0}, half{0}, axis{1, 0};
  Real radius = 0;  ///< of a disc; 0: it is a rectangle

  Vec2 local(const Vec2& p) const { return {glm::dot(p - centre, axis), glm::dot(p - centre, Vec2(-axis.y, axis.x))}; }
};

inline Plan plan_between(const Piece& piece, Real z_low, Real z_high) {
  Plan plan{true, Vec2(piece.centre), Vec2(piece.half), piece.axis, 0};
  const Real bottom = piece.centre.z - piece.half.z, top = piece.centre.z + piece.half.z;
  if (!(bottom < z_high && z_low < top)) return {};
  if (piece.kind == Piece::Kind::pillar) plan.radius = piece.half.x;
  if (piece.kind == Piece::Kind::ball) {
    const Real height = std::clamp(piece.centre.z, z_low, z_high) - piece.centre.z;  // of the widest circle in the slab, above its middle
    plan.radius = std::sqrt(piece.half.x * piece.half.x - height * height);
  }
  return plan;
}

/// The plans of everything that stops motion between two heights, each with the number of its solid.
struct PlanOfSolid {
  Plan plan;
  std::uint32_t solid;
};
inline std::vector<PlanOfSolid> plans_between(const World& world, double z_low, double z_high) {
  std::vector<PlanOfSolid> plans;
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
    if (!world.material_of(i).stops_motion) continue;
    for (const Piece& piece : pieces_of(world.solids[i]))
      if (const Plan plan = plan_between(piece, z_low, z_high); plan.any) plans.push_back({plan, i});
  }
  return plans;
}

/// Distance of a point in the plane from a plan, 0 inside.
inline Real distance(const Plan& plan, const Vec2& point) {
  if (plan.radius > 0) return std::max(Real(0), glm::distance(point, plan.centre) - plan.radius);
  const Vec2 p = plan.local(point);
  return glm::distance(p, glm::clamp(p, -plan.half, plan.half));
}

/// Least s >= 0 at which the point start + s direction is nearer to a plan than `grow`; +inf if it never is. In closed form: a grown
/// rectangle is two rectangles and four discs.
inline Real first_nearer(const Plan& plan, const Vec2& start, const Vec2& direction, Real grow) {
  Real first = std::numeric_limits<Real>::infinity();
  const auto disc = [&](const Vec2& centre, Real radius) {
    Real enter = 0, leave = 0;
    if (round_stretch(start - centre, direction, radius, enter, leave) && leave > 0) first = std::min(first, std::max(Real(0), enter));
  };
  if (plan.radius > 0) {
    disc(plan.centre, plan.radius + grow);
    return first;
  }
  const Vec2 side(-plan.axis.y, plan.axis.x);
  for (const Vec2& more : {Vec2(grow, 0), Vec2(0, grow)}) {
    Stretch s;
    const Vec2 half = plan.half + more;
    const Vec3 o(start - plan.centre, 0), d(direction, 0);
    s.keep_behind(Vec3(plan.axis, 0), half.x, o, d);
    s.keep_behind(Vec3(-plan.axis, 0), half.x, o, d);
    s.keep_behind(Vec3(side, 0), half.y, o, d);
    s.keep_behind(Vec3(-side, 0), half.y, o, d);
    if (!s.empty() && s.leave > 0) first = std::min(first, std::max(Real(0), s.enter));
  }
  for (const Real i : {-1, 1})
    for (const Real j : {-1, 1}) disc(plan.centre + i * plan.half.x * plan.axis + j * plan.half.y * side, grow);
  return first;
}

}  // namespace thicket::brute

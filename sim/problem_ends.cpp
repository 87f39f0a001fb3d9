// Families of problems that are about start and goal: in or near matter, and about the line between them.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"

namespace thicket {
namespace {

/// Up to some convex things in a square of a half size, far enough from all else that there is.
void scatter(ProblemMaker& m, int wanted, double half) {
  for (int i = 0; i < wanted; ++i)
    for (int attempt = 0; attempt < 20; ++attempt) {
      const double radius = m.length(0.1, 0.9), free = radius + m.keep + m.doubt;
      const glm::dvec2 centre = m.within({half, half});
      if (m.distance(centre) < radius + m.open || glm::length(centre - m.start.position) < free || glm::length(centre - m.goal) < free) continue;
      m.convex(centre, radius);
      break;
    }
}

double free_distance(const ProblemMaker& m) { return m.keep + m.doubt + 0.01; }

/// Turned as a whole: by any angle, or so that its walls lie along the axes.
void turn(ProblemMaker& m) {
  if (m.chance(0.5)) m.mirror();
  m.rotate(m.chance(0.6) ? m.angle() : 0.5 * pi * m.whole(0, 3));
}

/// A box whose face, edge or inside an end lies at; `distance` before the middle part of a face, whichever of the four.
glm::dvec2 before_a_face(ProblemMaker& m, const glm::dvec2& centre, const glm::dvec2& half, double distance) {
  const int face = m.whole(0, 3);
  const double along = m.uniform(-0.9, 0.9);
  const double side = face < 2 ? 1.0 : -1.0;
  return centre + (face % 2 ? glm::dvec2(side * (half.x + distance), along * half.y) : glm::dvec2(along * half.x, side * (half.y + distance)));
}

}  // namespace

void make_goal(ProblemMaker& m) {
  const double half = m.length(4.5, 6.0), free = free_distance(m), radius = m.robot.vehicle.radius_m;
  const int kind = static_cast<int>(m.number % 6);
  const bool walled = kind == 5 || m.chance(0.5);
  if (walled) m.arena(half);
  const glm::dvec2 size{m.length(0.8, 2.5), m.length(0.8, 2.5)}, centre{m.length(0.3, 1.2), m.length(-1.0, 1.0)};
  m.box(centre, size);
  const double west = -half + free + m.length(0.0, 0.8), span = half - free;
  m.start.position = {west, m.uniform(-span, span)};
  m.goal_is_free = false;
  switch (kind) {
    case 0: m.goal = centre + m.within(0.4 * size); break;                                                    // inside matter
    case 1: m.goal = before_a_face(m, centre, 0.5 * size, m.uniform(0.05, 1.0) * radius); break;              // where the hull would be in matter
    case 2: m.goal = before_a_face(m, centre, 0.5 * size, radius + m.uniform(0.05, 0.9) * (std::max(m.keep - m.doubt, radius) - radius)); break;  // hull free, clearance not
    case 3: {  // off a corner, at just the distance that is kept
      const glm::dvec2 corner{m.chance(0.5) ? 1.0 : -1.0, m.chance(0.5) ? 1.0 : -1.0};
      m.goal = centre + corner * (0.5 * size + m.keep * direction(m.uniform(0.02, 0.5 * pi - 0.02)));
      break;
    }
    case 4:  // the start's clearance is not kept
      m.goal = m.start.position;
      m.goal_is_free = true;
      m.start_is_free = false;
      m.start.position = before_a_face(m, centre, 0.5 * size, radius + m.uniform(0.1, 0.9) * (std::max(m.keep - m.doubt, radius) - radius));
      break;
    default: m.goal = {half + (m.chance(0.5) ? 0.1 * m.unit : m.length(0.2, 2.0)), m.uniform(-span, span)};  // in the outer wall, or behind it
  }
  scatter(m, m.whole(0, 3), half);
  turn(m);
}

namespace {

/// Nothing but one thing that the straight way (the x axis) is tangent to when it has grown.
void make_tangent(ProblemMaker& m, double reach) {
  const double x = m.length(-0.8, 0.8);
  const glm::dvec2 size{m.length(0.3, 2.0), m.length(0.1, 2.0)};
  switch (m.whole(0, 3)) {
    case 0: m.box({x, -0.5 * size.y - m.keep}, size); break;                                                 // an edge
    case 1: m.box({x, -size.x * std::sqrt(0.5) - m.keep}, {size.x, size.x}, 0.25 * pi); break;               // the arc about a vertex
    case 2: m.box({x, -size.x * std::sqrt(0.5)}, {size.x, size.x}, 0.25 * pi); break;                        // the way goes through the vertex of matter
    default: m.post({x, -0.5 * size.x - m.keep}, 0.5 * size.x);
  }
  m.start.position = {-reach, 0.0};
  m.goal = {reach, 0.0};
}

void make_along_a_wall(ProblemMaker& m, double reach) {
  const double thickness = m.length(0.05, 0.3), from = m.length(-1.5, -0.5), to = m.length(0.3, 1.5);
  double y = 0.0;  // the way is the wall's own middle line
  switch (m.whole(0, 3)) {
    case 1: y = 0.5 * thickness; break;           // its face
    case 2: y = 0.5 * thickness + m.keep; break;  // the edge of it grown
    case 3: y = 0.5 * thickness + m.keep + m.uniform(-0.1, 0.1); break;
    default: break;
  }
  m.wall({{from, y}, {to, y}}, thickness);
  if (m.chance(0.3)) m.wall({{from, y - m.open - thickness}, {to, y - m.open - thickness}}, thickness);  // a corridor
  m.start.position = {-reach, 0.0};
  m.goal = {reach, 0.0};
}

/// The start as near to a box as may be: beside the way, or in front of it, where the way crosses the edge of the grown box.
void make_touching(ProblemMaker& m, double reach, bool in_the_way) {
  const glm::dvec2 size{m.length(0.3, 2.0), m.length(0.3, 2.0)};
  const double distance = m.keep + 1e-3, offset = m.uniform(-0.45, 0.45);
  m.start.position = {-0.5 * reach, 0.0};
  m.goal = {reach, m.length(-0.5, 0.5)};
  if (in_the_way) m.goal.y = 0.0;
  m.start_is_free = false;
  const glm::dvec2 beside = in_the_way ? glm::dvec2(distance + 0.5 * size.x, offset * size.y)
                                       : glm::dvec2(offset * size.x, m.chance(0.5) ? distance + 0.5 * size.y : -distance - 0.5 * size.y);
  m.box(m.start.position + beside, size);
}

/// A wall between two ends that are as near to it as may be: from side to side of the arena, or with ways round it.
void make_wall_between(ProblemMaker& m) {
  const double thickness = m.length(0.01, 0.2), half = m.length(4.0, 5.0), apart = 0.5 * thickness + free_distance(m) + m.length(0.0, 0.1);
  m.start.position = {-apart, m.length(-1.5, 1.5)};
  m.goal = {apart, m.start.position.y};
  m.arena(half);
  const bool closed = m.chance(0.7);
  const double end = closed ? half + 0.05 * m.unit : half - m.open - m.length(0.1, 1.0);
  m.wall({{0.0, -half - 0.05 * m.unit}, {0.0, end}}, thickness);
}

}  // namespace

void make_m_line(ProblemMaker& m) {
  const double reach = m.length(2.5, 4.5);
  const int kind = static_cast<int>(m.number % 7);
  switch (kind) {
    case 0: make_tangent(m, reach); break;
    case 1: make_along_a_wall(m, reach); break;
    case 2: make_touching(m, reach, false); break;
    case 3: make_touching(m, reach, true); break;
    case 4:  // start and goal are one, or nearly
      m.start.position = m.within({reach, reach});
      m.goal = m.start.position + m.away(m.length(0.0, 0.5));
      break;
    case 5: make_wall_between(m); break;
    default: make_tangent(m, reach);
  }
  if (kind != 5) {
    // In an arena or not, and something else here and there, out of the way.
    const double half = reach + m.keep + m.doubt + m.length(0.02, 0.3);
    if (m.chance(0.5)) m.arena(std::max(half, 2.5 * m.unit + m.open));
    if (kind == 4 || m.chance(0.3)) scatter(m, m.whole(1, 4), half);
  }
  turn(m);
}

}  // namespace thicket

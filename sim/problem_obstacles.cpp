// Families of problems made of separate things: convex obstacles, random worlds.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"

namespace thicket {
namespace {

/// Start in the west, goal in the east of a square of a half size.
void place_ends(ProblemMaker& m, double half) {
  const double reach = half - m.keep - m.doubt - 0.01;
  m.start.position = {-reach + m.length(0.0, 1.2), m.uniform(-reach, reach)};
  m.goal = {reach - m.length(0.0, 1.2), m.uniform(-reach, reach)};
}

}  // namespace

void make_convex(ProblemMaker& m) {
  const bool walled = m.chance(0.5);
  const double half = m.length(4.5, 6.0);
  if (walled) m.arena(half);
  place_ends(m, half);
  struct Circle {
    glm::dvec2 centre;
    double radius;
  };
  std::vector<Circle> circles;
  // So far apart that no two of them become one when they grow: each stays convex.
  const auto fits = [&](const Circle& c) {
    if (walled && std::max(std::abs(c.centre.x), std::abs(c.centre.y)) + c.radius + m.open > half) return false;
    for (const glm::dvec2& end : {m.start.position, m.goal})
      if (glm::length(end - c.centre) < c.radius + m.keep + m.doubt) return false;
    return std::none_of(circles.begin(), circles.end(), [&](const Circle& o) { return glm::length(o.centre - c.centre) < o.radius + c.radius + m.open; });
  };
  const int wanted = m.whole(1, 7);
  for (int i = 0; i < wanted; ++i)
    for (int attempt = 0; attempt < 30; ++attempt) {
      const double radius = m.length(0.15, i == 0 ? 2.0 : 1.2);
      glm::dvec2 centre = m.within({half, half});
      if (i == 0) {  // in the way
        const glm::dvec2 way = m.goal - m.start.position, across = glm::dvec2(-way.y, way.x) / glm::length(way);
        const glm::dvec2 at{m.uniform(0.25, 0.75), m.uniform(-1.0, 1.0)};
        centre = m.start.position + at.x * way + at.y * radius * across;
      }
      if (!fits({centre, radius})) continue;
      circles.push_back({centre, radius});
      m.convex(centre, radius);
      break;
    }
}

void make_random(ProblemMaker& m) {
  const double half = m.length(4.0, 6.0);
  m.arena(half);
  place_ends(m, half);
  const int things = m.whole(3, 12);
  for (int i = 0; i < things; ++i) {
    const glm::dvec2 at = m.within({0.85 * half, half});
    const int kind = m.whole(0, 3);
    const double yaw = m.angle();
    if (kind == 0) {
      m.post(at, m.length(0.05, 0.8));
    } else if (kind == 1) {
      const glm::dvec2 end = at + m.length(0.5, 4.0) * direction(yaw);
      m.wall({at, end}, m.length(0.05, 0.3));
    } else {
      m.box(at, {m.length(0.3, 3.0), m.length(0.1, 1.0)}, yaw);
    }
  }
  if (m.chance(0.25)) {  // a pen, closed or with a side as good as missing
    const bool about_goal = m.chance(0.6);
    const double inner = 0.5 * m.open + m.length(0.05, 0.5);
    const double yaw = m.angle(), gap = m.chance(0.7) ? 0.0 : 1.99 * inner;
    m.pen(about_goal ? m.goal : m.start.position, {inner, inner}, yaw, gap, m.length(0.02, 0.2));
  }
  if (m.chance(0.15)) {  // a wall from side to side
    const double x = m.uniform(-0.3, 0.3) * half, lean = m.uniform(-0.2, 0.2) * half;
    m.wall({{x - lean, -half - 0.05 * m.unit}, {x + lean, half + 0.05 * m.unit}}, m.length(0.02, 0.2));
  }
}

}  // namespace thicket

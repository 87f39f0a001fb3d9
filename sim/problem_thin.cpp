// A family of problems about what is thin, narrow, or touches: walls between the rays, gaps that are none, obstacles that become one when they grow.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"

namespace thicket {
namespace {

/// Where the things of a family are: an arena, start in the west, goal in the east, things between x = -middle and middle.
struct Arena {
  double half, middle;
};

/// How far into the outer wall something goes that is to touch it without a doubt.
double rim(const ProblemMaker& m) { return 0.1 * m.unit; }

double thinnest(ProblemMaker& m) { return m.uniform(0.002, 0.02); }

/// A thin wall, or two, from side to side; with a way round one of its ends, or without.
void make_thin_walls(ProblemMaker& m, const Arena& arena, bool closed) {
  const int walls = closed ? 1 : m.whole(1, 2);
  double side = m.chance(0.5) ? 1.0 : -1.0;
  for (int i = 0; i < walls; ++i) {
    const double x = walls == 1 ? m.uniform(-1.0, 1.0) * arena.middle : (i == 0 ? -1.0 : 1.0) * std::max(arena.middle, 0.5 * m.open + 0.05 * m.unit);
    const double end = closed ? arena.half + rim(m) : arena.half - m.open - m.length(0.05, 1.0);
    m.wall({{x, -side * (arena.half + rim(m))}, {x, side * end}}, thinnest(m));
    side = -side;
  }
}

/// A wall from side to side with a gap that light goes through and no robot.
void make_sliver(ProblemMaker& m, const Arena& arena) {
  const double thickness = m.chance(0.5) ? thinnest(m) : m.length(0.05, 0.4), gap = m.uniform(0.01, 0.8 * m.closed), at = m.uniform(-0.7, 0.7) * arena.half;
  m.wall({{0.0, -arena.half - rim(m)}, {0.0, at}}, thickness);
  m.wall({{0.0, at + gap}, {0.0, arena.half + rim(m)}}, thickness);
}

/// Two boxes that meet in one point, from side to side but for a way round one of them or none.
void make_pinch(ProblemMaker& m, const Arena& arena, bool closed) {
  const glm::dvec2 at = m.within({0.3 * arena.middle, 0.4 * arena.half});
  const double west = m.length(0.1, 0.8), east = m.length(0.1, 0.8);
  const double south = at.y + arena.half + rim(m), north = closed ? arena.half + rim(m) - at.y : std::max(arena.half - m.open - at.y - m.length(0.0, 0.3), 0.2 * m.unit);
  m.box({at.x - 0.5 * west, at.y - 0.5 * south}, {west, south});
  m.box({at.x + 0.5 * east, at.y + 0.5 * north}, {east, north});
}

/// Boxes that stand at the outer wall, flush with it or a little in it.
void make_at_the_edge(ProblemMaker& m, const Arena& arena) {
  const int boxes = m.whole(1, 2);
  double side = m.chance(0.5) ? 1.0 : -1.0;
  for (int i = 0; i < boxes; ++i) {
    const double depth = m.uniform(0.2, 0.95) * (2.0 * arena.half - m.open), into = m.chance(0.5) ? 0.0 : rim(m), width = m.length(0.1, 0.8);
    const double x = boxes == 1 ? 0.0 : (i == 0 ? -1.0 : 1.0) * (0.5 * m.open + 0.5 * m.unit);
    m.box({x, side * (arena.half - 0.5 * (depth - into))}, {width, depth + into});
    side = -side;
  }
}

/// Boxes in a row with gaps between them that close when they grow; with ways round the row, or none.
void make_merging(ProblemMaker& m, const Arena& arena, bool closed) {
  double y = closed ? -arena.half + m.uniform(0.0, 0.9) * m.closed : -m.uniform(0.2, 0.6) * arena.half;
  const double end = closed ? arena.half : arena.half - m.open;
  while (true) {
    const glm::dvec2 size{m.length(0.1, 0.8), m.length(0.3, 2.0)};
    if (!closed && y + size.y > end) break;
    // Each stands near the row's middle line, or gaps would be wider than they are along it.
    m.box({m.uniform(-0.05, 0.05) * m.unit, y + 0.5 * size.y}, size);
    y += size.y + m.uniform(0.1, 0.95) * m.closed;
    if (closed && y > end) break;
  }
}

/// Posts of 1 to 3 cm: apart, or a fence from side to side.
void make_posts(ProblemMaker& m, const Arena& arena, bool closed) {
  const auto radius = [&] { return m.uniform(0.005, 0.015); };
  if (closed) {
    for (double y = -arena.half; y < arena.half; y += m.uniform(0.4, 0.9) * m.closed) m.post({m.uniform(-0.1, 0.1) * m.closed, y}, radius());
    return;
  }
  const double spacing = m.open + m.length(0.05, 0.5);
  const glm::dvec2 shift = m.within({0.5 * spacing, 0.5 * spacing});
  for (int i = -1; i <= 1; ++i)
    for (int j = -2; j <= 2; ++j) {
      const glm::dvec2 at = shift + spacing * glm::dvec2(i, j);
      if (std::abs(at.x) > arena.half - 2.0 * m.open || std::abs(at.y) > arena.half - m.open) continue;
      m.post(at, radius());
    }
}

void make_thin_pen(ProblemMaker& m, bool closed) {
  const double least = 0.5 * m.open + 0.05 * m.unit;
  const glm::dvec2 inner{least + m.length(0.0, 0.5), least + m.length(0.05, 0.5)};
  const double yaw = m.angle();
  m.pen(m.goal, inner, yaw, closed ? 0.0 : m.open, thinnest(m));
}

}  // namespace

void make_thin(ProblemMaker& m) {
  const double half = m.length(4.0, 5.5), free = m.keep + m.doubt + 0.01;
  m.arena(half);
  const double span = half - free;
  m.start.position = {-half + free + m.length(0.0, 0.3), m.uniform(-span, span)};
  m.goal = {half - free - m.length(0.0, 0.3), m.uniform(-span, span)};
  const Arena arena{half, half - 2.0 * free - 0.8 * m.unit};
  const bool closed = m.number / 7 % 3 == 0;
  switch (m.number % 7) {
    case 0: make_thin_walls(m, arena, closed); break;
    case 1: make_sliver(m, arena); break;
    case 2: make_pinch(m, arena, closed); break;
    case 3: make_at_the_edge(m, arena); break;
    case 4: make_merging(m, arena, closed); break;
    case 5: make_posts(m, arena, closed); break;
    default:
      m.goal = m.within({0.3 * half, 0.3 * half});
      make_thin_pen(m, closed);
  }
  if (m.chance(0.5)) m.mirror();
  m.rotate(m.chance(0.5) ? m.angle() : 0.5 * pi * m.whole(0, 3));
}

}  // namespace thicket

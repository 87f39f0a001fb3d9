// Families of problems made of walls that go round something: U, spiral, pens.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"

namespace thicket {
namespace {

/// Start and goal change places.
void swap_ends(ProblemMaker& m) { std::swap(m.start.position, m.goal); }

/// A U that is open to the west, or closed all round; the start inside, the goal behind it.
void make_u(ProblemMaker& m, bool closed) {
  const double free = m.keep + m.doubt + 0.01, thickness = m.length(0.05, 0.4);
  const double width = m.open + thickness + m.length(0.1, 2.5), upper = m.length(1.8, 4.0), lower = m.length(1.8, 4.0);
  std::vector<glm::dvec2> points = {{-upper, 0.5 * width}, {0.0, 0.5 * width}, {0.0, -0.5 * width}, {-lower, -0.5 * width}};
  if (closed) points = {{0.0, 0.0}, {0.0, -0.5 * width}, {-lower, -0.5 * width}, {-lower, 0.5 * width}, {0.0, 0.5 * width}, {0.0, 0.0}};
  m.wall(std::move(points), thickness);
  const double slack = 0.5 * (width - thickness) - free;
  m.start.position = {-0.5 * thickness - free - m.length(0.0, 0.1), m.uniform(-slack, slack)};
  m.goal = {0.5 * thickness + free + m.length(0.0, 2.0), m.uniform(-0.5, 0.5) * width};
  if (m.chance(0.5)) m.arena(std::max({upper, lower, m.goal.x + free, 0.5 * width}) + 0.5 * thickness + m.open + m.length(0.0, 0.5));
}

/// A spiral of round or straight arms about the start; the goal outside. `closed`: something stands across its last arm.
void make_round_spiral(ProblemMaker& m, bool closed) {
  const double free = m.keep + m.doubt + 0.01, thickness = m.length(0.05, 0.3);
  const double pitch = m.open + thickness + m.length(0.1, 0.4), turns = m.uniform(1.1, 1.8);
  const double first = free + 0.5 * thickness + m.length(0.05, 0.3);
  const auto radius_at = [&](double turn) { return (first + pitch * turn) / std::cos(pi / 48.0); };  // so that the middles of its straight pieces are no nearer
  std::vector<glm::dvec2> points;
  const int pieces = static_cast<int>(std::ceil(turns * 24.0));
  for (int i = 0; i <= pieces; ++i) points.push_back(radius_at(i / 24.0) * direction(2.0 * pi * i / 24.0));
  const glm::dvec2 last = points.back(), inner = points[static_cast<std::size_t>(pieces - 24)];
  m.wall(std::move(points), thickness);
  if (closed) m.wall({last, inner}, thickness);
  m.start.position = {0.0, 0.0};
  const double outside = radius_at(turns) + pitch / 24.0 + 0.5 * thickness + free;
  m.goal = m.away(outside + m.length(0.0, 1.5));
  if (m.chance(0.3)) m.arena(std::max(outside + m.keep + m.doubt, glm::length(m.goal) + free));
}

void make_square_spiral(ProblemMaker& m, bool closed) {
  const double free = m.keep + m.doubt + 0.01, thickness = m.length(0.05, 0.3);
  const double pitch = m.open + thickness + m.length(0.0, 0.4), side = pitch + m.length(0.0, 0.5);
  const int arms = m.whole(5, 7);
  std::vector<glm::dvec2> points = {{0.0, 0.0}};
  glm::dvec2 along(1.0, 0.0), middle(0.0), inward(0.0);
  glm::dvec2 low(0.0), high(0.0);
  for (int i = 0; i < arms; ++i) {
    const double reach = side + pitch * (i / 2);
    middle = points.back() + 0.5 * reach * along;
    points.push_back(points.back() + reach * along);
    along = {-along.y, along.x};
    inward = along;
    low = glm::min(low, points.back());
    high = glm::max(high, points.back());
  }
  m.wall(std::move(points), thickness);
  if (closed) m.wall({middle, middle + pitch * inward}, thickness);
  m.start.position = {0.5 * side, 0.5 * side};
  const glm::dvec2 centre = 0.5 * (low + high), half = 0.5 * (high - low) + 0.5 * thickness + free;
  const glm::dvec2 way = direction(m.angle());
  m.goal = centre + way * (m.length(0.0, 1.0) + std::min(half.x / std::abs(way.x), half.y / std::abs(way.y)));
  m.translate(-centre);
  if (m.chance(0.3)) m.arena(std::max({half.x, half.y, std::abs(m.goal.x), std::abs(m.goal.y)}) + free);
}

}  // namespace

void make_spiral(ProblemMaker& m) {
  const bool closed = m.number % 10 >= 7;
  switch (m.number % 3) {
    case 0: make_u(m, closed); break;
    case 1: make_round_spiral(m, closed); break;
    default: make_square_spiral(m, closed);
  }
  if (m.chance(0.5)) swap_ends(m);  // from inside, from outside
  if (m.chance(0.5)) m.mirror();    // of either sense
  m.rotate(m.angle());
}

void make_enclosed(ProblemMaker& m) {
  const double hull = 2.0 * m.robot.vehicle.radius_m, narrow = 0.5 * hull, wide = 2.0 * (hull + 2.0 * m.robot.clearance_m);
  double gap = 0.0;
  switch (m.number % 8) {
    case 2: case 5: gap = narrow; break;
    case 3: case 4: gap = std::max(wide, m.open); break;
    case 7: gap = m.uniform(narrow, wide); break;
    default: break;  // closed
  }
  const double half = m.length(5.0, 6.0);
  const bool walled = m.chance(0.5);
  if (walled) m.arena(half);
  const double thickness = m.length(0.02, 0.3), least = 0.5 * m.open + 0.05 * m.unit;
  const glm::dvec2 inner{least + m.length(0.0, 1.0), std::max(least, 0.5 * gap + 0.1 * m.unit) + m.length(0.0, 0.7)};
  // All the way round it outside is open: the pen's farthest corner is far enough from the arena.
  const double room = std::max(half - m.open - glm::length(inner + thickness), 0.0);
  const glm::dvec2 centre = m.within({room, room});
  const double yaw = m.angle();
  if (gap == 0.0 && m.chance(0.3)) {  // of posts
    const double radius = m.length(0.02, 0.15), spacing = m.uniform(0.4, 0.9) * m.closed + 2.0 * radius, ring = glm::length(inner) + radius;
    const int posts = static_cast<int>(std::ceil(2.0 * pi * ring / spacing));
    for (int i = 0; i < posts; ++i) m.post(centre + ring * direction(yaw + 2.0 * pi * i / posts), radius);
  } else {
    m.pen(centre, inner, yaw, gap, thickness);
  }
  const glm::dvec2 slack = inner - (m.keep + m.doubt);
  m.start.position = Pose2{centre, yaw}.to_outer(m.within(slack));
  const double reach = half - m.keep - m.doubt;
  for (int attempt = 0; attempt < 40; ++attempt) {
    m.goal = m.within({reach, reach});
    if (m.is_free(m.goal) && glm::length(m.goal - centre) > glm::length(inner)) break;
  }
  if (m.number / 8 % 2 == 0) swap_ends(m);  // the goal is enclosed, or the start
}

}  // namespace thicket

// Worlds that a reader can see, for tests of planners: discs, and maps of letters. Planners get contours, as from a sensor, and move a point robot that obeys at once.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/random.hpp"
#include "thicket/nav/planner.hpp"

namespace thicket {

struct Disc {
  glm::dvec2 centre{0.0};
  double radius = 1.0;
};

/// '#' is matter, 'S' the start, 'T' the goal. The first row is the north edge, a letter is a square of `cell` m, what is outside is free.
struct LetterMap {
  std::vector<std::string> rows;
  double cell = 1.0;

  bool matter(int x, int y) const {  // x from the west, y from the south
    if (y < 0 || y >= height() || x < 0) return false;
    const std::string& row = rows[rows.size() - 1 - static_cast<std::size_t>(y)];
    return x < static_cast<int>(row.size()) && row[static_cast<std::size_t>(x)] == '#';
  }
  int height() const { return static_cast<int>(rows.size()); }
  int width() const {
    std::size_t widest = 0;
    for (const std::string& row : rows) widest = std::max(widest, row.size());
    return static_cast<int>(widest);
  }
  glm::dvec2 find(char letter) const {
    for (std::size_t r = 0; r < rows.size(); ++r)
      if (const auto c = rows[r].find(letter); c != std::string::npos)
        return cell * glm::dvec2(static_cast<double>(c) + 0.5, static_cast<double>(rows.size() - 1 - r) + 0.5);
    FAIL("no such letter in the map");
    return {};
  }
  LetterMap mirrored() const {
    LetterMap mirror = *this;
    std::reverse(mirror.rows.begin(), mirror.rows.end());
    return mirror;
  }
  /// How far a ray goes, from cell to cell.
  double range(const glm::dvec2& from, const glm::dvec2& along, double limit) const {
    const glm::dvec2 at = from / cell;
    int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    const int step_x = along.x > 0.0 ? 1 : -1, step_y = along.y > 0.0 ? 1 : -1;
    constexpr double never = std::numeric_limits<double>::infinity();
    const double delta_x = along.x == 0.0 ? never : std::abs(1.0 / along.x), delta_y = along.y == 0.0 ? never : std::abs(1.0 / along.y);
    double next_x = along.x == 0.0 ? never : (along.x > 0.0 ? x + 1 - at.x : at.x - x) * delta_x, next_y = along.y == 0.0 ? never : (along.y > 0.0 ? y + 1 - at.y : at.y - y) * delta_y;
    const double end = std::min(limit / cell, glm::distance(at, 0.5 * glm::dvec2(width(), height())) + width() + height());
    for (;;) {
      const double here = std::min(next_x, next_y);
      if (here > end) return std::numeric_limits<double>::infinity();
      if (next_x < next_y) {
        x += step_x;
        next_x += delta_x;
      } else {
        y += step_y;
        next_y += delta_y;
      }
      if (matter(x, y)) return here * cell;
    }
  }
  /// Distance to the nearest matter, up to `limit`.
  double clearance(const glm::dvec2& at, double limit) const {
    const int reach = static_cast<int>(std::ceil(limit / cell)), cx = static_cast<int>(std::floor(at.x / cell)), cy = static_cast<int>(std::floor(at.y / cell));
    double least = limit;
    for (int y = cy - reach; y <= cy + reach; ++y)
      for (int x = cx - reach; x <= cx + reach; ++x)
        if (matter(x, y)) least = std::min(least, glm::distance(at, glm::clamp(at, cell * glm::dvec2(x, y), cell * glm::dvec2(x + 1, y + 1))));
    return least;
  }
};

/// A world and where it lies: planners shall not care.
struct TestWorld {
  std::vector<Disc> discs;
  LetterMap map;
  Pose2 placement;

  double range(const glm::dvec2& from, const glm::dvec2& along, double limit) const {
    double range = map.rows.empty() ? std::numeric_limits<double>::infinity() : map.range(from, along, limit);
    for (const Disc& disc : discs) {
      const glm::dvec2 to = disc.centre - from;
      const double middle = glm::dot(to, along), half = disc.radius * disc.radius - (glm::dot(to, to) - middle * middle);
      if (half > 0.0 && middle - std::sqrt(half) > 0.0) range = std::min(range, middle - std::sqrt(half));
    }
    return range <= limit ? range : std::numeric_limits<double>::infinity();
  }
};

struct TestSensor {
  int rays = 360;
  double range = std::numeric_limits<double>::infinity();
  double noise = 0.0;  ///< standard deviation, m
};

/// `pose` in the world's own frame.
inline void see(const TestWorld& world, const Pose2& pose, const TestSensor& sensor, std::uint64_t scan, Contour& contour) {
  const Random random(1, 0);
  contour.clear();
  for (int i = 0; i < sensor.rays; ++i) {
    const double bearing = -pi + 2.0 * pi * i / sensor.rays;
    double range = world.range(pose.position, direction(pose.yaw + bearing), sensor.range);
    if (sensor.noise > 0.0 && std::isfinite(range))
      range = std::max(0.0, range + sensor.noise * random.normal(scan, static_cast<std::uint32_t>(i), RandomUse::range_noise, 0)[0]);
    contour.push_back({std::isfinite(range) ? range * direction(bearing) : glm::dvec2(0.0), range, bearing});
  }
}

struct Run {
  Decision last;
  double length = 0.0, least = 1e9, side = 0.0;  ///< side: the largest deviation to the left (+) or right (-) of the straight way along x
  std::vector<Mark> marks;
  std::vector<glm::dvec2> track;  ///< every decision, in the world's own frame
};

inline VehicleLimits test_vehicle() {
  VehicleLimits vehicle;
  vehicle.hull_radius = 0.2;
  vehicle.speed = 0.5;
  vehicle.turn_rate = 2.0;
  vehicle.turn_acceleration = 10.0;
  return vehicle;
}

/// From `start`, which like the goal is in the outer frame.
inline Run drive(const TestWorld& world, const PlannerSpec& spec, Pose2 pose = {}, const TestSensor& sensor = {}, int steps = 20000) {
  const VehicleLimits vehicle = test_vehicle();
  auto planner = make_planner(spec, vehicle, pose);
  REQUIRE(planner);
  BumperRing bumpers(BumperSpec{}, vehicle.hull_radius, press_distance(BumperSpec{}, spec, vehicle));
  Run run;
  Contour contour;
  for (int step = 0; step < steps; ++step) {
    const Pose2 inner{world.placement.to_inner(pose.position), wrap_angle(pose.yaw - world.placement.yaw)};
    see(world, inner, sensor, static_cast<std::uint64_t>(step), contour);
    run.track.push_back(inner.position);
    bumpers.read(contour);
    run.least = std::min(run.least, bumpers.nearest());
    run.last = (*planner)->decide({0.1 * step, pose, run.last.command.speed, run.last.command.turn_rate, contour, bumpers});
    if (run.last.outcome != Outcome::running) break;
    pose.yaw = wrap_angle(pose.yaw + 0.1 * run.last.command.turn_rate);
    pose.position += 0.1 * run.last.command.speed * direction(pose.yaw);
    run.length += 0.1 * run.last.command.speed;
    if (std::abs(pose.position.y) > std::abs(run.side)) run.side = pose.position.y;
  }
  run.marks = (*planner)->marks();
  return run;
}
inline Run drive(const std::vector<Disc>& discs, const PlannerSpec& spec) { return drive(TestWorld{discs, {}, {}}, spec); }

inline PlannerSpec to(double x, double y, const char* name, const char* hand) {
  PlannerSpec spec;
  spec.name = name;
  spec.goal_m = glm::dvec2(x, y);
  spec.hand = hand;
  spec.clearance_m = 0.4;
  return spec;
}

/// From S to T, facing T.
inline Run drive(const LetterMap& map, const char* name, const char* hand, const TestSensor& sensor = {}, const Pose2& placement = {}, int steps = 20000) {
  const glm::dvec2 start = placement.to_outer(map.find('S')), goal = placement.to_outer(map.find('T'));
  return drive(TestWorld{{}, map, placement}, to(goal.x, goal.y, name, hand), {start, bearing(goal - start)}, sensor, steps);
}

inline std::size_t count(const std::vector<Mark>& marks, const std::string& label) {
  return static_cast<std::size_t>(std::count_if(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.label == label; }));
}

/// Length of the shortest way from S to T with the robot's axis `keep` m from matter, on a grid of `step` m with eight neighbours (up to 8 % too long), or infinity. The world is the
/// map and four metres around it.
inline double shortest(const LetterMap& map, double keep, double step = 0.2) {
  const int border = static_cast<int>(4.0 / step), nx = static_cast<int>(map.width() * map.cell / step) + 2 * border, ny = static_cast<int>(map.height() * map.cell / step) + 2 * border;
  const auto index = [&](int x, int y) { return static_cast<std::size_t>(y * nx + x); };
  const auto place = [&](int x, int y) { return step * glm::dvec2(x - border, y - border); };
  const auto nearest = [&](const glm::dvec2& p) { return index(static_cast<int>(std::lround(p.x / step)) + border, static_cast<int>(std::lround(p.y / step)) + border); };
  std::vector<double> distance(static_cast<std::size_t>(nx * ny), std::numeric_limits<double>::infinity());
  std::vector<bool> open(distance.size());
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) open[index(x, y)] = map.clearance(place(x, y), 2.0 * keep) >= keep;
  const std::size_t goal = nearest(map.find('T'));
  using Entry = std::pair<double, std::size_t>;
  std::vector<Entry> heap{{0.0, nearest(map.find('S'))}};
  distance[heap.front().second] = 0.0;
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
    const auto [so_far, at] = heap.back();
    heap.pop_back();
    if (at == goal) return so_far;
    if (so_far > distance[at]) continue;
    const int x = static_cast<int>(at) % nx, y = static_cast<int>(at) / nx;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (x + dx < 0 || x + dx >= nx || y + dy < 0 || y + dy >= ny || !open[index(x + dx, y + dy)]) continue;
        const double length = so_far + step * std::hypot(dx, dy);
        if (length >= distance[index(x + dx, y + dy)]) continue;
        distance[index(x + dx, y + dy)] = length;
        heap.push_back({length, index(x + dx, y + dy)});
        std::push_heap(heap.begin(), heap.end(), std::greater<>());
      }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace thicket

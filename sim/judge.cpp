#include "thicket/sim/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace thicket {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Edge of the cells of the first grid map, and where its grid begins; nothing if the world has none, or a turned one.
std::optional<std::pair<double, glm::dvec2>> map_cells(const World& world) {
  for (const Solid& solid : world.solids)
    if (const auto* map = std::get_if<MapSolid>(&solid.shape); map && solid.yaw == 0.0) return std::pair(map->grid.resolution, glm::dvec2(solid.position));
  return std::nullopt;
}

struct Window {
  glm::dvec2 low, high;
  double cell = 0.0;
};

Window window_of(const World& world, const std::vector<glm::dvec2>& points, double margin, double cell) {
  Window window{glm::dvec2(never), glm::dvec2(-never), cell};
  const auto hold = [&](const glm::dvec2& p) {
    window.low = glm::min(window.low, p);
    window.high = glm::max(window.high, p);
  };
  for (const glm::dvec2& p : points) hold(p);
  if (const auto box = extent(world)) {
    hold(glm::dvec2(box->low));
    hold(glm::dvec2(box->high));
  }
  window.low -= margin;
  window.high += margin;
  const auto count = [&](double edge) { return std::ceil((window.high.x - window.low.x) / edge) * std::ceil((window.high.y - window.low.y) / edge); };
  if (const auto map = map_cells(world)) {
    int parts = std::max(1, static_cast<int>(std::lround(map->first / cell)) | 1);
    while (parts > 1 && count(map->first / parts) > Oracle::max_cells) parts -= 2;
    window.cell = map->first / parts;
    window.low = map->second + glm::floor((window.low - map->second) / map->first) * map->first;
  }
  if (const double cells = count(window.cell); cells > Oracle::max_cells) window.cell *= std::sqrt(cells / Oracle::max_cells) * 1.001;
  return window;
}

/// Points of a way over cells that are needed to keep it in free cells: from each, straight to the farthest that is in sight.
double taut_length(const GridPath& path, const FreeSpace& space, double step, const glm::dvec2& from, const glm::dvec2& to) {
  std::vector<glm::dvec2> points = path.points;
  points.front() = from;
  points.back() = to;
  const auto in_sight = [&](const glm::dvec2& a, const glm::dvec2& b) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(glm::distance(a, b) / step)));
    for (int i = 1; i < pieces; ++i)
      if (space.component_at(a + (b - a) * (static_cast<double>(i) / pieces)) == 0) return false;
    return true;
  };
  double length = 0.0;
  for (std::size_t at = 0; at + 1 < points.size();) {
    // Doubling, then halving: ways have thousands of cells. What is in sight need not be in sight all the way, but what is taken is.
    std::size_t seen = at + 1, reach = 1;
    while (at + 2 * reach < points.size() && in_sight(points[at], points[at + 2 * reach])) seen = at + (reach *= 2);
    for (std::size_t more = reach; more > 0; more /= 2)
      if (seen + more < points.size() && in_sight(points[at], points[seen + more])) seen += more;
    length += glm::distance(points[at], points[seen]);
    at = seen;
  }
  return length;
}

}  // namespace

const char* to_string(Expected expected) {
  switch (expected) {
    case Expected::reachable: return "reachable";
    case Expected::unreachable: return "unreachable";
    case Expected::ambiguous: return "ambiguous";
  }
  return "";
}

struct Oracle::State {
  Robot robot;
  double doubt = 0.0;
  DistanceGrid distances;
  std::vector<FreeSpace> spaces;  ///< after growth by keep - doubt, keep, keep + doubt
  TruthGrid grid;                 ///< of the middle one

  template <class Act>
  void each_cell_near(const glm::dvec2& point, double radius, const Act& act) const {
    const glm::dvec2 middle = (point - distances.low) / distances.resolution - 0.5;
    const double reach = radius / distances.resolution;
    for (int row = std::max(0, static_cast<int>(std::ceil(middle.y - reach))); row <= std::min(distances.height - 1, static_cast<int>(std::floor(middle.y + reach))); ++row)
      for (int column = std::max(0, static_cast<int>(std::ceil(middle.x - reach))); column <= std::min(distances.width - 1, static_cast<int>(std::floor(middle.x + reach))); ++column)
        if (glm::distance(distances.node(column, row), point) <= radius) act(column, row);
  }

  /// The components that a robot at the start is in, or can drive to out of the band around matter.
  std::vector<std::uint32_t> begins(const FreeSpace& space, const glm::dvec2& start) const {
    if (const std::uint32_t own = space.component_at(start)) return {own};
    std::vector<std::uint32_t> list;
    const double cell = distances.resolution;
    // Where less than this is left, matter thinner than a cell may lie between the nodes.
    const double clear = std::min(cell, 0.5 * distances.at(start));
    each_cell_near(start, space.grow() - distances.at(start) + 3.0 * cell, [&](int column, int row) {
      const std::uint32_t component = space.component_at(column, row);
      if (component == 0 || std::find(list.begin(), list.end(), component) != list.end()) return;
      const glm::dvec2 there = distances.node(column, row);
      const int pieces = std::max(1, static_cast<int>(std::ceil(2.0 * glm::distance(start, there) / cell)));
      for (int i = 1; i < pieces; ++i)
        if (distances.at(start + (there - start) * (static_cast<double>(i) / pieces)) < clear) return;
      list.push_back(component);
    });
    return list.empty() ? ways_out(space, start) : list;
  }

  /// The components that are near a start which has no straight way out (in a gap, a corner): by ways that come no nearer to matter than it is.
  std::vector<std::uint32_t> ways_out(const FreeSpace& space, const glm::dvec2& start) const {
    std::vector<std::uint32_t> list;
    const double least = distances.at(start) - distances.resolution, radius = 3.0 * space.grow();
    std::vector<glm::ivec2> open = {glm::ivec2((start - distances.low) / distances.resolution)};
    std::vector<std::uint8_t> seen(distances.distance.size(), 0);
    while (!open.empty()) {
      const glm::ivec2 at = open.back();
      open.pop_back();
      if (at.x < 0 || at.y < 0 || at.x >= distances.width || at.y >= distances.height || glm::distance(distances.node(at.x, at.y), start) > radius) continue;
      const std::size_t cell = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(distances.width) + static_cast<std::size_t>(at.x);
      if (seen[cell] || static_cast<double>(distances.distance[cell]) < least || distances.distance[cell] == 0.0f) continue;
      seen[cell] = 1;
      if (const std::uint32_t component = space.component_at(at.x, at.y)) {
        if (std::find(list.begin(), list.end(), component) == list.end()) list.push_back(component);
        continue;
      }
      for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(-1, 0), glm::ivec2(0, -1)}) open.push_back(at + step);
    }
    return list;
  }

  bool reaches(const FreeSpace& space, std::uint32_t component, const glm::dvec2& goal) const {
    if (space.component_at(goal) == component) return true;
    bool found = false;
    each_cell_near(goal, robot.goal_tolerance_m, [&](int column, int row) { found = found || space.component_at(column, row) == component; });
    return found;
  }

  Expected expected(const FreeSpace& space, const std::vector<std::uint32_t>& starts, const glm::dvec2& goal) const {
    bool some = false, all = true;
    for (const std::uint32_t component : starts) {
      const bool joined = reaches(space, component, goal);
      some = some || joined;
      all = all && joined;
    }
    return !some ? Expected::unreachable : all ? Expected::reachable : Expected::ambiguous;
  }

  void bound(const FreeSpace& space, const std::vector<std::uint32_t>& starts, const glm::dvec2& start, const glm::dvec2& goal, Judgement& judgement) const {
    const double straight = judgement.straight_m;
    double bug1 = straight, bug2 = straight, tangent = straight;
    for (const GrownContour& contour : space.contours()) {
      if (std::find(starts.begin(), starts.end(), contour.component) == starts.end()) continue;
      const auto passed = static_cast<double>((crossings(contour, start, goal) + 1) / 2 * 2);
      bug2 += 0.5 * passed * contour.length_m;
      if (distance_from(contour, goal) > straight) continue;
      bug1 += 1.5 * contour.length_m;
      tangent += contour.length_m * (1.0 + static_cast<double>(local_minima(contour, goal, distances.resolution)));
    }
    judgement.bug1_bound_m = std::max(judgement.bug1_bound_m, bug1);
    judgement.bug2_bound_m = std::max(judgement.bug2_bound_m, bug2);
    judgement.tangent_bound_m = std::max(judgement.tangent_bound_m, tangent);
  }

  /// The free cell within the tolerance that is nearest to the goal and joined to a start, if the goal itself is not.
  glm::dvec2 end_for(const FreeSpace& space, const std::vector<std::uint32_t>& starts, const glm::dvec2& goal) const {
    const auto joined = [&](std::uint32_t component) { return std::find(starts.begin(), starts.end(), component) != starts.end(); };
    if (joined(space.component_at(goal))) return goal;
    glm::dvec2 end = goal;
    double least = never;
    each_cell_near(goal, robot.goal_tolerance_m, [&](int column, int row) {
      const glm::dvec2 at = distances.node(column, row);
      if (const double away = glm::distance(at, goal); away < least && joined(space.component_at(column, row))) least = away, end = at;
    });
    return end;
  }
};

Result<Oracle> Oracle::create(const World& world, const std::vector<glm::dvec2>& points, const Robot& robot, double noise_sigma_m, double cell_m) {
  const Window window = window_of(world, points, 3.0 * robot.keep(), cell_m);
  auto state = std::make_shared<State>();
  state->robot = robot;
  state->doubt = 0.1 * robot.clearance_m + window.cell + 3.0 * noise_sigma_m;
  const double widest = robot.keep() + state->doubt;
  const Hull hull = robot.vehicle.hull();
  auto distances = distance_to_matter(world, window.low, window.high, window.cell, widest + 2.0 * window.cell, hull.z_low, hull.z_high);
  if (!distances) return distances.error();
  state->distances = std::move(*distances);
  for (const double change : {-1.0, 0.0, 1.0}) state->spaces.emplace_back(state->distances, std::max(0.0, robot.keep() + change * state->doubt));
  state->grid = state->spaces[1].grid();
  return Oracle(std::move(state));
}

double Oracle::cell() const { return state_->distances.resolution; }

Judgement Oracle::judge(const glm::dvec2& start, const glm::dvec2& goal) const {
  const State& state = *state_;
  Judgement judgement;
  judgement.cell_m = cell();
  judgement.doubt_m = state.doubt;
  judgement.straight_m = glm::distance(start, goal);
  judgement.shortest_m = never;
  std::optional<Expected> verdict;
  for (const FreeSpace& space : state.spaces) {
    const auto starts = state.begins(space, start);
    const Expected here = state.expected(space, starts, goal);
    verdict = !verdict || *verdict == here ? here : Expected::ambiguous;
    state.bound(space, starts, start, goal, judgement);
  }
  judgement.expected = *verdict;

  const FreeSpace& middle = state.spaces[1];
  const auto starts = state.begins(middle, start);
  if (state.distances.contains(start) && middle.component_at(start) != 0) {
    const glm::dvec2 end = state.end_for(middle, starts, goal);
    if (middle.component_at(end) == middle.component_at(start))
      if (const auto path = shortest_path(state.grid, start, end)) judgement.shortest_m = std::max(taut_length(*path, middle, 0.5 * cell(), start, end), glm::distance(start, end));
  }
  return judgement;
}

Result<Judgement> judge(const Problem& problem, const Robot& robot, double noise_sigma_m, double cell_m) {
  const auto oracle = Oracle::create(*problem.world, {problem.start.position, problem.goal}, robot, noise_sigma_m, cell_m);
  if (!oracle) return oracle.error();
  return oracle->judge(problem.start.position, problem.goal);
}

}  // namespace thicket

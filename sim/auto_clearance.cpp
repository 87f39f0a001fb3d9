#include "thicket/sim/auto_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <vector>

#include "thicket/nav/altitude.hpp"
#include "thicket/sim/travel.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

/// The part of the world that matters, and how finely it is judged.
struct Judge {
  World world;  ///< as it is at time 0
  glm::dvec2 low{0.0}, high{0.0};
  double cell = 0.05, radius = 0.0;
  Hull hull;

  /// For a hull whose foot is anywhere from one height to another.
  std::optional<TruthGrid> grown(double clearance, double from, double to) const {
    auto grid = grown_obstacles(world, low, high, cell, radius + 1.1 * clearance + cell, std::min(from, to) + hull.z_low, std::max(from, to) + hull.z_high);
    if (!grid) return std::nullopt;
    return std::move(*grid);
  }
};

Judge make_judge(const Mission& mission, const World& world, const std::vector<glm::dvec2>& stops, double most) {
  Judge judge;
  judge.world = world_at(world, 0.0);
  judge.radius = mission.vehicle.radius_m;
  judge.hull = mission.vehicle.hull();
  judge.low = judge.high = stops.front();
  const auto hold = [&](const glm::dvec2& p) {
    judge.low = glm::min(judge.low, p);
    judge.high = glm::max(judge.high, p);
  };
  for (const glm::dvec2& stop : stops) hold(stop);
  if (const auto box = extent(judge.world)) {
    hold(glm::dvec2(box->low));
    hold(glm::dvec2(box->high));
  }
  // Room for a way around everything.
  const double rim = judge.radius + 1.1 * most + 4.0 * judge.radius;
  judge.low -= rim;
  judge.high += rim;
  constexpr double most_cells = 4e6;
  const glm::dvec2 size = judge.high - judge.low;
  judge.cell = std::max(std::min(0.05, 0.25 * judge.radius), std::sqrt(size.x * size.y / most_cells));
  return judge;
}

/// The largest number in [0, most] for which `holds`, to a thousandth of `most`; nothing if it does not hold for 0. What holds for a number holds for all smaller ones.
std::optional<double> largest(double most, const std::function<bool(double)>& holds) {
  if (holds(most)) return most;
  if (!holds(0.0)) return std::nullopt;
  double yes = 0.0, no = most;
  while (no - yes > 1e-3 * most) {
    const double middle = 0.5 * (yes + no);
    (holds(middle) ? yes : no) = middle;
  }
  return yes;
}

}  // namespace

double auto_clearance(const Mission& mission, const World& world) {
  const double length = std::numbers::sqrt2 * mission.vehicle.radius_m, most = 3.0 * length, least = 0.01 * mission.vehicle.radius_m;
  std::vector<glm::dvec2> stops = {{mission.start.x_m, mission.start.y_m}};
  // What flies is judged at its flight altitude, and from one way-point to the next at every altitude between the two.
  std::vector<double> heights = {travel_heights(mission).front()};
  if (planner_needs(mission.planner.name) == PlannerNeeds::waypoints) {
    stops.insert(stops.end(), mission.planner.waypoints_m.begin(), mission.planner.waypoints_m.end());
    if (mission.vehicle.flies()) std::ranges::copy(waypoint_altitudes(mission.planner, mission.start.z_m), std::back_inserter(heights));
  } else if (mission.planner.goal_m) {
    stops.push_back(*mission.planner.goal_m);
  }
  heights.resize(stops.size(), heights.front());
  const Judge judge = make_judge(mission, world, stops, most);
  if (stops.size() > 1) {
    const auto joined = largest(most, [&](double clearance) {
      std::optional<TruthGrid> grid;
      for (std::size_t i = 1; i < stops.size(); ++i) {
        if (i == 1 || heights[i] != heights[i - 1] || heights[i] != heights[i - 2]) grid = judge.grown(clearance, heights[i - 1], heights[i]);
        if (!grid || !connected(*grid, stops[i - 1], stops[i])) return false;
      }
      return true;
    });
    if (joined) return std::max(*joined, least);
  }
  // No way, however narrow: what start and goal allow, each by itself.
  double clearance = 2.0 * length;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto free = largest(clearance, [&](double c) {
      const auto grid = judge.grown(c, heights[i], heights[i]);
      return grid && connected(*grid, stops[i], stops[i]);
    });
    if (free) clearance = *free;  // one that lies in matter allows none, and none would bring the robot there
  }
  return std::max(clearance, least);
}

Mission with_clearance(const Mission& mission, const World& world) {
  Mission resolved = mission;
  if (!mission.planner.clearance_auto) return resolved;
  resolved.planner.clearance_m = auto_clearance(mission, world);
  resolved.planner.clearance_auto = false;
  resolved.planner.clearance_privileged = true;
  return resolved;
}

}  // namespace thicket

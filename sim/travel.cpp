#include "thicket/sim/travel.hpp"

#include <algorithm>

#include "thicket/nav/altitude.hpp"

namespace thicket {

std::vector<double> travel_heights(const Mission& mission) {
  if (!mission.vehicle.flies()) return {mission.start.z_m};
  std::vector<double> heights = {flight_altitude(mission.planner, mission.start.z_m)};
  if (planner_needs(mission.planner.name) == PlannerNeeds::waypoints)
    for (const double altitude : waypoint_altitudes(mission.planner, mission.start.z_m))
      if (std::ranges::find(heights, altitude) == heights.end()) heights.push_back(altitude);
  return heights;
}

std::pair<double, double> travel_range(const Mission& mission) {
  const auto heights = travel_heights(mission);
  const auto [low, high] = std::ranges::minmax(heights);
  return {low, high};
}

double ground_height(const Mission& mission) { return mission.vehicle.flies() ? 0.0 : mission.start.z_m; }

}  // namespace thicket

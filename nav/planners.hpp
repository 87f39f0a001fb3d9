// One maker a planner; each planner is a file of its own. Private to the room.
#pragma once

#include "thicket/nav/planner.hpp"

namespace thicket {

std::unique_ptr<Planner> make_bug1(const PlannerSpec& spec, const VehicleLimits& vehicle);
std::unique_ptr<Planner> make_bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start);
std::unique_ptr<Planner> make_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle);

}  // namespace thicket

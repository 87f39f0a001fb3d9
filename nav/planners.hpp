// One maker a planner; each planner is a file of its own. Private to the room.
#pragma once

#include "thicket/nav/planner.hpp"

namespace thicket {

std::unique_ptr<Planner> make_bug1(const PlannerSpec& spec, const VehicleLimits& vehicle);
std::unique_ptr<Planner> make_bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start);
std::unique_ptr<Planner> make_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle);
std::unique_ptr<Planner> make_bug2_2012(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_tangent_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_alg1(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_alg2(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_dist_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_com(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_i_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_wall_then_inside(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_bounce(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_center_out(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);
std::unique_ptr<Planner> make_explore(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);

}  // namespace thicket

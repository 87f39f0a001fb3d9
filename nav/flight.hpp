// Flying: what is done around a planner of the plane. Private to the room.
#pragma once

#include <memory>

#include "thicket/nav/planner.hpp"

namespace thicket {

/// The altitude, m, that a flight goes to first: altitude_m, else the start's, else (from the floor) that of the first way-point.
double flight_altitude(const PlannerSpec& spec, double start_altitude);

/// `planner`, which knows nothing of altitudes, at one altitude: takes off to `flight_altitude`, asks the planner while that is held, lands at the end if `spec.land`. Its reasons then say at which altitude. A
/// planner that commands an altitude of its own has it.
std::unique_ptr<Planner> make_flight(std::unique_ptr<Planner> planner, const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);

/// The planner "waypoints" of a vehicle that can move in any direction: along the straight legs, sideways if a heading is to be held, with the altitudes of the way-points.
std::unique_ptr<Planner> make_flown_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);

/// The command that moves a vehicle in pose `pose` with a velocity of the world's frame, m/s, and turns it to a heading, rad.
Command move_in_world(const Pose2& pose, const glm::dvec2& velocity, double heading, const VehicleLimits& vehicle);

}  // namespace thicket

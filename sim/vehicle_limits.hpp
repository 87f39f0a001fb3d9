// What a mission's planner knows of its vehicle. Private to the room.
#pragma once

#include "thicket/sim/mission.hpp"

namespace thicket {

VehicleLimits vehicle_limits(const Mission& mission);

/// The model of a quadrotor that flies this mission.
FlightModel flight_model(const Mission& mission);

}  // namespace thicket

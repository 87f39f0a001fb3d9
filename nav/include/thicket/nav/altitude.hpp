// At which altitudes a mission flies, as its keys tell.
#pragma once

#include <vector>

#include "thicket/nav/planner.hpp"

namespace thicket {

/// The altitude, m, that a flight goes to first: altitude_m, else the start's, else (from the floor) that of the first way-point.
double flight_altitude(const PlannerSpec& spec, double start_altitude);

/// The altitudes of the way-points, m; one that tells none has that of the one before it, the first that of the flight.
std::vector<double> waypoint_altitudes(const PlannerSpec& spec, double start_altitude);

}  // namespace thicket

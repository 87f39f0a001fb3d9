// A clearance computed from the world before the run: what a robot could not know, so that such a run is marked as privileged.
#pragma once

#include "thicket/sim/mission.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// The largest clearance c (m) with which a mission's start and its goal (its way-points, one after the other) are joined for a hull that keeps it, less a margin: they are joined in the world, as it is
/// at time 0, with everything grown by hull radius + 1.1 c + a cell of the grid in which it is judged (a quarter of the hull's radius at most, unless the world has more than four million of those). At most
/// three vehicle lengths, a vehicle's length being the side of the square in its hull's circle.
///
/// Where start and goal are not joined even for the bare hull, or there is no goal: the two vehicle lengths of Rozeboom 2012 (section 5.2), or as much of it as start and goal allow. Never less than a
/// hundredth of the hull's radius.
double auto_clearance(const Mission& mission, const World& world);

/// The mission itself; with `clearance_auto`, one with the number in its place, marked as privileged.
Mission with_clearance(const Mission& mission, const World& world);

}  // namespace thicket

// At which heights a mission's vehicle moves: all that looks at the world before or beside the run asks here.
#pragma once

#include <utility>
#include <vector>

#include "thicket/sim/mission.hpp"

namespace thicket {

/// The z, m, at which the vehicle's foot moves: the start's of one that drives; of one that flies the flight altitude, then, if it comes by way-points, those of theirs that differ. Never empty. Take-offs and
/// landings are not in it.
std::vector<double> travel_heights(const Mission& mission);
/// The lowest and the highest of them.
std::pair<double, double> travel_range(const Mission& mission);

/// The z of the ground, m: under one that drives that of its start, under one that flies 0.
double ground_height(const Mission& mission);

}  // namespace thicket

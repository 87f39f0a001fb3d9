// The parts of the experiments of Billdal 2018, in the order of the page. Private to sim/experiments.
#pragma once

#include <vector>

#include "context.hpp"

namespace thicket {

std::vector<Experiment> strafe_experiments2018();
std::vector<Experiment> sar_experiments2018();
std::vector<Experiment> room_experiments2018();
std::vector<Experiment> cost_experiments2018();

/// Claimed cells of a run's map, and those of them that no surface is near to (0.2 m).
struct ClaimedCells {
  std::size_t all = 0, wrong = 0;
};
ClaimedCells claimed_cells(const Simulation& simulation);

/// Drives a run until it has stood for a second at its last way-point (slower than 1 cm/s after more than half of the way), or to its end. Returns whether it stands.
bool drive_until_standing(Simulation& simulation);

/// A place in the cluttered room, and what stands there.
struct PlacedThing {
  const char* name;
  double x, y, radius;  ///< m; of a circle about it
};
const std::vector<PlacedThing>& cluttered_things();
/// Cells that a run's map claims in the circle grown by 0.2 m.
std::size_t claimed_near(const Simulation& simulation, const PlacedThing& thing);

}  // namespace thicket

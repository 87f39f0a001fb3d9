#include "thicket/sim/map_updates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thicket/sim/simulation.hpp"

namespace thicket {

double MapUpdates::mean() const { return count > 0 ? static_cast<double>(bytes) / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN(); }

void UpdateMeter::note(const Simulation& simulation) {
  if (!simulation.mission().map.enabled) return;
  constexpr double slack = 1e-9;  // of steps that add up to a second
  const double time = simulation.time() + slack;
  if (before_) {
    if (time < due_) return;
    const std::size_t bytes = simulation.map().changes_since(*before_).size();
    ++updates_.count;
    updates_.bytes += bytes;
    updates_.most = std::max(updates_.most, bytes);
  }
  before_.emplace(simulation.map());
  due_ = MapUpdates::every_s * (std::floor(time / MapUpdates::every_s) + 1.0);
}

}  // namespace thicket

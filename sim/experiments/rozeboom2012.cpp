// The experiments of Rozeboom 2012.
#include <fmt/format.h>

#include "context.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

std::string foliage_room(ExperimentContext& context) {
  std::string text;
  const FinishedRun radar = context.run("foliage_wall/map_radar"), lidar = context.run("foliage_wall/map_lidar");
  const glm::dvec4 hidden = *radar.simulation.mission().output.observed_region_m;
  text += "The room is 24 × 16 m.\n\n";
  text += table({"sensor", "share of the hidden room that was observed"},
                {{"radar", percent(observed_share(radar.simulation, hidden).value_or(NAN))}, {"laser of the same range", percent(observed_share(lidar.simulation, hidden).value_or(NAN))}});
  text += context.map_picture("radar", radar, "The map by radar.");
  text += cost_table({"sensor"}, {{{"radar"}, &radar}, {{"laser"}, &lidar}});
  return text;
}

}  // namespace

std::vector<Experiment> rozeboom2012_experiments() {
  return {{"rozeboom2012/foliage_room", "A room divided by foliage", "Rozeboom 2012, figures 6 to 8", "A room divided by foliage spheres.", foliage_room}};
}

}  // namespace thicket

// What is found at which resolution: what the maps of 2018 missed, by a beam radar and by four lobes.
#include <fmt/format.h>

#include "experiments/found_things.hpp"
#include "study_mapping.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket::study {

void study_found() {
  fmt::print("| mission | cells, m | doorway | window | postbox | stop sign | F1 within 0.2 m |\n|---|---:|---|---|---|---|---:|\n");
  for (const char* name : {"findings/beams", "findings/lobes"})
    for (const char* resolution : {"0.5", "0.2", "0.1", "0.05"}) {
      Simulation simulation = or_exit(Simulation::create(or_exit(read_mission(find_input(name), {{"map.resolution_m", resolution, "study"}}))));
      while (simulation.step()) {
      }
      const finds::Found found = finds::found(simulation.map(), simulation.scene().world());
      const auto word = [](bool yes) { return yes ? "found" : "-"; };
      fmt::print("| `{}` | {} | {} | {} | {} | {} | {:.3f} |\n", name, resolution, word(found.doorway), word(found.window), word(found.postbox), word(found.sign), or_exit(score_run(simulation)).map.f1);
    }
}

}  // namespace thicket::study

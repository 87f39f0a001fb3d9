// What the window costs a run: a copy of the state for each frame, and what may be kept to go back.
#include "bench_worlds.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket::bench {

void register_snapshots() {
  for (const char* name : {"rooms/u", "foliage_wall/bug2", "thicket/look_through"}) {
    const auto simulation = std::make_shared<Simulation>(or_exit(Simulation::create(or_exit(read_mission(find_input(name), {})))));
    for (int i = 0; i < 400; ++i) simulation->step();
    measure(std::string("snapshot/") + name, [=](benchmark::State& state) {
      for (auto _ : state) {
        const auto copy = std::make_shared<const Simulation>(*simulation);
        benchmark::DoNotOptimize(copy.get());
      }
      per_item(state, "copy", 1.0);
    });
    measure(std::string("snapshot/") + name + "/and the step after it", [=](benchmark::State& state) {
      for (auto _ : state) {
        state.PauseTiming();
        Simulation run = *simulation;
        const auto copy = std::make_shared<const Simulation>(run);
        state.ResumeTiming();
        run.step();
      }
      per_item(state, "step", 1.0);
    });
  }
}

}  // namespace thicket::bench

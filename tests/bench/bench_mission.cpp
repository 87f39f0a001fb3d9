// Whole missions: stepping alone, start-up and files apart.
#include <tbb/global_control.h>

#include "bench_worlds.hpp"

namespace thicket::bench {
namespace {

void mission(benchmark::State& state, const Mission& what) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Simulation start = or_exit(Simulation::create(what));
  double simulated = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    Simulation simulation = start;
    state.ResumeTiming();
    while (simulation.step()) {
    }
    simulated += simulation.time();
  }
  state.counters["s simulated per CPU s"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
}

}  // namespace

void register_missions() {
  for (const char* name : {"bug1", "bug2", "map_radar"}) {
    const std::string file = std::string("worlds/data/foliage_wall/") + name + ".toml", label = std::string("mission/") + name;
    measure(label + "/map of 0.1 m", [what = shipped_mission(file.c_str())](benchmark::State& s) { mission(s, what); });
    measure(label + "/map of 0.05 m", [what = shipped_mission(file.c_str(), {{"map.resolution_m", "0.05", "bench"}})](benchmark::State& s) { mission(s, what); });
    measure(label + "/no map", [what = shipped_mission(file.c_str(), {{"map.enabled", "false", "bench"}})](benchmark::State& s) { mission(s, what); });
  }
}

}  // namespace thicket::bench

// What the experiments of Billdal 2018 cost: tables 6.1 to 6.4.
#include <fmt/format.h>

#include "billdal2018.hpp"

namespace thicket {
namespace {

struct Flight {
  const char* mission;
  const char* title;
  const char* source;  ///< speed, × real time; CPU of Gazebo and of the mapping node
};

std::string costs(ExperimentContext& context) {
  std::vector<TableRow> rows;
  for (const Flight& flight : {Flight{"strafe/strafe_plate", "strafing, one lobe (6.1)", "1.0; 75 % + 60 %"}, Flight{"ntnu_room/ntnu_room", "test room (6.2)", "1.0; 80 % + 15 %"},
                               Flight{"cluttered_room/cluttered_one", "cluttered room (6.3)", "0.5; 60 % + 55 %"}, Flight{"cargo_hold/along_walls", "cargo hold (6.4)", "0.4; 38 % + 128 %"}})
    for (const char* rays : {"30", "58"}) {
      if (context.brief() && std::string(rays) == "58") continue;
      std::vector<std::string> sets = {std::string("sensor.azimuth_rays=") + rays, std::string("sensor.elevation_rays=") + rays, "sensor.rate_hz=10", "map.resolution_m=0.05"};
      if (context.brief()) sets.push_back("limits.time_s=3");
      const FinishedRun run = context.run(flight.mission, sets);
      const RunCost& cost = run.cost;
      const PhaseTimes& phases = run.simulation.phase_times();
      const auto share = [&](double seconds) { return fixed(100.0 * seconds / cost.wall_s, 0); };
      rows.push_back({flight.title, std::string(rays) == "30" ? "900" : "3364", flight.source, fixed(run.simulation.time() / cost.wall_s, 0), fixed(100.0 * cost.cpu_s / cost.wall_s, 0), fixed(cost.peak_mb, 0), share(phases.trace), share(phases.map),
                      share(phases.contact), fixed(static_cast<double>(run.simulation.map().memory_bytes()) / 1024.0, 0)});
    }
  return "The same flights at 10 scans a second and lobe, mapped in cells of 0.05 m, with the 900 rays a lobe that the source ran and the 3364 that crashed its simulator. Its tables give speed, CPU of Gazebo and of the other nodes, "
         "and 0.43 % of a memory that it does not name.\n\n" +
         measured(table({"flight", "rays a lobe", "source (900): × real time; CPU", "ours, × real time", "CPU, %", "peak memory, MB", "tracing and receiver, %", "map, %", "contact, %", "map, KiB"}, rows, 1)) +
         "**What differs.** No flight has to be slowed down. The rest of the time goes into the vehicle, the planner and keeping the way.\n\n";
}

}  // namespace

std::vector<Experiment> cost_experiments2018() {
  return {{"billdal2018/cost", "Speed, CPU and memory", "Billdal 2018, tables 6.1 to 6.4",
           "On eight threads of an i7-4790 with 900 rays a lobe: test room 1.0 of real time, cluttered room 0.5 and cargo hold 0.4, slowed down because mapping did not keep up. 3364 rays crashed the simulator.", costs}};
}

}  // namespace thicket

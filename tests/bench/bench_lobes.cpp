// Lobes of 58 x 58 rays: against the rays alone, the receiver's part, two threads, four of them on a vehicle.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "bare_loops.hpp"

namespace thicket::bench {
namespace {

const Pose sensor_pose = Pose::planar(0.0, 0.0, sensor_height, 0.0);

/// A bare lobe: its rays and their echoes, by the default physics.
LobeRadarSpec lobe() {
  LobeRadarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.range_max_m = 30.0;
  return spec;
}

LobeRadarSpec x4m05() {
  Faults faults;
  const auto entry = or_exit(parse_document("preset = 'x4m05'\nposition_m = [0, 0, 0]", "bench"));
  return std::get<LobeRadarSpec>(read_sensor(entry, faults));
}

void lobe_scans(benchmark::State& state, const Scene& scene, const SensorSpec& spec, std::size_t threads) { scans(state, scene, spec, sensor_pose, threads, "ray", 58.0 * 58.0); }

/// Four lobes at 0, 90, 180 and 270 degrees, each 10 times a second, as a simulation measures them.
void four_lobes(benchmark::State& state, const World& world, LobeRadarSpec spec) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 2);
  Mission mission;
  mission.vehicle.radius_m = 0.1;
  mission.planner.name = "waypoints";
  mission.planner.waypoints_m = {{0.0, 0.0}};
  mission.start.z_m = 0.0;
  mission.map.enabled = false;
  mission.step_s = 0.1;
  spec.rate_hz = 10.0;
  spec.position_m = {0.0, 0.0, sensor_height};
  for (const double yaw : {0.0, 90.0, 180.0, 270.0}) {
    spec.name = "lobe " + std::to_string(yaw);
    spec.yaw_deg = yaw;
    mission.sensors.push_back(spec);
  }
  const Simulation start = or_exit(Simulation::create(mission, world));
  std::vector<std::shared_ptr<const Sensor>> sensors = start.stage().sensors;
  std::vector<Scan> scans(4);
  double simulated = 0.0;
  std::uint64_t number = 0;
  for (auto _ : state) {
    tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
      sensors[i]->measure(start.stage().scene, Pose{}, simulated, number, Random(1, static_cast<std::uint16_t>(i)), scans[i]);
    });
    ++number;
    simulated += 0.1;
  }
  state.counters["s simulated per s"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
}

}  // namespace

void register_lobes() {
  const std::vector<Ray> rays = fan();
  const World boxes = box_room(), bushes = thicket_room();
  const Scene box_scene = or_exit(Scene::build(boxes)), bush_scene = or_exit(Scene::build(bushes));
  const LobeRadarSpec plain = lobe();
  LobeRadarSpec everything = plain;
  everything.penetration_budget_db = infinity;
  everything.detection_floor_db = -300.0;

  measure("lobe/200 boxes, first surface/Embree triangles", [=](benchmark::State& s) { closest_bare(s, boxes, false, rays); });
  measure("lobe/200 boxes, first surface/lobe", [=](benchmark::State& s) { lobe_scans(s, box_scene, plain, 1); });
  measure("lobe/80 bushes, all surfaces/Embree triangles", [=](benchmark::State& s) { surfaces_bare(s, bushes, false, rays); });
  measure("lobe/80 bushes, all surfaces/lobe without a budget", [=](benchmark::State& s) { lobe_scans(s, bush_scene, everything, 1); });
  measure("lobe/80 bushes, all surfaces/lobe", [=](benchmark::State& s) { lobe_scans(s, bush_scene, plain, 1); });

  LobeRadarSpec x4 = x4m05(), traced = x4;
  traced.echoes = "traced";
  LobeRadarSpec bounces = x4;
  bounces.bounces_max = 3;
  for (const auto& [name, scene] : {std::pair("200 boxes", box_scene), {"80 bushes", bush_scene}}) {
    const std::string what = std::string("lobe/x4m05 among ") + name;
    measure(what + "/rays alone", [=, s = scene](benchmark::State& state) { lobe_scans(state, s, traced, 1); });
    measure(what + "/with its receiver", [=, s = scene](benchmark::State& state) { lobe_scans(state, s, x4, 1); });
    measure(what + "/and three bounces", [=, s = scene](benchmark::State& state) { lobe_scans(state, s, bounces, 1); });
    for (const std::size_t threads : {1, 2})
      measure(what + ", wall time/" + std::to_string(threads) + (threads == 1 ? " thread" : " threads"), [=, s = scene](benchmark::State& state) { lobe_scans(state, s, x4, threads); })->UseRealTime();
  }
  // A pure extrusion: the boxes are opaque and far taller than the lobe sees, and there is no floor.
  World tall = boxes;
  std::erase_if(tall.solids, [](const Solid& solid) { return !std::holds_alternative<Box>(solid.shape); });
  for (Solid& solid : tall.solids) std::get<Box>(solid.shape).size.z = 1000.0;
  const Scene tall_scene = or_exit(Scene::build(tall));
  LobeRadarSpec all_rows = x4, one_row = x4;
  all_rows.rows = "all";
  one_row.rows = "one";
  measure("lobe/x4m05 in a pure extrusion/every row", [=](benchmark::State& s) { lobe_scans(s, tall_scene, all_rows, 1); });
  measure("lobe/x4m05 in a pure extrusion/one row", [=](benchmark::State& s) { lobe_scans(s, tall_scene, one_row, 1); });

  measure("lobe/four x4m05 at 10 Hz/200 boxes", [=](benchmark::State& s) { four_lobes(s, boxes, x4); })->UseRealTime();
  measure("lobe/four x4m05 at 10 Hz/80 bushes", [=](benchmark::State& s) { four_lobes(s, bushes, x4); })->UseRealTime();
  measure("lobe/four x4m05 at 10 Hz/25 trees, 100000 leaves", [=](benchmark::State& s) { four_lobes(s, leafy_thicket(25, 8.0), x4); })->UseRealTime();
}

}  // namespace thicket::bench

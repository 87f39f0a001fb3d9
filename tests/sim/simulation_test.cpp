#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <string>

#include "finished.hpp"
#include "outside_data.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/check.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

Mission shipped(const char* name, const std::vector<Override>& overrides = {}) {
  auto mission = read_mission(find_input(name), overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

std::string verdict(const Simulation& simulation) { return to_string(simulation.verdict()->kind); }

bool warned_of(const Simulation& simulation, const std::string& words) {
  for (const std::string& warning : mission_warnings(simulation))
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

World world_with(const Material& material, Shape shape, const glm::dvec3& position) {
  World world;
  world.materials.push_back(material);
  world.solids.push_back({"thing", 0, position, 0.0, std::move(shape)});
  return world;
}

Mission straight_to(double x) {
  Mission mission;
  mission.planner.name = "waypoints";
  mission.planner.waypoints_m = {{x, 0.0}};
  mission.planner.clearance_m = 0.3;
  mission.sensors = {ScanningRadarSpec{}};
  mission.map.enabled = false;
  return mission;
}

}  // namespace

TEST_CASE("shipped missions end as they say, without collision") {
  for (const auto& [name, expected] : {std::pair{"foliage_wall/bug1", "reached"}, {"foliage_wall/bug2", "reached"}, {"foliage_wall/closed", "unreachable"},
                                       {"foliage_wall/smoke", "reached"}, {"rooms/convex", "reached"}, {"rooms/u", "reached"}, {"rooms/spiral", "reached"},
                                       {"thicket/way_round", "reached"}}) {
    CAPTURE(name);
    const Simulation simulation = finished(shipped(name));
    CHECK(verdict(simulation) == expected);
    // Leaves are no surface: the matter near the robot is averaged over a few centimetres, and single leaves reach out of that.
    const double share = std::string(name) == "thicket/way_round" ? 0.7 : 0.85;
    CHECK(simulation.totals().least_clearance > share * simulation.mission().planner.clearance_m);
    CHECK(mission_warnings(simulation).empty());
  }
}

TEST_CASE("closed: the verdict comes from a completed loop, far from every limit") {
  const Simulation simulation = finished(shipped("foliage_wall/closed"));
  CHECK(simulation.verdict()->reason.find("the hit point was met again") != std::string::npos);
  CHECK(simulation.time() < 0.1 * simulation.mission().limits.time_s);
}

TEST_CASE("smoke: the straight way is taken, and no bumper feels the smoke") {
  auto simulation = Simulation::create(shipped("foliage_wall/smoke"));
  REQUIRE(simulation);
  bool stood_in_smoke = false;
  while (simulation->step()) {
    const glm::dvec2 p = simulation->vehicle().pose.position;
    stood_in_smoke |= in_matter(simulation->stage().scene.world(), {p, 0.2});
  }
  CHECK(stood_in_smoke);
  CHECK(simulation->totals().path_length < 1.01 * 16.0);
  CHECK(simulation->marks().size() == 1);  // the M-line; no hit point
}

TEST_CASE("through foliage the radar maps at least 60 % of the hidden room, a lidar at most 2 %, cores of the foliage stay unknown") {
  const Simulation radar = finished(shipped("foliage_wall/map_radar")), lidar = finished(shipped("foliage_wall/map_lidar"));
  CHECK(verdict(radar) == "reached");
  CHECK(verdict(lidar) == "reached");
  const auto region = *radar.mission().output.observed_region_m;
  const auto by_radar = observed_share(radar, region), by_lidar = observed_share(lidar, region);
  REQUIRE(by_radar);
  REQUIRE(by_lidar);
  MESSAGE("observed share of the hidden room: radar ", *by_radar, ", lidar ", *by_lidar);
  CHECK(*by_radar >= 0.60);
  CHECK(*by_lidar <= 0.02);
  int cores = 0;
  for (const Solid& solid : radar.stage().scene.world().solids) {
    if (!std::holds_alternative<Sphere>(solid.shape) || std::abs(solid.position.y) > 6.5) continue;  // of those at the side walls half is not in the room
    ++cores;
    for (const double dx : {-0.1, 0.0, 0.1})
      for (const double dy : {-0.1, 0.0, 0.1}) CHECK_FALSE(radar.map().view(radar.map().cell_at(glm::dvec2(solid.position) + glm::dvec2(dx, dy))).known);
  }
  CHECK(cores == 5);
}

TEST_CASE("through a thicket of leaves the radar maps at least 80 % of what is behind it, a lidar at most 20 %") {
  const Simulation radar = finished(shipped("thicket/look_through")), lidar = finished(shipped("thicket/look_through_lidar"));
  CHECK(verdict(radar) == "reached");
  CHECK(verdict(lidar) == "reached");
  CHECK(mission_warnings(radar).empty());
  const auto region = *radar.mission().output.observed_region_m;
  const auto by_radar = observed_share(radar, region), by_lidar = observed_share(lidar, region);
  REQUIRE(by_radar);
  REQUIRE(by_lidar);
  MESSAGE("observed share behind the thicket: radar ", *by_radar, ", lidar ", *by_lidar);
  CHECK(*by_radar >= 0.80);
  CHECK(*by_lidar <= 0.20);
}

TEST_CASE("somebody who walks slowly across the way is gone around, without collision") {
  const Simulation simulation = finished(shipped("moving/crossing"));
  CHECK(verdict(simulation) == "reached");
  CHECK(mission_warnings(simulation).empty());
  CHECK(simulation.totals().least_clearance > 0.25);
  CHECK(simulation.totals().path_length > 10.2);  // not straight: 9.9 m
}

TEST_CASE("with the first echo only the room behind the foliage stays hidden") {
  const Simulation simulation = finished(shipped("foliage_wall/map_radar", {{"sensor.first_echo_only", "true", "--set"}}));
  CHECK(*observed_share(simulation, *simulation.mission().output.observed_region_m) <= 0.02);
}

TEST_CASE("the same mission gives the same bytes with one thread and with two, and with another seed other ones") {
  const std::vector<Override> noisy = {{"sensor.range_noise_m", "0.03", "--set"}, {"sensor.divergence", "side_rays", "--set"}, {"sensor.step_deg", "0.2", "--set"}};
  const auto bytes = [](const Mission& mission, std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    auto simulation = Simulation::create(mission);
    REQUIRE(simulation);
    Trajectory trajectory;
    run(*simulation, trajectory, {});
    std::string all = result_json(*simulation) + trajectory.csv();
    const GridMap grid = simulation->map().to_grid();
    for (const CellState cell : grid.cells) all += static_cast<char>('0' + static_cast<int>(cell));
    return all;
  };
  const Mission mission = shipped("foliage_wall/bug2", noisy);
  const std::string one = bytes(mission, 1), two = bytes(mission, 2);
  CHECK(one == two);
  Mission other = mission;
  other.seed = 2;
  CHECK(bytes(other, 2) != one);
}

TEST_CASE("a copy of a simulation goes on like the original, and neither knows of the other") {
  auto original = Simulation::create(shipped("foliage_wall/bug2", {{"sensor.range_noise_m", "0.02", "--set"}}));
  REQUIRE(original);
  for (int i = 0; i < 300; ++i) original->step();
  Simulation copy = *original;
  const std::string at_copy = result_json(copy);
  while (original->step()) {
  }
  CHECK(result_json(copy) == at_copy);
  while (copy.step()) {
  }
  CHECK(result_json(copy) == result_json(*original));
}

TEST_CASE("a collision is a verdict: what the sensor cannot see is run into, not through") {
  Material stealth;
  stealth.name = "stealth";
  stealth.reflectivity = 0.0;
  // A millimetre of it, met at full speed with the longest step.
  Mission mission = straight_to(10.0);
  mission.step_s = 0.2;
  mission.vehicle.speed_max_m_s = 20.0;
  mission.vehicle.acceleration_m_s2 = 1000.0;
  mission.vehicle.deceleration_m_s2 = 1000.0;
  auto simulation = Simulation::create(mission, world_with(stealth, Box{{0.001, 4.0, 2.0}}, {5.0, 0.0, 1.0}));
  REQUIRE(simulation);
  CHECK(warned_of(*simulation, "would not be detected"));
  CHECK(warned_of(*simulation, "between two scans"));  // 20 m/s
  while (simulation->step()) {
  }
  CHECK(verdict(*simulation) == "collided");
  CHECK(simulation->verdict()->reason.find("'thing'") != std::string::npos);
  CHECK(simulation->vehicle().pose.position.x == doctest::Approx(5.0 - 0.0005 - mission.vehicle.radius_m).epsilon(1e-5));
}

TEST_CASE("matter above or below the sensor's plane is warned of") {
  Material wall;
  wall.name = "wall";
  Mission mission = straight_to(2.0);
  auto low = Simulation::create(mission, world_with(wall, Box{{1.0, 1.0, 0.2}}, {5.0, 0.0, 0.1}));
  REQUIRE(low);
  REQUIRE(mission_warnings(*low).size() == 1);
  CHECK(mission_warnings(*low)[0].find("plane of sensor") != std::string::npos);
  auto tall = Simulation::create(mission, world_with(wall, Box{{1.0, 1.0, 2.0}}, {5.0, 0.0, 1.0}));
  CHECK(mission_warnings(*tall).empty());
}

TEST_CASE("what a sensor cannot see in time is warned of") {
  Material wall;
  wall.name = "wall";
  const auto simulation_of = [&](const std::vector<Override>& overrides, double post_radius) {
    auto simulation = Simulation::create(shipped("foliage_wall/smoke", overrides), world_with(wall, Cylinder{post_radius, 2.0}, {5.0, 3.0, 1.0}));
    REQUIRE(simulation);
    return *simulation;
  };
  CHECK(mission_warnings(simulation_of({}, 0.1)).empty());
  CHECK(warned_of(simulation_of({}, 0.005), "'thing'): narrower than"));
  CHECK(warned_of(simulation_of({{"sensor.range_max_m", "1.0", "--set"}}, 0.1), "make range_max_m longer"));
  CHECK(warned_of(simulation_of({{"sensor.range_min_m", "1.0", "--set"}}, 0.1), "make range_min_m shorter"));
  CHECK(warned_of(simulation_of({{"sensor.fov_deg", "90.0", "--set"}}, 0.1), "sees 90 of 360 degrees"));
  CHECK(warned_of(simulation_of({{"sensor.radar.rate_hz", "40.0", "--set"}}, 0.1), "make step_s smaller"));
  CHECK(warned_of(simulation_of({{"sensor.rate_hz", "0.5", "--set"}}, 0.1), "between two scans"));
}

TEST_CASE("a start in contact is a collision at once, a way-point behind a wall ends with what blocks it, limits have their own verdict") {
  Material wall;
  wall.name = "wall";
  auto touching = Simulation::create(straight_to(2.0), world_with(wall, Box{{1.0, 1.0, 2.0}}, {0.5, 0.0, 1.0}));
  REQUIRE(touching);
  CHECK_FALSE(touching->step());
  CHECK(verdict(*touching) == "collided");

  auto blocked = Simulation::create(straight_to(8.0), world_with(wall, Box{{0.2, 4.0, 2.0}}, {5.0, 0.0, 1.0}));
  REQUIRE(blocked);
  while (blocked->step()) {
  }
  CHECK(verdict(*blocked) == "stopped");
  CHECK(blocked->verdict()->reason.find("way-point 1 of 1 is blocked") != std::string::npos);
  CHECK(blocked->totals().least_clearance > 0.25);

  Mission timed = straight_to(100.0);
  timed.limits.time_s = 3.0;
  auto late = Simulation::create(timed, World{});
  REQUIRE(late);
  while (late->step()) {
  }
  CHECK(verdict(*late) == "stopped");
  CHECK(late->time() == doctest::Approx(3.0));
  CHECK(late->verdict()->reason == "time limit of 3 s");
}

TEST_CASE("a real map: the depot, with a small robot") {
  const auto yaml = outside_data("ros_maps/nav2_depot.yaml");
  if (!yaml) {
    MESSAGE("skipped: no outside data");
    return;
  }
  std::filesystem::path image = *yaml;
  image.replace_extension(".pgm");
  const auto run_to = [&](const char* goal, const char* planner) {
    const auto mission = read_mission({}, {{"world", toml_string(yaml->string()), "--world"}, {"world_image", toml_string(image.string()), "--map-image"},
                                           {"start.x_m", "-5.0", "--start"}, {"planner.goal_m", goal, "--goal"}, {"planner.name", toml_string(planner), "--planner"},
                                           {"vehicle.preset", "small", "--set"}, {"planner.clearance_m", "0.1", "--set"}});
    if (!mission) FAIL(mission.error().message);
    return finished(*mission);
  };
  for (const char* planner : {"bug1", "bug2"}) {
    CAPTURE(planner);
    CHECK(verdict(run_to("[20.0, -6.0]", planner)) == "reached");
    CHECK(verdict(run_to("[15.0, 5.0]", planner)) == "reached");
    // In the middle of a stack of pallets: matter all around it.
    const Simulation enclosed = run_to("[10.9, -2.4]", planner);
    CHECK(verdict(enclosed) == "unreachable");
    CHECK(enclosed.totals().least_clearance > 0.05);
  }
}

}  // namespace thicket

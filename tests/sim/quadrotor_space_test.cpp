// The quadrotor in a world: at which heights it is looked at, floor and ceiling, what tilted sensors tell, odometry, and changes in mid-air.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "flights.hpp"
#include "temporary_folder.hpp"
#include "thicket/sim/auto_clearance.hpp"
#include "thicket/sim/check.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/travel.hpp"

namespace thicket {
namespace {

/// From the floor to an altitude of 1 m, then by Bug2 over 8 m.
Mission from_the_floor() {
  Mission mission = flight({-4.0, 0.0, 0.0});
  mission.planner.name = "bug2";
  mission.planner.waypoints_m.clear();
  mission.planner.altitude_m = 1.0;
  mission.planner.goal_m = glm::dvec2(4.0, 0.0);
  mission.planner.clearance_m = 0.3;
  LidarSpec around;
  around.range_max_m = 8.0;
  around.rate_hz = 10.0;
  around.position_m = {0.0, 0.0, 0.1};
  mission.sensors = {around};
  return mission;
}

/// A wall across the way, 12 m long, from one height to another.
World barred(double low, double high) { return world_of(Box{{0.2, 12.0, high - low}}, {0.0, 0.0, 0.5 * (low + high)}); }

Simulation created(const Mission& mission, World world) {
  auto simulation = Simulation::create(mission, std::move(world));
  if (!simulation) FAIL(simulation.error().message);
  return *simulation;
}

bool warned_of(const Simulation& simulation, const std::string& words) {
  for (const std::string& warning : mission_warnings(simulation))
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("what flies is looked at where it flies: the heights of a mission") {
  CHECK(travel_heights(shipped("quadrotor/waypoints")) == std::vector<double>{3.0, 1.0, 1.5});
  CHECK(travel_range(shipped("quadrotor/waypoints")) == std::pair{1.0, 3.0});
  CHECK(travel_heights(shipped("quadrotor/bug2")) == std::vector<double>{1.0});
  CHECK(travel_heights(shipped("quadrotor/hover")) == std::vector<double>{1.5});
  CHECK(ground_height(shipped("quadrotor/hover")) == 0.0);
  Mission drives = shipped("foliage_wall/bug2");
  drives.start.z_m = 0.7;
  CHECK(travel_heights(drives) == std::vector<double>{0.7});
  CHECK(ground_height(drives) == 0.7);
}

TEST_CASE("warnings, clearance, truth and score of a flight from the floor are those of its altitude") {
  Mission mission = from_the_floor();
  // A low wall is flown over, one that hangs at 1 m is not.
  const World low = barred(0.0, 0.6), hanging = barred(0.9, 1.4);
  mission.planner.goal_m = glm::dvec2(0.0, 0.0);
  CHECK_FALSE(warned_of(created(mission, low), "cannot be reached"));
  CHECK(warned_of(created(mission, hanging), "cannot be reached"));
  mission.planner.goal_m = glm::dvec2(4.0, 0.0);
  // The widest clearance that leaves a way: around the ends of the hanging wall there is one, but a low one is not there at all.
  const World pen_low = world_of(Wall{{{2.0, -2.0}, {6.0, -2.0}, {6.0, 2.0}, {2.0, 2.0}, {2.0, -2.0}}, 0.2, 0.6}, {0.0, 0.0, 0.0});
  World pen_high = pen_low;
  std::get<Wall>(pen_high.solids[0].shape).height = 1.6;
  CHECK(auto_clearance(mission, pen_low) > 1.6);
  CHECK(auto_clearance(mission, pen_high) < 1.6);
  // The truth that a map is judged by.
  mission.map.enabled = true;
  mission.limits.time_s = 3.0;
  Simulation over = created(mission, low), before = created(mission, hanging);
  for (Simulation* simulation : {&over, &before})
    while (simulation->step()) {
    }
  const auto blocked = [](const Simulation& simulation) {
    const auto truth = map_truth(simulation, simulation.map().to_probabilities(), Convention::cell_centre);
    REQUIRE(truth);
    return std::ranges::count(truth->solid.blocked, 1);
  };
  CHECK(blocked(over) == 0);
  CHECK(blocked(before) > 100);
  const auto score = score_run(before, Convention::cell_centre, 0.2);
  REQUIRE(score);
  CHECK(score->height_low_m == doctest::Approx(1.1));
  CHECK(score->height_high_m == doctest::Approx(1.1));
  // Free cells of a region that is half under the wall: all count over a low one.
  CHECK(observed_share(over, {-3.0, -0.5, 0.1, 0.5}).value() == doctest::Approx(1.0).epsilon(0.05));
}

TEST_CASE("way-points are judged at their own altitudes, and legs at all altitudes between their ends") {
  Mission mission = from_the_floor();
  mission.planner.name = "waypoints";
  mission.planner.altitude_m = 2.0;
  mission.planner.waypoints_m = {{0.0, 0.0, 2.0}, {4.0, 0.0, 2.0}};
  const World box = world_of(Box{{1.0, 1.0, 1.5}}, {0.0, 0.0, 0.75});
  CHECK_FALSE(warned_of(created(mission, box), "cannot be reached"));
  const double over = auto_clearance(mission, box);
  mission.planner.waypoints_m = {{0.0, 0.0, 1.0}, {4.0, 0.0, 2.0}};
  CHECK(warned_of(created(mission, box), "way-point 1 is where the hull would touch"));
  // From 2 m down to 1 m behind the box: the straight line is not judged, but whether there is a way in the plane that is free from 1 m to 2 m.
  mission.planner.waypoints_m = {{1.5, 0.0, 1.0}};
  const double down = auto_clearance(mission, box);
  CHECK(over > 1.1);
  CHECK(down < 0.7);
  CHECK(down > 0.4);
}

TEST_CASE("a ceiling of the world is a collision from below, just under it is none") {
  const TemporaryFolder folder;
  const auto file = folder.write("hall.toml", R"(name = "hall"
bounds_m = [-5.0, -5.0, 5.0, 5.0]
[material.wall]
reflectivity = 0.5
[floor]
material = "wall"
[ceiling]
material = "wall"
z_m = 3.0
)");
  const auto world = read_world(file);
  if (!world) FAIL(world.error().message);
  for (const char* model : {"kinematic", "rigid_body"}) {
    CAPTURE(model);
    Mission mission = flight({0.0, 0.0, 1.0});
    mission.vehicle.model = model;
    const Simulation hit = driven(mission, *world, climbing(2.0), 5.0);
    CHECK(verdict(hit) == "collided");
    CHECK(hit.verdict()->reason.find("ceiling") != std::string::npos);
    CHECK(hit.vehicle().z + mission.vehicle.height_m <= 3.0);
    CHECK(hit.vehicle().z + mission.vehicle.height_m > 3.0 - 0.012);
    mission.planner.waypoints_m = {{0.0, 0.0, 2.75}, {2.0, 0.0, 2.75}};
    CHECK(verdict(flown(mission, *world)) == "reached");
  }
}

TEST_CASE("a tilted flight low over a floor does not stop for it, and stops for a wall at its distance") {
  const World floor = world_of(Box{{60.0, 60.0, 0.1}}, {0.0, 0.0, -0.05});
  Mission mission = from_the_floor();
  mission.start.z_m = 0.1;
  mission.planner.altitude_m = 0.1;
  mission.planner.name = "waypoints";
  mission.planner.waypoints_m = {{4.0, 0.0}};
  mission.planner.clearance_m = 0.5;
  mission.planner.speed_m_s = 1.0;
  // At 13.5 degrees of tilt, getting up speed, the beams ahead meet the floor 0.83 m before the axis: nearer than the 0.9 m that are kept.
  auto simulation = created(mission, floor);
  double nearest_floor = INFINITY, least_bumper = INFINITY;
  do {
    for (const Scan& scan : simulation.scans())
      for (const Beam& beam : scan.beams)
        if (beam.echo_count > 0) nearest_floor = std::min(nearest_floor, scan.echoes[beam.first_echo].range);
    least_bumper = std::min(least_bumper, simulation.bumpers().nearest());
  } while (simulation.step());
  CAPTURE(simulation.verdict()->reason);
  CHECK(verdict(simulation) == "reached");
  CHECK(nearest_floor < 0.9);
  CHECK(least_bumper == INFINITY);
  World with_wall = floor;
  with_wall.solids.push_back({"bar", 0, {1.0, 0.0, 1.0}, 0.0, Box{{0.2, 12.0, 2.0}}});
  const Simulation stopped = flown(mission, with_wall);
  CHECK(verdict(stopped) == "stopped");
  CHECK(stopped.verdict()->reason.find("blocked") != std::string::npos);
  CHECK(stopped.totals().least_clearance > 0.3);
}

TEST_CASE("a map that is made under tilt has the wall where it is") {
  Mission mission = flight({0.0, 0.0, 2.0});
  mission.map.enabled = true;
  mission.map.resolution_m = 0.05;
  LidarSpec around;
  around.range_max_m = 8.0;
  around.rate_hz = 50.0;
  mission.sensors = {around};
  World world = world_of(Box{{0.5, 12.0, 8.0}}, {5.25, 0.0, 4.0});
  auto simulation = created(mission, std::move(world));
  Command command{3.0, 0.0};
  command.altitude = 2.0;
  simulation.drive(command);
  double tilt = 0.0;
  while (simulation.time() < 0.3 && simulation.step()) tilt = std::max(tilt, roll_pitch_yaw(simulation.platform().pose.orientation).y);
  CHECK(degrees(tilt) > 25.0);  // 5 m / cos(tilt) along the beam: a map that took that for level would have the wall half a metre farther
  const ProbabilityGrid grid = simulation.map().to_probabilities();
  double nearest = INFINITY, farthest = 0.0;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const double x = grid.origin.x + (column + 0.5) * grid.resolution;
      if (grid.known(grid.index(column, row)) && grid.probability[grid.index(column, row)] > 0.65f) nearest = std::min(nearest, x), farthest = std::max(farthest, x);
    }
  CHECK(nearest > 5.0 - 0.08);
  CHECK(farthest < 5.0 + 0.08);
}

TEST_CASE("odometry of a flight sideways: its scale is on the way sideways too, and its noise is as on the way ahead") {
  Mission mission = flight({0.0, -3.0, 1.0});
  mission.planner.heading_deg = 0.0;
  mission.planner.waypoints_m = {{0.0, 30.0, 1.0}};
  mission.odometry.speed_scale = 1.1;
  mission.limits.time_s = 5.0;
  const Simulation scaled = flown(mission, World{});
  const double way = scaled.vehicle().pose.position.y + 3.0;
  CHECK(way > 3.0);
  CHECK(scaled.estimate().position.y + 3.0 == doctest::Approx(1.1 * way).epsilon(1e-9));
  CHECK(std::abs(scaled.estimate().position.x) < 1e-9);
  OdometrySpec spec;
  spec.speed_noise_m_s = 0.2;
  spec.turn_noise_rad_s = 0.0;
  double ahead = 0.0, aside = 0.0;
  constexpr int runs = 2000, steps = 40;
  for (int run = 0; run < runs; ++run) {
    Odometry odometry(spec, {}, static_cast<std::uint64_t>(run));
    for (int i = 0; i < steps; ++i) odometry.advance({{0.0, 0.05 * i}, 0.0}, {{0.0, 0.05 * (i + 1)}, 0.0}, 0.1, static_cast<std::uint64_t>(i));
    const glm::dvec2 off = odometry.pose().position - glm::dvec2(0.0, 0.05 * steps);
    ahead += off.x * off.x;
    aside += off.y * off.y;
  }
  const double expected = 0.2 * std::sqrt(0.1 * 0.1 * steps);
  CHECK(std::sqrt(ahead / runs) == doctest::Approx(expected).epsilon(0.07));
  CHECK(std::sqrt(aside / runs) == doctest::Approx(expected).epsilon(0.07));
}

TEST_CASE("a mission that is changed in mid-air goes on with the same state in space") {
  Mission mission = flight({0.0, 0.0, 1.0});
  mission.vehicle.model = "rigid_body";
  mission.vehicle.gust_m_s = 0.3;
  mission.planner.waypoints_m = {{6.0, 0.0, 2.0}};
  auto simulation = created(mission, World{});
  for (int i = 0; i < 150; ++i) simulation.step();
  const Vehicle before = simulation.vehicle();
  CHECK(glm::length(before.velocity) > 0.3);
  CHECK(std::abs(before.attitude.y) > 1e-4);
  Mission other = mission;
  other.limits.time_s = 100.0;
  auto next = simulation.changed(other);
  REQUIRE(next);
  const auto same = [](const Vehicle& a, const Vehicle& b) {
    return a.pose.position == b.pose.position && a.pose.yaw == b.pose.yaw && a.z == b.z && a.velocity == b.velocity && a.attitude == b.attitude && a.rates == b.rates && a.unrest.gust == b.unrest.gust && a.on_floor == b.on_floor;
  };
  CHECK(same(next->vehicle(), before));
  for (int i = 0; i < 150; ++i) {
    simulation.step();
    next->step();
  }
  CHECK(same(next->vehicle(), simulation.vehicle()));
  // Put somewhere else it is at rest there, level, at its altitude; it flies on from there.
  auto put = simulation.changed(mission, Pose2{{-2.0, 1.0}, 0.5});
  REQUIRE(put);
  CHECK(put->vehicle().z == simulation.vehicle().z);
  CHECK(put->vehicle().velocity == glm::dvec3(0.0));
  CHECK(roll_pitch_yaw(put->vehicle().attitude).z == doctest::Approx(0.5));
  for (int i = 0; i < 50; ++i) put->step();
  CHECK_FALSE(put->verdict());
  // Another vehicle stands on the ground of the start.
  Mission drives = mission;
  drives.vehicle = VehicleSpec{};
  drives.start.z_m = 0.0;
  drives.planner.waypoints_m = {glm::dvec2(6.0, 0.0)};
  const auto grounded = simulation.changed(drives);
  if (!grounded) FAIL(grounded.error().message);
  CHECK(grounded->vehicle().z == 0.0);
  CHECK(grounded->vehicle().velocity == glm::dvec3(0.0));
}

}  // namespace thicket

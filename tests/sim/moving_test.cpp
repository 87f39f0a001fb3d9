// Solids that move, as a run meets them: contact, scans, copies, determinism.
#include <doctest/doctest.h>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/sim/run.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

World world_with_mover(Shape shape, const Motion& motion, double reflectivity = 0.5) {
  World world;
  world.materials.emplace_back().name = "wall";
  world.materials.emplace_back().name = "moving";
  world.materials[1].reflectivity = reflectivity;
  world.solids.push_back({"wall", 0, {0.0, 12.0, 1.0}, 0.0, Box{{40.0, 0.2, 2.0}}});
  Solid solid{"mover", 1, motion.points.front(), 0.0, std::move(shape)};
  solid.motion = std::make_shared<const Motion>(motion);
  world.solids.push_back(std::move(solid));
  return world;
}

/// A robot that stands at the origin, near enough, and looks.
Mission standing() {
  Mission mission;
  mission.planner.name = "waypoints";
  mission.planner.waypoints_m = {{0.0, -500.0}};
  mission.planner.speed_m_s = 1e-3;
  mission.planner.clearance_m = 0.05;
  mission.sensors = {ScanningRadarSpec{}};
  mission.map.enabled = false;
  mission.limits.time_s = 20.0;
  mission.limits.stuck_s = 1e6;
  return mission;
}

}  // namespace

TEST_CASE("a solid drives into a robot that stands: collided, at the time that geometry gives") {
  Motion motion;
  motion.points = {{10.0, 0.0, 0.5}, {-10.0, 0.0, 0.5}};
  for (const double speed : {0.5, 3.0, 300.0}) {  // the last passes the whole hull within a step
    motion.speed = speed;
    const Mission mission = standing();
    auto simulation = Simulation::create(mission, world_with_mover(Cylinder{0.4, 1.0}, motion, 0.0));  // not seen, so that nobody gives way
    REQUIRE(simulation);
    while (simulation->step()) {
    }
    CAPTURE(speed);
    REQUIRE(simulation->verdict()->kind == Verdict::Kind::collided);
    CHECK(simulation->verdict()->reason.find("'mover'") != std::string::npos);
    const double touching = (10.0 - 0.4 - mission.vehicle.radius_m) / speed;
    CHECK(simulation->time() >= touching - 1e-3);
    CHECK(simulation->time() <= touching + mission.step_s + 1e-3);
  }
}

TEST_CASE("scans see a moving solid where it is at their time") {
  Motion motion;
  motion.points = {{10.0, 0.0, 0.5}, {3.0, 0.0, 0.5}};
  motion.speed = 1.0;
  Mission mission = standing();
  mission.limits.time_s = 5.0;
  auto simulation = Simulation::create(mission, world_with_mover(Box{{1.0, 1.0, 1.0}}, motion));
  REQUIRE(simulation);
  std::size_t seen = 0;
  double last = -1.0;
  for (Pose before = simulation->vehicle_pose(); simulation->step(); before = simulation->vehicle_pose()) {
    const Scan& scan = simulation->scans()[0];
    if (scan.time == last) continue;
    last = scan.time;
    for (const Beam& beam : scan.beams) {
      const glm::dvec3 along = scan.mount_orientation * beam.direction;
      const glm::dvec3 world_along = before.orientation * along;
      if (world_along.x < std::cos(radians(1.5))) continue;  // it shows 1 m at up to 9.5 m
      REQUIRE(beam.echo_count > 0);
      CHECK(scan.echoes[beam.first_echo].range * world_along.x == doctest::Approx(10.0 - scan.time - 0.5).epsilon(2e-3));
      ++seen;
    }
  }
  CHECK(seen > 50);
}

TEST_CASE("a copy of a run goes its own way through time, and the same way again") {
  Motion motion;
  motion.points = {{6.0, 3.0, 0.5}, {6.0, -3.0, 0.5}};
  motion.speed = 1.5;
  motion.mode = Motion::Mode::back_and_forth;
  motion.spin = 0.5;
  Mission mission = standing();
  mission.planner.waypoints_m = {{4.0, 0.0}, {-4.0, 0.0}};
  mission.planner.speed_m_s.reset();
  mission.map.enabled = true;
  mission.limits.time_s = 60.0;
  auto first = Simulation::create(mission, world_with_mover(Box{{0.5, 1.5, 1.0}}, motion));
  REQUIRE(first);
  for (int i = 0; i < 100; ++i) first->step();
  Simulation copy = *first;
  const auto finish = [](Simulation& simulation) {
    std::vector<double> ranges;
    while (simulation.step())
      for (const Echo& echo : simulation.scans()[0].echoes) ranges.push_back(echo.range);
    return ranges;
  };
  const auto ahead = finish(*first);
  CHECK(copy.time() < first->time());
  CHECK(copy.scene().time() == copy.time());  // the other one has not taken the solids along
  const auto again = finish(copy);
  REQUIRE(ahead.size() > 10000);
  CHECK(ahead == again);
  CHECK(first->totals().least_clearance == copy.totals().least_clearance);
}

}  // namespace thicket

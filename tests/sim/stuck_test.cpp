// Robots that do not get anywhere, and those that only seem so.
#include <doctest/doctest.h>

#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

World room() {
  World w;
  Material wall;
  wall.name = "wall";
  w.materials.push_back(wall);
  w.solids.push_back({"far", 0, {20.0, 0.0, 0.5}, 0.0, Box{{1.0, 1.0, 1.0}}});
  return w;
}

Mission to(double x, double y) {
  Mission m;
  m.vehicle.radius_m = 0.2;
  m.planner.name = "waypoints";
  m.planner.waypoints_m = {{x, y}};
  m.planner.clearance_m = 0.3;
  m.sensors = {ScanningRadarSpec{}};
  m.map.enabled = false;
  m.limits.stuck_s = 2.0;
  m.limits.time_s = 400.0;
  return m;
}

Simulation ended(const Mission& m) {
  auto simulation = Simulation::create(m, room());
  if (!simulation) FAIL(simulation.error().message);
  while (simulation->step()) {
  }
  return std::move(*simulation);
}

}  // namespace

TEST_CASE("a robot that swings about a way-point which it cannot meet exactly is stopped after four times stuck_s") {
  Mission m = to(2.0, 0.3);
  m.planner.goal_tolerance_m = 1e-12;
  const Simulation simulation = ended(m);
  CHECK(simulation.verdict()->kind == Verdict::Kind::stopped);
  CHECK(simulation.verdict()->reason.find("stuck") == 0);
  CHECK(simulation.time() < 30.0);
}

TEST_CASE("a slow robot, and one that turns slowly, are not taken for stuck") {
  Mission slow = to(0.6, 0.0);
  slow.planner.speed_m_s = 0.03;
  CHECK(ended(slow).verdict()->kind == Verdict::Kind::reached);
  Mission turning = to(-1.0, 0.0);
  turning.vehicle.turn_rate_max_deg_s = 30.0;
  CHECK(ended(turning).verdict()->kind == Verdict::Kind::reached);
}

}  // namespace thicket

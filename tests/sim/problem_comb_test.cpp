// Combs: on one kind Bug1 is shorter than Bug2, on the other it is the opposite.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>

#include "thicket/sim/problem.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

/// How far a planner drives until it is at the goal.
double length_of(const Problem& problem, const Robot& robot, const char* planner, const char* hand) {
  Mission mission;
  mission.vehicle = robot.vehicle;
  mission.planner.name = planner;
  mission.planner.hand = hand;
  mission.planner.goal_m = problem.goal;
  mission.planner.clearance_m = robot.clearance_m;
  mission.start.x_m = problem.start.position.x;
  mission.start.y_m = problem.start.position.y;
  mission.start.yaw_deg = degrees(problem.start.yaw);
  ScanningRadarSpec radar;
  radar.position_m = {0.0, 0.0, 0.2};
  mission.sensors = {radar};
  mission.map.enabled = false;
  mission.limits.time_s = 3000.0;
  auto simulation = Simulation::create(mission, *problem.world);
  REQUIRE(simulation);
  while (simulation->step()) {
  }
  CAPTURE(simulation->verdict()->reason);
  CHECK(std::string(to_string(simulation->verdict()->kind)) == "reached");
  return simulation->totals().path_length;
}

}  // namespace

TEST_CASE("families of problems: in two combs that stand in each other Bug1 is shorter on a hand at least, at a free comb on none") {
  Robot robot;
  robot.vehicle.radius_m = 0.25;
  const char* wanted = std::getenv("THICKET_PROBLEMS");  // more than the standard number, for a study
  const std::uint64_t count = wanted ? static_cast<std::uint64_t>(std::atoi(wanted)) : 2;
  for (std::uint64_t number = 0; number < count; ++number) {
    if (number % 10 >= 8) continue;  // those are closed
    const auto problem = make_problem("comb", number, robot);
    REQUIRE(problem);
    CAPTURE(number);
    int bug1_shorter = 0;  // on how many hands
    for (const char* hand : {"left", "right"}) {
      const double bug1 = length_of(*problem, robot, "bug1", hand), bug2 = length_of(*problem, robot, "bug2", hand);
      if (wanted) MESSAGE(fmt::format("{} {}: bug1 {:.1f} m, bug2 {:.1f} m", number, hand, bug1, bug2));
      bug1_shorter += bug1 < bug2;
    }
    if (number % 2 == 0) CHECK(bug1_shorter >= 1);
    else CHECK(bug1_shorter == 0);
  }
}

}  // namespace thicket

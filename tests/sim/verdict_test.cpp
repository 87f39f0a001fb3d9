// Verdicts against an oracle: the planner's verdict must be that of a flood fill of the grown free space, which shares no code with it.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <random>

#include <glm/geometric.hpp>

#include "thicket/sim/simulation.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

constexpr double arena = 12.0, clearance = 0.4, cell = 0.05;

struct Problem {
  World world;
  glm::dvec2 start{0.0}, goal{0.0};
  bool reachable = false;
};

Solid solid(const char* name, const glm::dvec3& position, double yaw, Shape shape) { return {name, 0, position, yaw, std::move(shape)}; }

World walled_arena() {
  World world;
  Material wall;
  wall.name = "wall";
  world.materials.push_back(wall);
  const double h = arena / 2;
  world.solids.push_back(solid("arena", {0.0, 0.0, 0.0}, 0.0, Wall{{{-h, -h}, {h, -h}, {h, h}, {-h, h}, {-h, -h}}, 0.2, 2.0}));
  return world;
}

bool joined(const World& world, const VehicleSpec& vehicle, const glm::dvec2& from, const glm::dvec2& to, double grow) {
  const glm::dvec2 corner(arena / 2);
  return connected(*grown_obstacles(world, -corner, corner, cell, grow, 0.0, vehicle.height_m), from, to);
}

/// Boxes, cylinders, and now and then an U of walls around the goal. Nothing if the problem is ambiguous: its verdict changes within +-(0.1 clearance + a cell).
std::optional<Problem> make_problem(unsigned seed, const VehicleSpec& vehicle) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  Problem problem;
  problem.world = walled_arena();
  const double h = arena / 2 - 1.2;
  problem.start = {uniform(-h, -h + 2.0), uniform(-h, h)};
  problem.goal = {uniform(h - 2.5, h), uniform(-h, h)};
  const int boxes = static_cast<int>(uniform(3.0, 10.0));
  for (int i = 0; i < boxes; ++i)
    problem.world.solids.push_back(solid("box", {uniform(-4.0, 4.0), uniform(-5.0, 5.0), 0.5}, uniform(0.0, 3.0), Box{{uniform(0.3, 3.0), uniform(0.1, 1.0), 1.0}}));
  for (int i = 0; i < 3; ++i) problem.world.solids.push_back(solid("post", {uniform(-4.0, 4.0), uniform(-5.0, 5.0), 0.5}, 0.0, Cylinder{uniform(0.1, 0.8), 1.0}));
  if (seed % 4 == 0) {  // the goal in a pen, closed or open on one side
    const glm::dvec2 g = problem.goal;
    const double r = 1.1;
    std::vector<glm::dvec2> pen = {g + glm::dvec2(-r, -r), g + glm::dvec2(r, -r), g + glm::dvec2(r, r), g + glm::dvec2(-r, r)};
    if (seed % 8 == 0) pen.push_back(pen.front());
    problem.world.solids.push_back(solid("pen", {0.0, 0.0, 0.0}, 0.0, Wall{pen, 0.1, 1.0}));
  }
  const double grow = vehicle.radius_m + clearance, doubt = 0.1 * clearance + cell;
  if (!joined(problem.world, vehicle, problem.start, problem.start, grow + doubt) || !joined(problem.world, vehicle, problem.goal, problem.goal, grow + doubt)) return std::nullopt;
  problem.reachable = joined(problem.world, vehicle, problem.start, problem.goal, grow + doubt);
  if (problem.reachable != joined(problem.world, vehicle, problem.start, problem.goal, grow - doubt)) return std::nullopt;
  return problem;
}

Mission mission_of(const Problem& problem, const char* planner, const char* hand) {
  Mission mission;
  mission.vehicle.radius_m = 0.25;
  mission.planner.name = planner;
  mission.planner.hand = hand;
  mission.planner.goal_m = problem.goal;
  mission.planner.clearance_m = clearance;
  mission.start.x_m = problem.start.x;
  mission.start.y_m = problem.start.y;
  ScanningRadarSpec radar;
  radar.position_m = {0.0, 0.0, 0.2};
  mission.sensors = {radar};
  mission.map.enabled = false;
  mission.limits.time_s = 3000.0;
  return mission;
}

}  // namespace

TEST_CASE("verdicts of bug1 and bug2 are those of the oracle in random worlds, on either hand") {
  const char* wanted = std::getenv("THICKET_PROBLEMS");  // more than the standard number, for a study
  const unsigned problems = wanted ? static_cast<unsigned>(std::atoi(wanted)) : 60;
  unsigned used = 0, unreachable = 0;
  for (unsigned seed = 0; used < problems; ++seed) {
    REQUIRE(seed < 20 * problems + 200);
    VehicleSpec vehicle;
    vehicle.radius_m = 0.25;
    const auto problem = make_problem(seed, vehicle);
    if (!problem) continue;
    ++used;
    unreachable += !problem->reachable;
    const char* planner = seed % 2 ? "bug1" : "bug2";
    const char* hand = seed % 3 ? "left" : "right";
    auto simulation = Simulation::create(mission_of(*problem, planner, hand), problem->world);
    REQUIRE(simulation);
    while (simulation->step()) {
    }
    CAPTURE(seed);
    CAPTURE(planner);
    CAPTURE(hand);
    CAPTURE(simulation->verdict()->reason);
    CHECK(std::string(to_string(simulation->verdict()->kind)) == (problem->reachable ? "reached" : "unreachable"));
    CHECK(simulation->totals().least_clearance > 0.5 * clearance);
  }
  CHECK(unreachable >= used / 10);  // else the worlds would test only half of it
}

}  // namespace thicket

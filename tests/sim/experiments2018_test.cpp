// The missions and experiments of Billdal 2018, short: ranges, tops, scores.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "experiments/billdal2018.hpp"
#include "experiments/passes.hpp"
#include "finished.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/experiments.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

Mission mission_of(const std::string& name, const std::vector<std::pair<std::string, std::string>>& sets = {}) {
  std::vector<Override> overrides;
  for (const auto& [key, value] : sets) overrides.push_back({key, value, "test"});
  auto mission = read_mission(find_input(name), overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

/// Past an object from y = -0.5 to 0.5 m, without a map.
Pass pass_of(const std::string& object, std::vector<std::pair<std::string, std::string>> sets = {}) {
  sets.insert(sets.end(), {{"start.y_m", "-0.5"}, {"planner.waypoints_m", "[[0.0, 0.5]]"}, {"map.enabled", "false"}});
  auto simulation = Simulation::create(mission_of("strafe/strafe_" + object, sets));
  if (!simulation) FAIL(simulation.error().message);
  return fly_past(*simulation);
}

/// Mean power of the strongest bin about the object over the scans within 0.3 m of y = 0: single scans have the speckle of their rays.
double power_of(const Pass& pass) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < pass.y.size(); ++i)
    if (std::abs(pass.y[i]) < 0.3) {
      const double amplitude = pass.strongest(i, 2.9, 3.15).amplitude;
      sum += amplitude * amplitude;
      ++count;
    }
  return sum / count;
}

double db(double power) { return 10.0 * std::log10(power); }

void check_reached(const Simulation& simulation) {
  REQUIRE(simulation.verdict());
  INFO(simulation.verdict()->reason);
  CHECK(simulation.verdict()->kind == Verdict::Kind::reached);
}

}  // namespace

TEST_CASE("strafing past the plate: the first echo is the plate, at its distance to the bin, and the way is straight") {
  const Pass pass = pass_of("plate");
  REQUIRE(pass.y.size() > 20);
  CHECK(std::abs(pass.y[pass.closest()]) < 0.03);
  const Top top = pass.strongest(pass.closest(), 0.3, 9.8);
  MESSAGE("top of the plate at ", top.range, " m, amplitude ", top.amplitude, ", found in ", 100.0 * pass.found(3.0, 0.1), " % of the scans");
  CHECK(std::abs(top.range - 2.9975) <= 2.0 * pass.bin_size);  // of the front face; rays beside its middle go 1 mm to 8 cm farther
  CHECK(pass.found(3.0, 0.1) == 1.0);
  CHECK(std::abs(pass.strongest_of_sum(0.3, 9.8).range - 3.0) < 0.03);
}

TEST_CASE("a tilted plate, a pole and a wire are far weaker than the plate, the wire farthest") {
  // Without noise, so that what is compared is the objects and the floor at their range.
  const std::vector<std::pair<std::string, std::string>> alone = {{"sensor.noise", "0"}};
  const double plate = db(power_of(pass_of("plate", alone))), tilted = db(power_of(pass_of("plate45", alone))), pole = db(power_of(pass_of("pole", alone))), wire = db(power_of(pass_of("wire", alone)));
  MESSAGE("dB against the plate: at 45 degrees ", tilted - plate, ", pole ", pole - plate, ", wire ", wire - plate);
  CHECK(tilted < plate - 15.0);
  CHECK(pole < plate - 5.0);
  CHECK(wire < plate - 15.0);
  CHECK(wire <= pole);
}

TEST_CASE("without the floor gate the first echo of a strafing run is the floor") {
  const Pass gate = pass_of("wire"), none = pass_of("wire", {{"sensor.floor_gate", "false"}});
  const double nearest = none.detected[none.closest()];
  CHECK(nearest > 1.5);  // 1 m / sin(32.5 deg) = 1.86 m
  CHECK(nearest < 2.4);
  CHECK_FALSE(std::abs(gate.detected[gate.closest()] - nearest) < 0.05);
}

TEST_CASE("a run at 2 m/s has a quarter of the scans, and a hand that shakes no straight way; both find the plate") {
  const Pass slow = pass_of("plate"), fast = pass_of("plate", {{"planner.speed_m_s", "2.0"}}), shaken = pass_of("plate", {{"vehicle.jitter_m_s", "0.3"}});
  CHECK(fast.y.size() < slow.y.size());
  CHECK(fast.found(3.0, 0.15) > 0.9);
  CHECK(shaken.found(3.0, 0.4) > 0.8);
  CHECK(shaken.y != slow.y);
}

TEST_CASE("the test room is flown round without a collision, and its map is right within 0.2 m") {
  const Simulation simulation = finished(mission_of("ntnu_room/ntnu_room"));
  check_reached(simulation);
  const auto score = score_run(simulation);
  REQUIRE(score);
  MESSAGE("F1 ", score->map.f1, ", precision ", score->map.precision, ", recall ", score->map.recall);
  CHECK(score->map.f1 > 0.5);
  CHECK(claimed_near(simulation, {"plate", 3.0, 0.0, 0.4}) > 0);
}

TEST_CASE("both runs through the cluttered room and the flight in the hold reach their ends without a collision, and map what is large") {
  for (const char* name : {"cluttered_room/cluttered_one", "cluttered_room/cluttered_two"}) {
    CAPTURE(std::string(name));
    const Simulation simulation = finished(mission_of(name));
    check_reached(simulation);
    for (const PlacedThing& thing : cluttered_things()) {
      const std::size_t cells = claimed_near(simulation, thing);
      MESSAGE(std::string(thing.name), ": ", cells);
      if (std::string(thing.name) == "car" || std::string(thing.name) == "dumpster") CHECK(cells > 3);
    }
  }
}

TEST_CASE("standing still adds no wrong cells after the first second") {
  auto simulation = Simulation::create(mission_of("cluttered_room/standing_still"));
  REQUIRE(simulation);
  REQUIRE(drive_until_standing(*simulation));
  const ClaimedCells before = claimed_cells(*simulation);
  const double began = simulation->time();
  while (simulation->step()) {
  }
  check_reached(*simulation);
  CHECK(simulation->time() - began > 20.0);
  const ClaimedCells after = claimed_cells(*simulation);
  MESSAGE("claimed ", before.all, " then ", after.all, ", wrong ", before.wrong, " then ", after.wrong);
  CHECK(after.wrong <= before.wrong);
}

TEST_CASE("the hold: along the walls to the end, over its mesh") {
  const Simulation simulation = finished(mission_of("cargo_hold/along_walls", {{"map.resolution_m", "0.1"}}));
  check_reached(simulation);
  CHECK(simulation.totals().least_clearance > 0.5);
  const auto score = score_run(simulation);
  REQUIRE(score);
  MESSAGE("F1 ", score->map.f1, ", precision ", score->map.precision, ", recall ", score->map.recall);
  CHECK(score->map.f1 > 0.3);
}

}  // namespace thicket

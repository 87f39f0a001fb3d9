// The shipped worlds that show what Bug planners do: figures 13 and 14 of the 2012 text, its failure rule gone wrong, combs, explorers.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "finished.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/judge.hpp"

namespace thicket {
namespace {

Mission shipped(const std::string& name) {
  const auto file = find_input(name);
  REQUIRE_MESSAGE(!file.empty(), name);
  auto mission = read_mission(file, {{"map.enabled", "false", "test"}});
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

struct Run {
  std::string verdict;
  double path_m = 0.0, least_clearance_m = 0.0;
  Expected expected = Expected::ambiguous;  ///< what the world itself says
};

Run run_of(const std::string& name) {
  const Mission mission = shipped(name);
  const Simulation simulation = finished(mission);
  Run run{to_string(simulation.verdict()->kind), simulation.totals().path_length, simulation.totals().least_clearance};
  if (mission.planner.goal_m) {
    const glm::dvec2 start(mission.start.x_m, mission.start.y_m);
    const Robot robot{mission.vehicle, mission.planner.clearance_m, mission.planner.goal_tolerance_m};
    const auto oracle = Oracle::create(simulation.scene().world(), {start, *mission.planner.goal_m}, robot, 0.0);
    REQUIRE(oracle);
    run.expected = oracle->judge(start, *mission.planner.goal_m).expected;
  }
  return run;
}

}  // namespace

TEST_CASE("bug worlds: Bug1 and Bug2 succeed and fail as in figures 13 and 14, Bug1 by the longer way") {
  double length[2][2] = {};
  for (const int planner : {1, 2}) {
    for (const bool success : {true, false}) {
      const std::string name = "bugs/bug" + std::to_string(planner) + (success ? "_success" : "_failure");
      CAPTURE(name);
      const Run run = run_of(name);
      CHECK(run.verdict == (success ? "reached" : "unreachable"));
      CHECK(run.expected == (success ? Expected::reachable : Expected::unreachable));
      CHECK(run.least_clearance_m > 0.8);
      length[planner - 1][success ? 1 : 0] = run.path_m;
    }
  }
  CHECK(length[0][0] > 1.3 * length[1][0]);
  CHECK(length[0][1] > 1.3 * length[1][1]);
}

TEST_CASE("bug worlds: the failure rule of 2012 gives up where there is a way, and Bug2 finds it") {
  const Run wrong = run_of("bugs/bug2_2012_wrong"), right = run_of("bugs/bug2_2012_right");
  CHECK(wrong.expected == Expected::reachable);
  CHECK(wrong.verdict == "unreachable");
  CHECK(right.verdict == "reached");
  // Nothing but the planner differs.
  Mission a = shipped("bugs/bug2_2012_wrong");
  const Mission b = shipped("bugs/bug2_2012_right");
  a.name = b.name;
  a.description = b.description;
  a.planner.name = b.planner.name;
  CHECK(write_mission(a) == write_mission(b));
}

TEST_CASE("bug worlds: Bug1 is the shorter one in two combs that stand in each other, Bug2 at a comb that stands free") {
  const Run two1 = run_of("bugs/two_combs_bug1"), two2 = run_of("bugs/two_combs_bug2"), free1 = run_of("bugs/comb_bug1"), free2 = run_of("bugs/comb_bug2");
  for (const Run& run : {two1, two2, free1, free2}) {
    CHECK(run.verdict == "reached");
    CHECK(run.expected == Expected::reachable);
  }
  CHECK(1.4 * two1.path_m < two2.path_m);
  CHECK(1.4 * free2.path_m < free1.path_m);
}

TEST_CASE("bug worlds: each explorer drives the distance that it is asked for, without touching anything") {
  for (const char* name : {"explorers/wall_then_inside", "explorers/bounce", "explorers/center_out", "explorers/explore"}) {
    CAPTURE(name);
    const Run run = run_of(name);
    CHECK(run.verdict == "reached");
    CHECK(run.path_m > 50.0);
    CHECK(run.least_clearance_m > 0.3);
  }
}

}  // namespace thicket

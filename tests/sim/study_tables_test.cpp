// What the studies of tests/bench state their results with.
#include <doctest/doctest.h>

#include <cmath>

#include "bench/study_tables.hpp"
#include "thicket/sim/reachability.hpp"

namespace thicket::study {
namespace {

Attempt ended(Expected expected, Verdict::Kind verdict, double goal_distance) {
  Attempt a;
  a.expected = expected;
  a.verdict = verdict;
  a.goal_distance_m = goal_distance;
  return a;
}

}  // namespace

TEST_CASE("a study's table, its quantiles, and its part of a page") {
  CHECK(markdown({"map", "right"}, {{"maze", "7"}}) == "| map | right |\n|---|---:|\n| maze | 7 |\n");
  CHECK(quantile({3.0, 1.0, 2.0, 4.0}, 0.5) == 2.0);
  CHECK(quantile({3.0, 1.0, 2.0, 4.0}, 0.9) == 4.0);
  CHECK(std::isnan(quantile({}, 0.5)));
  CHECK(percent(1, 8) == "12.5 %");
  CHECK(percent(0, 0) == "-");
  const auto page = with_part("head\n<!-- begin maps -->\nold\n<!-- end maps -->\ntail\n", "maps", "new\n");
  REQUIRE(page);
  CHECK(*page == "head\n<!-- begin maps -->\n\nnew\n\n<!-- end maps -->\ntail\n");
  CHECK(*with_part(*page, "maps", "new\n") == *page);
  CHECK_FALSE(with_part(*page, "rooms", "new\n"));
}

TEST_CASE("false failures are of goals that can be reached, false successes of any, and what is ambiguous counts for nothing") {
  using K = Verdict::Kind;
  const DriftTally t = drift_tally({ended(Expected::reachable, K::reached, 0.9), ended(Expected::reachable, K::reached, 1.2), ended(Expected::reachable, K::unreachable, 5.0),
                                    ended(Expected::reachable, K::stopped, 0.0), ended(Expected::reachable, K::collided, 5.0), ended(Expected::unreachable, K::unreachable, 5.0),
                                    ended(Expected::unreachable, K::reached, 5.0), ended(Expected::unreachable, K::stopped, 5.0), ended(Expected::ambiguous, K::reached, 5.0)},
                                   0.1, 1.0);
  CHECK(t.runs == 8);
  CHECK(t.reachable == 5);
  CHECK(t.success == 1);
  CHECK(t.false_failure == 2);
  CHECK(t.stopped == 1);
  CHECK(t.false_success == 2);
  CHECK(t.collisions == 1);
}

TEST_CASE("one judged run is the row of a study, and odometry that is far off makes it believe that it is there") {
  const auto lean = lean_mission(), lost = lean_mission({{"odometry.speed_scale", "2.0", ""}});
  REQUIRE(lean);
  REQUIRE(lost);
  const Robot robot = robot_of(*lean);
  const auto problem = make_problem("convex", 3, robot);
  REQUIRE(problem);
  const auto judgement = judge(*problem, robot, 0.0);
  REQUIRE(judgement);
  REQUIRE(judgement->expected == Expected::reachable);
  const auto scene = Scene::build(*problem->world);
  REQUIRE(scene);
  const auto one = attempt(mission_of(*lean, *problem, *judgement, "bug2", "right"), *problem, *judgement, *scene);
  REQUIRE(one);
  ReachabilityOptions options;
  options.planners = {"bug2"};
  options.jobs = 1;
  const auto study = run_reachability(generated_problems({"convex"}, 3, 1, robot), *lean, options);
  REQUIRE(study);
  CHECK(attempts_csv({*one}) == attempts_csv(*study));
  CHECK(one->decisions > 10);
  CHECK(one->times.plan > 0.0);
  CHECK(drift_tally({*one}, 0.1, 1.0).success == 1);
  // It takes every metre for two, so that it stops half-way.
  const auto astray = attempt(mission_of(*lost, *problem, *judgement, "bug2", "right"), *problem, *judgement, *scene);
  REQUIRE(astray);
  CHECK(astray->goal_distance_m > 1.1);
  CHECK(drift_tally({*astray}, 0.1, 1.0).success == 0);
  CHECK(ratios({*one}, Over::shortest).size() == 1);
  CHECK(ratios({*one}, Over::straight).front() >= ratios({*one}, Over::shortest).front());
}

}  // namespace thicket::study

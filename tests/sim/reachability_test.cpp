// Many runs, judged: scores, totals, and that neither threads nor files change a run.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "finished.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/reachability.hpp"

namespace thicket {
namespace {

std::vector<Attempt> attempts_of(const ProblemList& problems, const ReachabilityOptions& options, const std::vector<Override>& changes = {}) {
  const auto lean = lean_mission(changes);
  if (!lean) FAIL(lean.error().message);
  auto attempts = run_reachability(problems, *lean, options);
  if (!attempts) FAIL(attempts.error().message);
  return *attempts;
}

Robot lean_robot() { return robot_of(*lean_mission()); }

Attempt made(const char* planner, const char* family, Expected expected, Verdict::Kind verdict, double path, double shortest, double bound) {
  Attempt a;
  a.planner = planner;
  a.family = family;
  a.expected = expected;
  a.verdict = verdict;
  a.path_m = path;
  a.shortest_m = shortest;
  a.bound_m = bound;
  a.simulated_s = 10.0;
  a.least_clearance_m = path;
  a.score = score_of(expected, verdict, 0.0, 0.1);
  return a;
}

}  // namespace

TEST_CASE("a verdict is right if it is that of the world; stopped and collided are wrong, a collision of an ambiguous problem too") {
  using K = Verdict::Kind;
  CHECK(score_of(Expected::reachable, K::reached, 0.05, 0.1) == Score::right);
  CHECK(score_of(Expected::reachable, K::reached, 0.2, 0.1) == Score::wrong);  // it only believes so
  CHECK(score_of(Expected::reachable, K::unreachable, 0.05, 0.1) == Score::wrong);
  CHECK(score_of(Expected::reachable, K::stopped, 0.05, 0.1) == Score::wrong);
  CHECK(score_of(Expected::unreachable, K::unreachable, 5.0, 0.1) == Score::right);
  CHECK(score_of(Expected::unreachable, K::reached, 0.05, 0.1) == Score::wrong);
  CHECK(score_of(Expected::unreachable, K::stopped, 5.0, 0.1) == Score::wrong);
  for (const K verdict : {K::reached, K::unreachable, K::stopped}) CHECK(score_of(Expected::ambiguous, verdict, 0.05, 0.1) == Score::ambiguous);
  for (const Expected expected : {Expected::reachable, Expected::unreachable, Expected::ambiguous}) CHECK(score_of(expected, K::collided, 0.05, 0.1) == Score::wrong);
}

TEST_CASE("totals by planner and family") {
  using K = Verdict::Kind;
  std::vector<Attempt> attempts = {made("bug1", "a", Expected::reachable, K::reached, 12.0, 10.0, 20.0), made("bug1", "a", Expected::reachable, K::reached, 30.0, 10.0, 20.0),
                                   made("bug1", "a", Expected::unreachable, K::stopped, 50.0, infinity, 20.0), made("bug1", "b", Expected::ambiguous, K::reached, 90.0, 10.0, 20.0),
                                   made("bug2", "a", Expected::unreachable, K::unreachable, 5.0, infinity, 9.0), made("bug1", "b", Expected::ambiguous, K::collided, 1.0, 10.0, 20.0)};
  const auto totals = total(attempts);
  REQUIRE(totals.size() == 4);
  CHECK(totals[0].planner == "bug1");
  CHECK(totals[0].family == "a");
  CHECK(totals[0].problems == 3);
  CHECK(totals[0].right == 2);
  CHECK(totals[0].wrong == 1);
  CHECK(totals[0].unreachable == 1);
  CHECK(totals[0].over_bound == 1);
  CHECK(totals[0].ratio_median == doctest::Approx(1.2));
  CHECK(totals[0].ratio_p90 == doctest::Approx(3.0));
  CHECK(totals[0].bound_use == doctest::Approx(1.5));
  CHECK(totals[0].simulated_s == doctest::Approx(30.0));
  CHECK(totals[1].family == "b");
  CHECK(totals[1].ambiguous == 2);
  CHECK(totals[1].collisions == 1);
  CHECK(totals[1].wrong == 1);
  CHECK(totals[1].bound_use == 0.0);
  CHECK(totals[2].family == "all");
  CHECK(totals[2].problems == 5);
  CHECK(totals[2].least_clearance_m == 1.0);
  CHECK(totals[3].planner == "bug2");
  CHECK(totals[3].right == 1);
  CHECK(std::isnan(totals[3].ratio_median));
  attempts[0].reason = "say \"no\"";
  const std::string csv = attempts_csv(attempts);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 7);
  CHECK(csv.find("\"a\",0,bug1,,reachable,reached,right,12.0000,0.0000,10.0000,20.0000,") != std::string::npos);
  CHECK(csv.find("\"say \"\"no\"\"\"") != std::string::npos);
}

TEST_CASE("the same rows for one job and for two, in the order of the problems") {
  ReachabilityOptions options;
  options.planners = {"bug2", "bug1"};
  options.jobs = 1;
  const ProblemList problems = generated_problems({"convex", "enclosed"}, 3, 3, lean_robot());
  const auto alone = attempts_of(problems, options, {{"sensor.range_noise_m", "0.03", ""}});
  options.jobs = 2;
  std::size_t told = 0;
  options.progress = [&](const ReachabilityProgress& p) { told = p.problems; };
  const auto together = attempts_of(problems, options, {{"sensor.range_noise_m", "0.03", ""}});
  CHECK(attempts_csv(alone) == attempts_csv(together));
  CHECK(told == 6);
  REQUIRE(alone.size() == 12);
  CHECK(alone[0].planner == "bug2");
  CHECK(alone[1].planner == "bug1");
  CHECK(alone[0].number == 3);
  CHECK(alone[0].hand == "right");
  CHECK(alone[2].hand == "left");
  CHECK(alone[6].family == "enclosed");
  CHECK(alone[0].path_m > 1.0);
}

TEST_CASE("a run that is cut short is wrong, and its kept mission repeats it") {
  const TemporaryFolder folder;
  ReachabilityOptions options;
  options.planners = {"bug1"};
  options.hand = "both";
  options.keep_failures = folder.path() / "kept";
  const auto attempts = attempts_of(generated_problems({"convex"}, 2, 1, lean_robot()), options, {{"limits.time_s", "17.5", ""}, {"sensor.range_noise_m", "0.02", ""}});
  REQUIRE(attempts.size() == 2);
  for (const Attempt& a : attempts) {
    CHECK(a.score == Score::wrong);
    CHECK(a.verdict == Verdict::Kind::stopped);
    CHECK(a.reason == "time limit of 17.5 s");
    const auto mission = read_mission(options.keep_failures / ("convex-2-bug1-" + a.hand + ".toml"), {});
    if (!mission) FAIL(mission.error().message);
    const Simulation again = finished(*mission);
    CHECK(again.verdict()->reason == a.reason);
    CHECK(again.totals().path_length == a.path_m);
    CHECK(again.totals().least_clearance == a.least_clearance_m);
    CHECK(again.time() == a.simulated_s);
  }
}

TEST_CASE("what there is not is told before anything runs") {
  const auto lean = lean_mission();
  REQUIRE(lean);
  const ProblemList problems = generated_problems({"convex"}, 0, 1, lean_robot());
  ReachabilityOptions options;
  options.planners = {"bug3"};
  CHECK(run_reachability(problems, *lean, options).error().message.find("there is no planner 'bug3'") != std::string::npos);
  options.planners = {"bug1"};
  options.hand = "middle";
  CHECK(run_reachability(problems, *lean, options).error().message.find("there is no hand 'middle'") != std::string::npos);
  options.hand = "left";
  CHECK_FALSE(run_reachability(generated_problems({"convexe"}, 0, 1, lean_robot()), *lean, options));
  CHECK_FALSE(lean_mission({{"planner.clearence_m", "1", "--set planner.clearence_m"}}));
}

}  // namespace thicket

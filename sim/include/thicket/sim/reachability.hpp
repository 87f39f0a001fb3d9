// Planners on many problems, each run judged by the world itself: is the verdict right, was there a collision, was the way within the theorem's bound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/sim/judge.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/problem.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {

/// Problems by their place, made when they are asked for, from several threads at once.
struct ProblemList {
  std::size_t count = 0;
  std::function<Result<Problem>(std::size_t)> at;
};
/// The problems `first` ... `first + count - 1` of each family.
ProblemList generated_problems(const std::vector<std::string>& families, std::uint64_t first, std::size_t count, const Robot& robot);
ProblemList listed_problems(std::vector<Problem> problems);

/// A mission without world, start and goal, for runs that need no more than their verdict: no map, no outputs, 10 decisions a second, steps of 0.1 s; a scanning radar of
/// 180 rays that sees 5 m at a height of 0.2 m and reports the first echo of each; a hull of 0.25 m radius and 0.4 m clearance. `changes` come on top.
Result<Mission> lean_mission(const std::vector<Override>& changes = {});
/// The robot that a mission has, and the noise of its first sensor, m.
Robot robot_of(const Mission& mission);
double noise_of(const Mission& mission);

/// The mission of one run. What goes round for ever is stopped after 3 x the planner's bound + 100 m (of a planner without one, the greatest of the others' bounds), or
/// twice the time that this takes at cruising speed + 10 minutes, unless `lean` has limits of its own.
Mission mission_of(const Mission& lean, const Problem& problem, const Judgement& judgement, const std::string& planner, const std::string& hand);

/// More rays for the scanning radar of a mission whose world has posts, slivers or walls that it could miss until it is too late to brake; no effect on other sensors.
void see_what_is_narrow(Mission& mission, const World& world);

enum class Score { right, wrong, ambiguous };
const char* to_string(Score score);

/// One run. Lengths in metres.
struct Attempt {
  std::string family;
  std::uint64_t number = 0;
  std::string planner, hand;
  Expected expected = Expected::ambiguous;
  Verdict::Kind verdict = Verdict::Kind::stopped;
  Score score = Score::wrong;
  std::string reason;  ///< why the run ended
  double path_m = 0.0, straight_m = 0.0;
  double shortest_m = 0.0;  ///< +inf: none
  double bound_m = 0.0;     ///< of this planner; +inf: no theorem gives one
  double least_clearance_m = 0.0;
  double goal_distance_m = 0.0;  ///< at the end, truly
  double simulated_s = 0.0;
  double cell_m = 0.0, doubt_m = 0.0;  ///< of the oracle
  std::uint64_t decisions = 0;
  PhaseTimes times;  ///< wall time; what differs from machine to machine is in no table and no CSV row of `thicket reachability`

  bool collided() const { return verdict == Verdict::Kind::collided; }
  /// It reached a goal that can be reached, so that the bound holds.
  bool bounded() const { return expected == Expected::reachable && verdict == Verdict::Kind::reached && bound_m < infinity; }
  bool over_bound() const { return bounded() && path_m > 1.05 * bound_m + 2.0; }
};

/// Right: reached (and truly within the goal's tolerance) what is reachable, unreachable what is not. Wrong: the opposite, stopped, and any collision, of an ambiguous
/// problem too.
Score score_of(Expected expected, Verdict::Kind verdict, double goal_distance_m, double goal_tolerance_m);

/// Runs a mission that `mission_of` has made to its end, in the problem's scene, and judges it. Errors: as `Simulation::create`.
Result<Attempt> attempt(const Mission& mission, const Problem& problem, const Judgement& judgement, const Scene& scene);

/// How far a study has come.
struct ReachabilityProgress {
  std::size_t problems = 0, of = 0, attempts = 0, wrong = 0;
  double simulated_s = 0.0;
};

struct ReachabilityOptions {
  std::vector<std::string> planners = {"bug1", "bug2", "tangent_bug"};
  std::string hand = "alternate";  ///< "left" | "right" | "both" | "alternate": left for even numbers of problems, right for odd ones
  bool finer_for_narrow = true;    ///< `see_what_is_narrow` for every problem
  double cell_m = 0.05;            ///< of the oracle
  int jobs = 0;                    ///< threads; 0: as many as there are cores
  std::filesystem::path keep_failures;  ///< folder for missions that repeat each wrong run; empty: none
  std::function<void(const ReachabilityProgress&)> progress;  ///< called after every problem, by one thread at a time
  std::function<bool()> interrupted;                          ///< asked before every problem; true leaves out what is not begun
};

/// Runs every planner on every problem. Rows in the order of problems, planners and hands, the same for any number of jobs. Errors: a problem that cannot be made, a
/// planner or hand that does not exist, a folder that cannot be written to.
Result<std::vector<Attempt>> run_reachability(const ProblemList& problems, const Mission& lean, const ReachabilityOptions& options);

/// The totals of one planner in one family.
struct ReachabilityTotals {
  std::string planner, family;
  std::size_t problems = 0, right = 0, wrong = 0, ambiguous = 0, collisions = 0, unreachable = 0;  ///< unreachable: as the oracle says
  std::size_t over_bound = 0;
  double ratio_median = 0.0, ratio_p90 = 0.0;  ///< length / shortest, of right runs that reached the goal; NaN: none
  double bound_use = 0.0;                      ///< the greatest length / bound; 0: none
  double least_clearance_m = infinity;
  double simulated_s = 0.0;
};
/// By planner, then family, both in the order of their first attempt; after the families of a planner all of them, as family "all", if there are several.
std::vector<ReachabilityTotals> total(const std::vector<Attempt>& attempts);

/// A head and a row for each attempt.
std::string attempts_csv(const std::vector<Attempt>& attempts);

}  // namespace thicket

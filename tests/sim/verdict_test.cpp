// Verdicts against an oracle: in problems of all families the planners say what a flood fill of the grown free space says, which shares no code with them; without a collision, and within the
// bounds of the theorems.
#include <doctest/doctest.h>

#include <cstdlib>

#include <fmt/format.h>

#include "thicket/sim/reachability.hpp"

namespace thicket {
namespace {

std::vector<Attempt> attempts_at(const std::vector<std::string>& families, std::size_t per_family, std::uint64_t first, const ReachabilityOptions& options, double noise) {
  auto lean = lean_mission({{"sensor.range_noise_m", fmt::format("{}", noise), ""}});
  if (!lean) FAIL(lean.error().message);
  auto attempts = run_reachability(generated_problems(families, first, per_family, robot_of(*lean)), *lean, options);
  if (!attempts) FAIL(attempts.error().message);
  return std::move(*attempts);
}

void check_is_right(const Attempt& a) {
  CAPTURE(a.family);
  CAPTURE(a.number);
  CAPTURE(a.planner);
  CAPTURE(a.hand);
  CAPTURE(a.reason);
  CHECK(a.score != Score::wrong);
  CHECK(a.verdict != Verdict::Kind::collided);
  CHECK_FALSE(a.over_bound());
}

}  // namespace

TEST_CASE("bug1, bug2 and tangent_bug are right in problems of all ten families, with noise, without a collision") {
  const char* wanted = std::getenv("THICKET_PROBLEMS");  // of each family; more than the standard number, for a study
  const std::size_t per_family = wanted ? static_cast<std::size_t>(std::atoi(wanted)) : 11;
  std::size_t decided = 0, unreachable = 0;
  for (const Attempt& a : attempts_at(problem_families(), per_family, 0, {}, 0.03)) {
    check_is_right(a);
    decided += a.score != Score::ambiguous;
    unreachable += a.expected == Expected::unreachable;
  }
  CHECK(decided >= 3 * 9 * per_family);  // of 3 planners x 10 families
  CHECK(unreachable >= decided / 5);     // else the problems would test only half of it
}

TEST_CASE("problems that went wrong once, of 30000 runs, do not with other noise either") {
  struct Case {
    const char *family, *planner;
    std::uint64_t number;
    const char* what;
  };
  for (const Case& c : {Case{"random", "bug2", 274, "the M-line grazes the boundary: left, hit again beside the leave point, and walked around once more"},
                        Case{"convex", "bug2", 694, "the same"}, Case{"random", "bug1", 727, "unreachable, it said"}, Case{"spiral", "tangent_bug", 571, "longer than its bound"},
                        Case{"random", "tangent_bug", 513, "a turn on the spot in the mouth of a passage, taken for the loop of a cell"}, Case{"random", "bug1", 491, "stood for ever in a dead end: the way on was on the other side of a thin wall"},
                        Case{"random", "bug2", 583, "a gate where it had come along"}}) {
    CAPTURE(c.what);
    ReachabilityOptions options;
    options.planners = {c.planner};
    for (const double noise : {0.03, 0.0312, 0.032, 0.0322, 0.0341, 0.0345, 0.035})
      for (const Attempt& a : attempts_at({c.family}, 1, c.number, options, noise)) check_is_right(a);
  }
}

}  // namespace thicket

// Verdicts against an oracle: in problems of all families the planners say what a flood fill of the grown free space says, which shares no code with them; without a collision, and within the
// bounds of the theorems.
#include <doctest/doctest.h>

#include <cstdlib>

#include "thicket/sim/reachability.hpp"

namespace thicket {
namespace {

std::vector<Attempt> attempts_at(std::size_t per_family, std::uint64_t first) {
  auto lean = lean_mission({{"sensor.range_noise_m", "0.03", ""}});
  if (!lean) FAIL(lean.error().message);
  auto attempts = run_reachability(generated_problems(problem_families(), first, per_family, robot_of(*lean)), *lean, {});
  if (!attempts) FAIL(attempts.error().message);
  return std::move(*attempts);
}

}  // namespace

TEST_CASE("bug1, bug2 and tangent_bug are right in problems of all ten families, with noise, without a collision") {
  const char* wanted = std::getenv("THICKET_PROBLEMS");  // of each family; more than the standard number, for a study
  const std::size_t per_family = wanted ? static_cast<std::size_t>(std::atoi(wanted)) : 11;
  std::size_t decided = 0, unreachable = 0;
  for (const Attempt& a : attempts_at(per_family, 0)) {
    CAPTURE(a.family);
    CAPTURE(a.number);
    CAPTURE(a.planner);
    CAPTURE(a.hand);
    CAPTURE(a.reason);
    CHECK(a.score != Score::wrong);
    CHECK(a.verdict != Verdict::Kind::collided);
    CHECK_FALSE(a.over_bound());
    decided += a.score != Score::ambiguous;
    unreachable += a.expected == Expected::unreachable;
  }
  CHECK(decided >= 3 * 9 * per_family);  // of 3 planners x 10 families
  CHECK(unreachable >= decided / 5);     // else the problems would test only half of it
}

}  // namespace thicket

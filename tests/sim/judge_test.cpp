// What the world itself says about a problem, on worlds whose answer is known.
#include <doctest/doctest.h>

#include <cmath>

#include "thicket/sim/judge.hpp"

namespace thicket {
namespace {

/// keep() = 0.65 m; with cells of 0.05 m and no noise, the growth is in doubt by 0.09 m.
Robot robot() {
  Robot r;
  r.vehicle.radius_m = 0.25;
  return r;
}

Solid wall(std::vector<glm::dvec2> points) { return {"wall", 0, {0.0, 0.0, 0.0}, 0.0, Wall{std::move(points), 0.1, 1.0}}; }

Problem problem_of(std::vector<Solid> solids, const glm::dvec2& start, const glm::dvec2& goal) {
  World world;
  Material material;
  material.name = "wall";
  world.materials.push_back(material);
  world.solids = std::move(solids);
  return {"hand made", 0, std::make_shared<const World>(std::move(world)), {}, 0.0, {start, 0.0}, goal};
}

Judgement judged(const Problem& problem, double noise = 0.0) {
  const auto judgement = judge(problem, robot(), noise);
  REQUIRE(judgement);
  return *judgement;
}

/// Two rooms of 4 x 4 m side by side with a gap in the wall between them.
Problem gap(double width) {
  return problem_of({wall({{-4, -2}, {4, -2}, {4, 2}, {-4, 2}, {-4, -2}}), wall({{0, -2}, {0, -0.5 * width}}), wall({{0, 0.5 * width}, {0, 2}})}, {-2.5, 0.0}, {2.5, 0.0});
}

}  // namespace

TEST_CASE("a gap is a way if it is wider than hull and clearances, ambiguous within the doubt") {
  for (const auto& [width, expected] : {std::pair(1.6, Expected::reachable), {1.3, Expected::ambiguous}, {1.0, Expected::unreachable}}) {
    CAPTURE(width);
    CHECK(judged(gap(width)).expected == expected);
  }
  CHECK(judged(gap(1.6), 0.03).expected == Expected::ambiguous);  // three standard deviations are doubt too
}

TEST_CASE("nothing in between: all bounds are the straight way, which is the shortest") {
  const Judgement j = judged(problem_of({}, {0.0, 0.0}, {3.0, 4.0}));
  CHECK(j.expected == Expected::reachable);
  CHECK(j.straight_m == 5.0);
  CHECK(j.shortest_m == doctest::Approx(5.0));
  CHECK(j.bug1_bound_m == 5.0);
  CHECK(j.bug2_bound_m == 5.0);
  CHECK(j.tangent_bound_m == 5.0);
}

TEST_CASE("bounds and shortest way around a disc") {
  const double radius = 1.0, r = radius + 0.65, doubt = 0.04 + 0.05;
  const Judgement j = judged(problem_of({{"disc", 0, {0.0, 0.0, 0.5}, 0.0, Cylinder{radius, 1.0}}}, {-4.0, 0.0}, {4.0, 0.0}));
  const double p = 2.0 * pi * (r + doubt);  // the widest growth makes the greatest bound
  CHECK(j.doubt_m == doctest::Approx(doubt));
  CHECK(j.bug1_bound_m == doctest::Approx(8.0 + 1.5 * p).epsilon(0.003));
  CHECK(j.bug2_bound_m == doctest::Approx(8.0 + p).epsilon(0.003));          // crossed twice
  CHECK(j.tangent_bound_m == doctest::Approx(8.0 + 2.0 * p).epsilon(0.003));  // one minimum
  const double tangent = std::sqrt(16.0 - r * r), arc = r * 2.0 * (pi / 2 - std::acos(r / 4.0));
  CHECK(j.shortest_m == doctest::Approx(2.0 * tangent + arc).epsilon(0.02));
  CHECK(j.shortest_m > 2.0 * tangent + arc - 0.1);
}

TEST_CASE("an obstacle beyond the disc about the goal counts for Bug2 alone if the line meets it, and for none if not") {
  const Solid behind{"disc", 0, {-8.0, 0.0, 0.5}, 0.0, Cylinder{0.5, 1.0}};
  const Judgement j = judged(problem_of({behind}, {-4.0, 0.0}, {4.0, 0.0}));
  CHECK(j.bug1_bound_m == 8.0);
  CHECK(j.bug2_bound_m == 8.0);
}

TEST_CASE("a goal in matter is unreachable; in the clearance band it is reached within its tolerance only") {
  const Solid block{"block", 0, {3.0, 0.0, 0.5}, 0.0, Box{{2.0, 2.0, 1.0}}};
  CHECK(judged(problem_of({block}, {-3.0, 0.0}, {3.0, 0.0})).expected == Expected::unreachable);
  CHECK(judged(problem_of({block}, {-3.0, 0.0}, {1.6, 0.0})).expected == Expected::unreachable);  // 0.4 m from it
  CHECK(judged(problem_of({block}, {-3.0, 0.0}, {1.4, 0.0})).expected == Expected::ambiguous);    // 0.60 m: too far from 0.74 m
  CHECK(judged(problem_of({block}, {-3.0, 0.0}, {1.3, 0.0})).expected == Expected::reachable);    // 0.70 m
}

TEST_CASE("a start in the band begins where the robot gets out of it, but not through a wall") {
  // In the band of a long wall; the goal on the same side, and on the other one in a closed room.
  const std::vector<Solid> room = {wall({{-4, -3}, {4, -3}, {4, 3}, {-4, 3}, {-4, -3}}), wall({{0, -3}, {0, 3}})};
  CHECK(judged(problem_of(room, {-0.4, 0.0}, {-2.5, 1.0})).expected == Expected::reachable);
  CHECK(judged(problem_of(room, {-0.4, 0.0}, {2.5, 1.0})).expected == Expected::unreachable);
  CHECK(std::isinf(judged(problem_of(room, {-0.4, 0.0}, {-2.5, 1.0})).shortest_m));
  // In a gap that is too narrow to pass, both sides are open to it: which way it takes decides.
  Problem between = gap(1.0);
  between.start.position = {0.0, 0.0};
  CHECK(judged(between).expected == Expected::ambiguous);
}

TEST_CASE("a wall thinner than the oracle's cells is a wall") {
  const Solid thin{"sheet", 0, {0.0, 0.0, 0.5}, 0.1, Box{{0.004, 20.0, 1.0}}};
  const std::vector<Solid> room = {wall({{-4, -3}, {4, -3}, {4, 3}, {-4, 3}, {-4, -3}}), thin};
  CHECK(judged(problem_of(room, {-2.0, 0.0}, {2.0, 0.0})).expected == Expected::unreachable);
  CHECK(judged(problem_of(room, {-0.4, 0.0}, {2.0, 0.0})).expected == Expected::unreachable);
}

}  // namespace thicket

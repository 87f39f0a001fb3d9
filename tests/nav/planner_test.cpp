// What all planners share, Bug1 and Bug2, and the walk around a boundary.
#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "boundary_walk.hpp"
#include "disc_world.hpp"
#include "thicket/nav/planner.hpp"

namespace thicket {
namespace {

constexpr double keep = 0.6;

}  // namespace

TEST_CASE("with nothing in the way both planners go straight") {
  for (const char* name : {"bug1", "bug2"}) {
    const Run run = drive(std::vector<Disc>{}, to(5.0, 0.0, name, "left"));
    CHECK(run.last.outcome == Outcome::reached);
    CHECK(run.length == doctest::Approx(4.9).epsilon(0.03));
    CHECK(std::abs(run.side) < 0.01);
  }
}

TEST_CASE("Bug2 goes half around a disc and leaves on the M-line, the hand decides the side") {
  for (const char* hand : {"left", "right"}) {
    const Run run = drive({{{4.0, 0.0}, 1.0}}, to(8.0, 0.0, "bug2", hand));
    CAPTURE(hand);
    CHECK(run.last.outcome == Outcome::reached);
    // straight 2.4, half a circle of radius 1.6, straight 2.4 (the theorem's D + p/2 is the same)
    CHECK(run.length == doctest::Approx(4.8 + pi * (1.0 + keep)).epsilon(0.05));
    CHECK(run.side * (std::string(hand) == "left" ? -1.0 : 1.0) == doctest::Approx(1.0 + keep).epsilon(0.05));
    CHECK(count(run.marks, "hit") == 1);
    CHECK(count(run.marks, "leave") == 1);
    CHECK(count(run.marks, "M-line") == 1);
    CHECK(run.least > 0.36);
  }
}

TEST_CASE("Bug1 walks the whole circle and then the shorter half back: at most D + 1.5 p") {
  for (const char* hand : {"left", "right"}) {
    const Run run = drive({{{4.0, 0.3}, 1.0}}, to(8.0, 0.0, "bug1", hand));
    CHECK(run.last.outcome == Outcome::reached);
    const double perimeter = 2.0 * pi * (1.0 + keep);
    CHECK(run.length < 8.0 + 1.5 * perimeter + 0.5);
    CHECK(run.length > 4.0 + perimeter);
    CHECK(count(run.marks, "closest") == 1);
  }
}

TEST_CASE("a goal inside a ring of discs is unreachable, after one loop, with the evidence in the reason") {
  std::vector<Disc> ring;
  for (int i = 0; i < 16; ++i) ring.push_back({glm::dvec2(6.0, 0.0) + 2.0 * direction(2.0 * pi * i / 16), 0.45});
  for (const char* name : {"bug1", "bug2"}) {
    const Run run = drive(ring, to(6.0, 0.0, name, "left"));
    CAPTURE(name);
    CHECK(run.last.outcome == Outcome::unreachable);
    CHECK(run.last.reason.find("the boundary hit at") != std::string::npos);
    CHECK(run.length < 3.6 + 2.1 * 2.0 * pi * (2.45 + keep));
    CHECK(run.least > 0.36);
  }
}

TEST_CASE("a start inside a ring of discs is unreachable too, and a gap in the ring is found") {
  std::vector<Disc> ring;
  for (int i = 0; i < 24; ++i) ring.push_back({3.0 * direction(2.0 * pi * i / 24), 0.45});
  for (const char* name : {"bug1", "bug2"}) CHECK(drive(ring, to(8.0, 0.5, name, "right")).last.outcome == Outcome::unreachable);
  std::vector<Disc> gap(ring.begin() + 2, ring.begin() + 22);  // opens toward +x: 2.3 m between the discs' edges at the nearest
  for (const char* name : {"bug1", "bug2"}) CHECK(drive(gap, to(8.0, 0.5, name, "right")).last.outcome == Outcome::reached);
}

TEST_CASE("a gap narrower than hull and two clearances is a wall, a wider one is not") {
  std::vector<Disc> wall;
  for (int i = 0; i < 24; ++i)
    for (const double side : {-1.0, 1.0}) wall.push_back({{4.0, side * (0.2 + 0.4 * i)}, 0.2});
  const auto with_gap = [&](double width) {
    std::vector<Disc> discs = wall;
    for (Disc& disc : discs) disc.centre.y += disc.centre.y > 0.0 ? 0.5 * width : -0.5 * width;
    return discs;
  };
  CHECK(std::abs(drive(with_gap(1.35), to(8.0, 0.0, "bug2", "left")).side) < 0.3);
  const Run around = drive(with_gap(1.05), to(8.0, 0.0, "bug2", "left"));
  CAPTURE(around.last.state);
  CAPTURE(around.length);
  CHECK(std::abs(around.side) > 8.0);
}

TEST_CASE("mirrored world and hand give the mirrored run") {
  const std::vector<Disc> discs = {{{3.0, 0.4}, 0.7}, {{5.5, -0.5}, 0.9}}, mirrored = {{{3.0, -0.4}, 0.7}, {{5.5, 0.5}, 0.9}};
  for (const char* name : {"bug1", "bug2"}) {
    const Run run = drive(discs, to(9.0, 0.0, name, "left")), mirror = drive(mirrored, to(9.0, 0.0, name, "right"));
    CHECK(run.last.outcome == mirror.last.outcome);
    CHECK(run.length == doctest::Approx(mirror.length).epsilon(0.03));
  }
}

TEST_CASE("a planner that lacks what it needs says what") {
  PlannerSpec spec;
  auto none = make_planner(spec, {}, {});
  REQUIRE_FALSE(none);
  CHECK(none.error().message.find("lacks a goal") != std::string::npos);
  spec.name = "waypoints";
  auto points = make_planner(spec, {}, {});
  REQUIRE_FALSE(points);
  CHECK(points.error().message.find("waypoints_m") != std::string::npos);
  spec.name = "bgu2";
  CHECK(make_planner(spec, {}, {}).error().message.find("did you mean 'bug2'") != std::string::npos);
}

TEST_CASE("a turn on the spot is the loop of a cell for a robot that was never outside of it, and no loop for one that came from far away") {
  for (const bool from_afar : {false, true}) {
    CAPTURE(from_afar);
    BoundaryWalk walk({{0.3, 0.0}, 0.5 * pi}, {9.0, 0.0}, 0.05, 1.0, 0.0, from_afar ? glm::dvec2(-3.0, 0.0) : glm::dvec2(0.0, 0.0));
    for (int i = 1; i <= 80; ++i) {
      const double angle = 2.0 * pi * i / 60.0;
      walk.advance({{0.3 * std::cos(angle), 0.3 * std::sin(angle)}, wrap_angle(angle + 0.5 * pi)});
    }
    CHECK(walk.closed() != from_afar);
  }
}

TEST_CASE("a boundary walk closes only after a turn of 2 pi, and not at the far side of a corridor") {
  BoundaryWalk circle({{1.0, 0.0}, 0.5 * pi}, {5.0, 0.0}, 0.1, 1.0, 0.0, {1.0, 0.0});
  double closed_at = 0.0;
  for (int i = 1; i <= 1000 && !circle.closed(); ++i) {
    const double a = 0.01 * i;
    circle.advance({direction(a), wrap_angle(a + 0.5 * pi)});
    closed_at = a;
  }
  CHECK(circle.closed());
  CHECK(closed_at > 2.0 * pi - 0.1);
  CHECK(closed_at < 2.0 * pi + 1.0);
  CHECK(circle.loop_length() == doctest::Approx(2.0 * pi).epsilon(0.05));

  BoundaryWalk corridor({{0.0, 0.0}, 0.0}, {5.0, 5.0}, 0.1, 1.0, 0.0, {0.0, 0.0});
  for (int i = 1; i <= 100; ++i) corridor.advance({{0.05 * i, 0.0}, 0.0});
  for (int i = 1; i <= 100; ++i) corridor.advance({{5.0 - 0.05 * i, 0.05}, pi});  // back along the other side, 5 cm away
  CHECK_FALSE(corridor.closed());
}

}  // namespace thicket

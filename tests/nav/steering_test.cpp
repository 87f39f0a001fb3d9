#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/nav/bumper.hpp"
#include "thicket/nav/steering.hpp"

namespace thicket {
namespace {

ContourPoint at(double x, double y) { return {{x, y}, std::hypot(x, y), std::atan2(y, x)}; }
ContourPoint silent(double bearing) { return {{0.0, 0.0}, std::numeric_limits<double>::infinity(), bearing}; }

}  // namespace

TEST_CASE("a post on the left lets the robot pass along the tangent of its grown disc") {
  const Contour contour = {at(0.0, 1.0)};
  const Steering steering(contour, 1.0, 0.3);
  const auto edge = steering.sweep(0.5 * pi, -1);  // from the post clockwise
  REQUIRE(edge);
  CHECK(edge->heading == doctest::Approx(0.0).epsilon(1e-9));
  REQUIRE(edge->point);
  CHECK(*edge->point == 0);
  const auto other = steering.sweep(0.5 * pi, +1);
  REQUIRE(other);
  CHECK(std::abs(wrap_angle(other->heading - pi)) < 1e-9);
}

TEST_CASE("farther away the tangent turns toward the post") {
  const Contour contour = {at(0.0, 1.02)};
  const auto edge = Steering(contour, 1.0, 0.3).sweep(0.5 * pi, -1);
  REQUIRE(edge);
  CHECK(edge->heading == doctest::Approx(0.5 * pi - std::asin(1.0 / 1.02)));
}

TEST_CASE("a gap wider than the grown robot is open, a narrower one is a wall") {
  const double look_ahead = 0.6;
  for (const auto& [gap, open] : {std::pair{2.04, true}, std::pair{1.96, false}}) {
    const Contour contour = {at(0.4, 0.5 * gap), at(0.4, -0.5 * gap)};
    const Steering steering(contour, 1.0, look_ahead);
    const auto edge = steering.sweep(std::atan2(0.5 * gap, 0.4), -1);
    REQUIRE(edge);
    CAPTURE(gap);
    CHECK((std::abs(edge->heading) < radians(45.0)) == open);
  }
}

TEST_CASE("no heading is open between points on all sides") {
  Contour contour;
  for (int i = 0; i < 12; ++i) contour.push_back(at(0.9 * std::cos(i * pi / 6), 0.9 * std::sin(i * pi / 6)));
  CHECK_FALSE(Steering(contour, 1.0, 0.3).sweep(0.0, 1));
}

TEST_CASE("an open heading is found at once, with the width of the opening") {
  const Contour contour = {at(-1.0, 0.0)};
  const auto edge = Steering(contour, 1.0, 0.3).sweep(0.0, 1);
  REQUIRE(edge);
  CHECK(edge->heading == 0.0);
  CHECK_FALSE(edge->point);
  CHECK(edge->open == doctest::Approx(0.5 * pi));
}

TEST_CASE("the free way ends where a disc is entered, is unlimited beside it, and zero toward what is too near") {
  const Contour contour = {at(3.0, 0.6)};
  const Steering steering(contour, 1.0, 0.3);
  const auto way = steering.free_way(0.0, 1.0, 10.0);
  CHECK(way.distance == doctest::Approx(3.0 - 0.8));
  CHECK(way.point);
  CHECK(steering.free_way(radians(-30.0), 1.0, 10.0).distance == 10.0);
  const Contour near = {at(0.5, 0.0)};
  CHECK(Steering(near, 1.0, 0.3).free_way(0.0, 1.0, 10.0).distance == 0.0);
  CHECK(Steering(near, 1.0, 0.3).free_way(pi, 1.0, 10.0).distance == 10.0);
}

TEST_CASE("bumpers: sectors are centred, distances are from the hull, release has hysteresis") {
  BumperSpec spec;
  BumperRing ring(spec, 0.3, 1.0);
  REQUIRE(ring.bumpers().size() == 8);
  CHECK(ring.bumpers()[2].centre == doctest::Approx(0.5 * pi));
  CHECK_FALSE(ring.any_pressed());
  ring.read({at(0.0, 1.25)});
  CHECK(ring.bumpers()[2].pressed);
  CHECK(ring.bumpers()[2].distance == doctest::Approx(0.95));
  CHECK(ring.bumpers()[2].bearing == doctest::Approx(0.5 * pi));
  CHECK_FALSE(ring.bumpers()[1].pressed);
  CHECK(ring.nearest() == doctest::Approx(0.95));
  ring.read({at(0.0, 1.35)});  // 1.05: beyond pressing, not yet released
  CHECK(ring.bumpers()[2].pressed);
  ring.read({at(0.0, 1.45)});
  CHECK_FALSE(ring.bumpers()[2].pressed);
}

TEST_CASE("bumpers: the rule `all` misses a post that the rule `any` feels") {
  const Contour post = {at(1.0, 0.0), silent(0.1), silent(-0.1)};
  BumperSpec any, all;
  all.rule = "all";
  BumperRing any_ring(any, 0.3, 1.0), all_ring(all, 0.3, 1.0);
  any_ring.read(post);
  all_ring.read(post);
  CHECK(any_ring.bumpers()[0].pressed);
  CHECK_FALSE(all_ring.bumpers()[0].pressed);
  all_ring.read({at(1.0, 0.0), at(1.0, 0.1)});
  CHECK(all_ring.bumpers()[0].pressed);
}

}  // namespace thicket

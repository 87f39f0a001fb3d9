// What a robot with gaps between its lobes has seen lately.
#include "unseen.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr double keep = 0.45, look_ahead = 0.2, hull = 0.15, half_width = 0.3;

/// Beams 2 degrees apart over `opening_deg` about each of the given directions; they meet what `range` (of the bearing in degrees) says.
template <class Range>
Contour lobes(std::initializer_list<double> yaws, double opening_deg, Range&& range) {
  Contour contour;
  for (const double yaw : yaws) {
    for (double off = -0.5 * opening_deg; off <= 0.5 * opening_deg; off += 0.5 * opening_deg / 16.0) {
      const double at = wrap_angle(radians(yaw + off)), r = range(yaw + off);
      contour.push_back(std::isfinite(r) ? ContourPoint{r * direction(at), r, at} : ContourPoint{{0.0, 0.0}, r, at});
    }
  }
  return contour;
}
Contour four_lobes() {
  return lobes({0.0, 90.0, 180.0, 270.0}, 65.0, [](double) { return std::numeric_limits<double>::infinity(); });
}
Unseen fresh() { return {2.0 * keep + look_ahead, keep / 6.0, 10.0}; }
std::optional<double> turn(const Unseen& unseen, double heading_deg) { return unseen.turn_to_see(radians(heading_deg), half_width, hull, look_ahead); }

}  // namespace

TEST_CASE("a robot that sees all around has nothing to look for") {
  Unseen unseen = fresh();
  unseen.look(lobes({0.0}, 360.0, [](double) { return 3.0; }), {}, 0.0);
  CHECK_FALSE(unseen.has_gaps());
  for (double heading = -180.0; heading < 180.0; heading += 30.0) CHECK(unseen.seen(radians(heading), half_width, hull, look_ahead));
}

TEST_CASE("before the first contour everything is unseen, and blind robots see nothing") {
  Unseen unseen = fresh();
  CHECK_FALSE(unseen.seen(0.0, half_width, hull, look_ahead));
  unseen.look({}, {}, 0.0);
  CHECK_FALSE(unseen.seen(0.0, half_width, hull, look_ahead));
}

TEST_CASE("a way into a gap is not seen until the robot has turned, and it turns the shorter way") {
  Unseen unseen = fresh();
  Pose2 pose;
  unseen.look(four_lobes(), pose, 0.0);
  CHECK(unseen.coverage().gaps().size() == 4);
  for (const double heading : {45.0, 135.0, -45.0, -135.0}) CHECK_FALSE(unseen.seen(radians(heading), half_width, hull, look_ahead));
  // A thin way along the middle of a lobe needs no look.
  CHECK(unseen.seen(0.0, 0.05, hull, 0.6));
  CHECK_FALSE(unseen.seen(radians(45.0), 0.05, hull, 0.6));
  // Asked again and again while it turns, it keeps its direction until all is seen.
  double time = 0.0;
  int changes = 0;
  std::optional<double> before;
  while (const auto left = turn(unseen, degrees(-pose.yaw))) {
    REQUIRE(time < 20.0);
    changes += before && *before * *left < 0.0;
    before = left;
    pose.yaw = wrap_angle(pose.yaw + std::copysign(std::min(std::abs(*left), radians(3.0)), *left));
    time += 0.1;
    unseen.look(four_lobes(), pose, time);
  }
  CHECK(time > 0.5);
  CHECK(changes <= 1);  // one gap to the left, one to the right
  CHECK(std::abs(pose.yaw) < radians(30.0));
}

TEST_CASE("what was seen counts while the robot drives past it, and not for ever") {
  Unseen unseen = fresh();
  for (int i = 0; i <= 30; ++i) unseen.look(four_lobes(), {{0.0, 0.0}, radians(-45.0 + 3.0 * i)}, 0.1 * i);
  unseen.look(four_lobes(), {}, 3.1);
  CHECK(unseen.seen(0.0, half_width, hull, look_ahead));
  CHECK(unseen.seen(radians(45.0), half_width, hull, look_ahead));
  // Straight ahead the front lobe has seen what comes into the gaps.
  for (int i = 1; i <= 20; ++i) {
    unseen.look(four_lobes(), {{0.05 * i, 0.0}, 0.0}, 3.1 + 0.1 * i);
    CAPTURE(i);
    CHECK(unseen.seen(0.0, half_width, hull, look_ahead));
  }
  Unseen later = fresh();
  for (int i = 0; i <= 30; ++i) later.look(four_lobes(), {{0.0, 0.0}, radians(-45.0 + 3.0 * i)}, 0.1 * i);
  later.look(four_lobes(), {}, 12.0);
  CHECK(later.seen(radians(45.0), half_width, hull, look_ahead));
  later.look(four_lobes(), {}, 14.0);
  CHECK(later.seen(radians(20.0), 0.05, hull, look_ahead));
  CHECK_FALSE(later.seen(radians(45.0), half_width, hull, look_ahead));
}

TEST_CASE("matter that comes into a gap is remembered, and forgotten where a beam goes on behind it") {
  Unseen unseen = fresh();
  const auto post = [](double degree) { return std::abs(degree - 20.0) < 3.0 ? 0.8 : std::numeric_limits<double>::infinity(); };
  unseen.look(lobes({0.0, 90.0, 180.0, 270.0}, 65.0, post), {}, 0.0);
  Contour now;
  unseen.complete(now);
  CHECK(now.empty());  // it is in view
  const Pose2 turned{{0.0, 0.0}, radians(-25.0)};  // the post is at 45 degrees now
  unseen.look(four_lobes(), turned, 0.1);
  unseen.complete(now);
  REQUIRE_FALSE(now.empty());
  for (const ContourPoint& point : now) {
    CHECK(point.distance == doctest::Approx(0.8).epsilon(0.01));
    CHECK(std::abs(point.bearing - radians(45.0)) < radians(4.0));
    CHECK(point.arc != no_arc);
  }
  // In view again, and nothing there: it has gone.
  unseen.look(four_lobes(), {}, 0.2);
  unseen.look(four_lobes(), turned, 0.3);
  now.clear();
  unseen.complete(now);
  CHECK(now.empty());
}

TEST_CASE("memory moves with the robot's own odometry, at any place of the plane") {
  for (const glm::dvec2 place : {glm::dvec2(0.0), glm::dvec2(-1234.5, 987.25)}) {
    Unseen unseen = fresh();
    const auto wall = [](double degree) { return degree > -30.0 && degree < 30.0 ? 0.9 / std::cos(radians(degree)) : std::numeric_limits<double>::infinity(); };
    unseen.look(lobes({0.0, 90.0, 180.0, 270.0}, 65.0, wall), {place, 0.0}, 0.0);
    unseen.look(four_lobes(), {place + glm::dvec2(0.2, 0.1), radians(45.0)}, 0.5);
    Contour now;
    unseen.complete(now);
    REQUIRE_FALSE(now.empty());
    for (const ContourPoint& point : now) {
      // The wall is 0.9 m east of where the robot was.
      CHECK(point.position.x * std::cos(radians(45.0)) - point.position.y * std::sin(radians(45.0)) == doctest::Approx(0.7).epsilon(0.01));
      CHECK(glm::length(point.position) == doctest::Approx(point.distance));
    }
  }
}

}  // namespace thicket

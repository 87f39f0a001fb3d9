#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/sim/vehicle.hpp"

namespace thicket {

TEST_CASE("an arc ends on its circle, a straight line is its limit") {
  const Arc quarter{{{1.0, 2.0}, 0.0}, 0.5 * pi, 0.5 * pi};  // radius 1, a quarter turn a second
  const Pose2 end = quarter.at(1.0);
  CHECK(end.position.x == doctest::Approx(2.0).epsilon(1e-14));
  CHECK(end.position.y == doctest::Approx(3.0).epsilon(1e-14));
  CHECK(end.yaw == doctest::Approx(0.5 * pi));
  const Pose2 straight = Arc{{{0.0, 0.0}, 0.3}, 2.0, 0.0}.at(3.0), nearly = Arc{{{0.0, 0.0}, 0.3}, 2.0, 1e-10}.at(3.0);
  CHECK(straight.position.x == doctest::Approx(6.0 * std::cos(0.3)).epsilon(1e-15));
  CHECK(glm::distance(straight.position, nearly.position) < 1e-8);
}

TEST_CASE("an arc in one piece is the arc in a thousand pieces") {
  const double speed = 0.7, turn_rate = 2.4;
  const Pose2 whole = Arc{{{5.0, -3.0}, 1.0}, speed, turn_rate}.at(10.0);
  Pose2 pose{{5.0, -3.0}, 1.0};
  for (int i = 0; i < 1000; ++i) pose = Arc{pose, speed, turn_rate}.at(0.01);
  CHECK(glm::distance(whole.position, pose.position) < 1e-11);
  CHECK(std::abs(wrap_angle(whole.yaw - pose.yaw)) < 1e-11);
}

TEST_CASE("speeds follow the command within the limits of acceleration") {
  VehicleSpec limits;
  limits.acceleration_m_s2 = 0.3;
  limits.deceleration_m_s2 = 0.6;
  limits.turn_acceleration_deg_s2 = 90.0;
  DifferentialDrive drive;
  drive.step({10.0, 10.0}, 0.1, limits);
  CHECK(drive.speed == doctest::Approx(0.03));
  CHECK(drive.turn_rate == doctest::Approx(radians(9.0)));
  for (int i = 0; i < 200; ++i) drive.step({10.0, 10.0}, 0.1, limits);
  CHECK(drive.speed == doctest::Approx(0.7));
  CHECK(drive.turn_rate == doctest::Approx(radians(140.0)));
  drive.step({0.0, 0.0}, 0.1, limits);
  CHECK(drive.speed == doctest::Approx(0.64));
  for (int i = 0; i < 200; ++i) drive.step({0.0, 0.0}, 0.1, limits);
  CHECK(drive.speed == 0.0);
  CHECK(drive.turn_rate == 0.0);
}

}  // namespace thicket

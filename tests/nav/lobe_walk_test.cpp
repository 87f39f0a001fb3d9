// A planner on four lobes of 65 degrees, with 25 degrees between them that nothing sees, in a world of discs.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/nav/planner.hpp"

namespace thicket {
namespace {

struct Disc {
  glm::dvec2 centre{0.0};
  double radius = 1.0;
};

/// What a lobe tells: the distance of the nearest matter in its opening.
Scan lobe(const std::vector<Disc>& discs, const Pose2& pose, double yaw) {
  Scan scan;
  scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, yaw).orientation;
  scan.azimuth_opening = radians(65.0);
  Beam beam;
  double nearest = std::numeric_limits<double>::infinity();
  for (double off = -32.5; off <= 32.5; off += 0.5) {
    const glm::dvec2 along = direction(pose.yaw + yaw + radians(off));
    for (const Disc& disc : discs) {
      const glm::dvec2 to = disc.centre - pose.position;
      const double middle = glm::dot(to, along), half = disc.radius * disc.radius - (glm::dot(to, to) - middle * middle);
      if (half > 0.0 && middle - std::sqrt(half) > 0.0) nearest = std::min(nearest, middle - std::sqrt(half));
    }
  }
  if (nearest < 10.0) {
    beam.echo_count = 1;
    scan.echoes.push_back({nearest});
  }
  scan.beams.push_back(beam);
  return scan;
}

struct Run {
  Decision last;
  double least = 1e9;  ///< between hull and matter, m
};

Run drive(const std::vector<Disc>& discs, const PlannerSpec& spec) {
  VehicleLimits vehicle;
  vehicle.hull_radius = 0.15;
  vehicle.speed = 0.5;
  vehicle.turn_rate = 3.0;
  vehicle.deceleration = 0.5;
  vehicle.turn_acceleration = 6.0;
  Pose2 pose;
  auto planner = make_planner(spec, vehicle, pose);
  REQUIRE(planner);
  BumperRing bumpers(BumperSpec{}, vehicle.hull_radius, press_distance(BumperSpec{}, spec, vehicle));
  std::array<ContourReader, 4> readers;
  Contour contour;
  Run run;
  double speed = 0.0, turn_rate = 0.0;
  for (int step = 0; step < 4000; ++step) {
    contour.clear();
    for (std::size_t i = 0; i < 4; ++i) readers[i].add(lobe(discs, pose, 0.5 * pi * static_cast<double>(i)), contour);
    bumpers.read(contour);
    run.last = (*planner)->decide({0.1 * step, pose, speed, turn_rate, contour, bumpers});
    if (run.last.outcome != Outcome::running) break;
    speed = std::clamp(run.last.command.speed, speed - 0.05, speed + 0.05);
    turn_rate = std::clamp(run.last.command.turn_rate, turn_rate - 0.6, turn_rate + 0.6);
    pose.yaw = wrap_angle(pose.yaw + 0.1 * turn_rate);
    pose.position += 0.1 * speed * direction(pose.yaw);
    for (const Disc& disc : discs) run.least = std::min(run.least, glm::distance(disc.centre, pose.position) - disc.radius - vehicle.hull_radius);
  }
  return run;
}

}  // namespace

namespace {

PlannerSpec over_there(const char* hand) {
  PlannerSpec spec;
  spec.name = "bug2";
  spec.goal_m = glm::dvec2(5.0, 0.0);
  spec.hand = hand;
  spec.clearance_m = 0.3;
  return spec;
}

void check_reached(const std::vector<Disc>& discs) {
  for (const char* hand : {"left", "right"}) {
    const Run run = drive(discs, over_there(hand));
    CAPTURE(hand);
    CAPTURE(run.last.state);
    CAPTURE(run.last.reason);
    CHECK(run.last.outcome == Outcome::reached);
    CHECK(run.least > 0.2);
  }
}

}  // namespace

TEST_CASE("four lobes: straight, around a disc and around a wall to the goal") {
  check_reached({});
  check_reached({{{2.5, 0.1}, 0.8}});
  std::vector<Disc> wall;
  for (double y = -1.0; y <= 1.0; y += 0.1) wall.push_back({{2.0, y}, 0.1});
  check_reached(wall);
}

}  // namespace thicket

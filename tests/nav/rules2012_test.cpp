// The rules of 2012 in a world of discs, on bumpers alone.
#include "rules2012.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "pilot.hpp"

namespace thicket {
namespace {

struct Disc {
  glm::dvec2 centre{0.0};
  double radius = 1.0;
};

constexpr double hull = 0.2, clearance = 0.4, press = clearance + 0.5;

Contour see(const std::vector<Disc>& discs, const Pose2& pose) {
  Contour contour;
  for (int i = 0; i < 360; ++i) {
    const double at = radians(i - 180.0);
    const glm::dvec2 along = direction(pose.yaw + at);
    double range = std::numeric_limits<double>::infinity();
    for (const Disc& disc : discs) {
      const glm::dvec2 to = disc.centre - pose.position;
      const double middle = glm::dot(to, along), half = disc.radius * disc.radius - (glm::dot(to, to) - middle * middle);
      if (half > 0.0 && middle - std::sqrt(half) > 0.0) range = std::min(range, middle - std::sqrt(half));
    }
    contour.push_back({std::isfinite(range) ? range * direction(at) : glm::dvec2(0.0), range, at});
  }
  return contour;
}

/// A wall of small discs from one point to another.
void wall(std::vector<Disc>& discs, const glm::dvec2& from, const glm::dvec2& to) {
  const double length = glm::distance(from, to);
  for (double s = 0.0; s <= length; s += 0.1) discs.push_back({from + s / length * (to - from), 0.1});
}

struct Walk {
  double least = 1e9, farthest = 0.0;  ///< distances between hull and matter, after the first seconds
  double around = 0.0;                 ///< how far it went around the world's origin, rad, > 0 counter-clockwise
  double length = 0.0;
  bool boxed_in = false;
  Pose2 end;
};

VehicleLimits vehicle() {
  VehicleLimits v;
  v.hull_radius = hull;
  v.speed = 0.4;
  v.turn_rate = 2.0;
  v.turn_acceleration = 10.0;
  return v;
}

/// Follows what is there for `seconds`, from a pose where a bumper is pressed.
Walk walk(const std::vector<Disc>& discs, Pose2 pose, Hand hand, int bumpers, double seconds) {
  BumperSpec spec;
  spec.count = bumpers;
  BumperRing ring(spec, hull, press);
  Rules2012 rules(vehicle(), vehicle().speed, clearance);
  rules.begin();
  Walk result;
  Command command;
  for (double time = 0.0; time < seconds; time += 0.1) {
    const Contour contour = see(discs, pose);
    ring.read(contour);
    command = rules.follow({time, pose, command.speed, command.turn_rate, contour, ring}, hand);
    result.boxed_in = result.boxed_in || rules.boxed_in();
    result.least = std::min(result.least, ring.nearest());
    if (time > 5.0) result.farthest = std::max(result.farthest, ring.nearest());
    const glm::dvec2 before = pose.position;
    pose.yaw = wrap_angle(pose.yaw + 0.1 * command.turn_rate);
    pose.position += 0.1 * command.speed * direction(pose.yaw);
    result.around += wrap_angle(bearing(pose.position) - bearing(before));
    result.length += glm::distance(before, pose.position);
  }
  result.end = pose;
  return result;
}

}  // namespace

TEST_CASE("2012: a disc is gone around, on either hand, with four and with eight bumpers, without touching or losing it") {
  for (const int bumpers : {4, 8}) {
    for (const Hand hand : {Hand::left, Hand::right}) {
      const Walk w = walk({{{0.0, 0.0}, 1.5}}, {{-2.5, 0.0}, 0.0}, hand, bumpers, 240.0);
      CAPTURE(bumpers);
      CAPTURE(hand == Hand::left);
      CHECK((hand == Hand::left ? w.around : -w.around) > 2.0 * pi);
      CHECK(w.least > 0.5 * clearance);
      CHECK(w.farthest < press + 0.6);
      CHECK_FALSE(w.boxed_in);
    }
  }
}

TEST_CASE("2012: along the inside of a room, through its corners") {
  std::vector<Disc> room;
  wall(room, {-4.0, -4.0}, {4.0, -4.0});
  wall(room, {4.0, -4.0}, {4.0, 4.0});
  wall(room, {4.0, 4.0}, {-4.0, 4.0});
  wall(room, {-4.0, 4.0}, {-4.0, -4.0});
  for (const int bumpers : {4, 8}) {
    for (const Hand hand : {Hand::left, Hand::right}) {
      const Walk w = walk(room, {{2.9, 0.0}, 0.0}, hand, bumpers, 300.0);
      CAPTURE(bumpers);
      CAPTURE(hand == Hand::left);
      CHECK((hand == Hand::left ? -w.around : w.around) > 2.0 * pi);
      CHECK(w.least > 0.5 * clearance);
    }
  }
}

TEST_CASE("2012: around a box with outer corners") {
  std::vector<Disc> box;
  wall(box, {-1.0, -1.0}, {1.0, -1.0});
  wall(box, {1.0, -1.0}, {1.0, 1.0});
  wall(box, {1.0, 1.0}, {-1.0, 1.0});
  wall(box, {-1.0, 1.0}, {-1.0, -1.0});
  for (const int bumpers : {4, 8}) {
    const Walk w = walk(box, {{-2.0, 0.0}, 0.0}, Hand::left, bumpers, 240.0);
    CAPTURE(bumpers);
    CHECK(w.around > 2.0 * pi);
    CHECK(w.least > 0.4 * clearance);
  }
}

TEST_CASE("2012: mirrored world and hand give the mirrored walk") {
  const std::vector<Disc> discs = {{{0.0, 0.3}, 1.2}, {{1.0, -1.5}, 0.8}}, mirrored = {{{0.0, -0.3}, 1.2}, {{1.0, 1.5}, 0.8}};
  const Walk one = walk(discs, {{-2.0, 0.0}, 0.0}, Hand::left, 8, 60.0), two = walk(mirrored, {{-2.0, 0.0}, 0.0}, Hand::right, 8, 60.0);
  CHECK(one.length == doctest::Approx(two.length).epsilon(0.05));
  CHECK(one.around == doctest::Approx(-two.around).epsilon(0.1));
}

TEST_CASE("2012: shut in on all sides it turns on the spot and says so") {
  std::vector<Disc> pen;
  for (int i = 0; i < 40; ++i) pen.push_back({0.75 * direction(2.0 * pi * i / 40), 0.1});
  const Walk w = walk(pen, {}, Hand::left, 8, 60.0);
  CHECK(w.boxed_in);
  CHECK(w.length < 0.2);
}

TEST_CASE("2012: its states are the text's, in order") {
  BumperRing ring(BumperSpec{}, hull, press);
  Rules2012 rules(vehicle(), 0.4, clearance);
  rules.begin();
  const auto state_with = [&](std::initializer_list<double> degrees_pressed) {
    Contour contour;
    for (int degree = -180; degree < 180; ++degree) contour.push_back({{0.0, 0.0}, std::numeric_limits<double>::infinity(), radians(degree)});
    for (const double degree : degrees_pressed) contour.push_back({0.8 * direction(radians(degree)), 0.8, radians(degree)});
    ring.read(contour);
    static double time = 0.0;
    const Command command = rules.follow({time += 0.1, {}, 0.0, 0.0, contour, ring}, Hand::left);
    return std::pair{std::string(rules.state()), command};
  };
  auto [state, command] = state_with({0.0});
  CHECK(state.find("aligning") != std::string::npos);
  CHECK(command.turn_rate < 0.0);  // the left hand goes to the wall: turn right
  CHECK(command.speed == 0.0);
  std::tie(state, command) = state_with({90.0});
  CHECK(state.find("along") != std::string::npos);
  CHECK(command.speed > 0.0);
  std::tie(state, command) = state_with({});
  CHECK(state.find("toward") != std::string::npos);
  CHECK(command.turn_rate > 0.0);
  std::tie(state, command) = state_with({90.0, 20.0});
  CHECK(state.find("away") != std::string::npos);
  CHECK(command.turn_rate < 0.0);
  std::tie(state, command) = state_with({90.0, 180.0});
  CHECK(state.find("along") != std::string::npos);
}

}  // namespace thicket

// Explorers: they come near most of what is free, keep their distance, and end.
#include <doctest/doctest.h>

#include <string>

#include "disc_world.hpp"

namespace thicket {
namespace {

const LetterMap room{{"####################", "#..................#", "#..................#", "#..................#", "#.....##...........#", "#.....##...........#", "#..S...............#",
                      "#............#.....#", "#............#.....#", "#..................#", "#..................#", "####################"}};
const TestSensor real{180, 5.0, 0.03};

PlannerSpec explorer(const char* name, const char* hand, double metres) {
  PlannerSpec spec;
  spec.name = name;
  spec.hand = hand;
  spec.clearance_m = 0.4;
  spec.explore_m = metres;
  return spec;
}

/// Share of the free cells inside the room whose middle the robot came within 2 m of.
double covered(const LetterMap& map, const Run& run) {
  int free = 0, near = 0;
  for (int y = 1; y + 1 < map.height(); ++y)
    for (int x = 1; x + 1 < map.width(); ++x) {
      if (map.matter(x, y)) continue;
      ++free;
      const glm::dvec2 middle = map.cell * glm::dvec2(x + 0.5, y + 0.5);
      near += std::any_of(run.track.begin(), run.track.end(), [&](const glm::dvec2& p) { return glm::distance(p, middle) <= 2.0; });
    }
  return static_cast<double>(near) / free;
}

}  // namespace

TEST_CASE("the wall first, then the inside: all of a room is covered, on both hands, and it knows when it is done") {
  for (const char* hand : {"left", "right"}) {
    const Run run = drive(TestWorld{{}, room, {}}, explorer("wall_then_inside", hand, 400.0), {room.find('S'), 0.3}, real);
    CAPTURE(hand);
    CHECK(run.last.outcome == Outcome::reached);
    CHECK(run.last.reason.find("the wall and the inside are done") != std::string::npos);
    CHECK(covered(room, run) > 0.9);  // lanes are cut short by what stands in the room, and what is behind it may be missed
    CHECK(count(run.marks, "wall") >= 1);
    CHECK(count(run.marks, "closed") >= 1);
    CHECK(run.length < 250.0);
    CHECK(run.least > 0.25);
  }
}

TEST_CASE("the wall of an island is left for that of the room") {
  const Run run = drive(TestWorld{{}, room, {}}, explorer("wall_then_inside", "left", 400.0), {{3.5, 7.1}, 0.0}, real);  // the block is straight ahead
  CHECK(run.last.outcome == Outcome::reached);
  CHECK(count(run.marks, "wall") >= 2);
  CHECK(covered(room, run) > 0.9);
}

TEST_CASE("bouncing ends after the distance to explore, has covered most of a room by then, and is the same each time") {
  const auto bounce = [&] { return drive(TestWorld{{}, room, {}}, explorer("bounce", "left", 200.0), {room.find('S'), 0.3}, real); };
  const Run run = bounce(), again = bounce();
  CHECK(run.last.outcome == Outcome::reached);
  CHECK(run.last.reason.find("200") != std::string::npos);
  CHECK(run.length == doctest::Approx(200.0).epsilon(0.01));
  CHECK(covered(room, run) > 0.9);
  CHECK(count(run.marks, "bounce") > 10);
  CHECK(run.least > 0.25);
  CHECK(again.track == run.track);
}

TEST_CASE("from the centre outward: a square spiral in the open, arm by arm, and the end of it in a room") {
  const Run run = drive(TestWorld{}, explorer("center_out", "left", 80.0), {{0.0, 0.0}, 0.0});
  CHECK(run.last.outcome == Outcome::reached);
  // 2 + 2 + 4 + 4 + 6 + 6 + 8 + 8 + 10 + 10 = 60 m for ten arms, 12 for the next
  CHECK(count(run.marks, "arm") >= 12);
  for (const glm::dvec2& p : run.track) CHECK(std::max(std::abs(p.x), std::abs(p.y)) < 8.5);
  LetterMap square{std::vector<std::string>(10, std::string(10, '.'))};
  const Run same = drive(TestWorld{{}, square, {}}, explorer("center_out", "left", 80.0), {{5.01, 5.02}, 0.0});
  CHECK(covered(square, same) == 1.0);

  const Run inside = drive(TestWorld{{}, room, {}}, explorer("center_out", "left", 1000.0), {{10.1, 6.1}, 0.0}, real);
  CHECK(inside.last.outcome == Outcome::reached);
  CHECK(inside.last.reason.find("every arm of the spiral is blocked") != std::string::npos);
  CHECK(covered(room, inside) > 0.85);  // a spiral is not for rooms
  CHECK(inside.least > 0.25);
}

TEST_CASE("explore chooses by what it sees at the start") {
  const auto state = [](const TestWorld& world, const Pose2& start, const TestSensor& sensor) {
    return drive(world, explorer("explore", "left", 1000.0), start, sensor, 1).last.state;
  };
  CHECK(state({{}, room, {}}, {{10.1, 6.1}, 0.0}, {180, 30.0, 0.03}).starts_with("wall_then_inside: "));
  CHECK(state({{}, room, {}}, {{4.1, 6.1}, 0.0}, real).starts_with("bounce: "));
  CHECK(state({}, {}, real).starts_with("center_out: "));
}

TEST_CASE("what a planner needs is known by its name") {
  CHECK(planner_needs("tangent_bug") == PlannerNeeds::goal);
  CHECK(planner_needs("waypoints") == PlannerNeeds::waypoints);
  CHECK(planner_needs("explore") == PlannerNeeds::nothing);
  for (const std::string& name : planner_names()) {
    PlannerSpec spec;
    spec.name = name;
    const auto without = make_planner(spec, test_vehicle(), {});
    CHECK(static_cast<bool>(without) == (planner_needs(name) == PlannerNeeds::nothing));
    spec.goal_m = glm::dvec2(1.0, 0.0);
    spec.waypoints_m = {{1.0, 0.0}};
    const auto with = make_planner(spec, test_vehicle(), {});
    REQUIRE(with);
    CHECK((*with)->clone()->marks().size() == (*with)->marks().size());
  }
}

}  // namespace thicket

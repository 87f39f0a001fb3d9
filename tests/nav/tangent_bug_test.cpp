// TangentBug, with the sensor of a real robot: 180 rays of 5 m, with noise.
#include <doctest/doctest.h>

#include "disc_world.hpp"
#include "far_view.hpp"

namespace thicket {
namespace {

const TestSensor real{180, 5.0, 0.03};

const LetterMap long_wall{{"............................", "..............#.............", "..............#.............", "..............#.............", "..............#.............",
                           "S.............#............T", "..............#.............", "..............#.............", "............................"}};
const LetterMap u_trap{{"......................", "......##########......", "...............#......", "...............#......", "S..............#.....T",
                        "...............#......", "...............#......", "........########......", "......................"}};
const LetterMap enclosed{{".....................", "...........########..", "...........#......#..", "S..........#...T..#..", "...........#......#..", "...........########..", "....................."}};

}  // namespace

TEST_CASE("TangentBug passes a long wall by its nearer end without touching it, Bug2 walks along it") {
  for (const LetterMap& map : {long_wall, long_wall.mirrored()})
    for (const char* hand : {"left", "right"}) {
      CAPTURE(hand);
      const Run tangent = drive(map, "tangent_bug", hand, real), bug2 = drive(map, "bug2", hand, real);
      CHECK(tangent.last.outcome == Outcome::reached);
      CHECK(bug2.last.outcome == Outcome::reached);
      CHECK(tangent.length < 0.97 * bug2.length);
      CHECK(tangent.length < 1.15 * shortest(map, 0.6));
      CHECK(tangent.least > 0.3);
    }
}

TEST_CASE("TangentBug goes straight past a disc along its tangent") {
  for (const double off : {0.5, -0.5}) {
    const Run run = drive({Disc{{5.0, off}, 1.0}}, to(10.0, 0.0, "tangent_bug", "left"));
    CHECK(run.last.outcome == Outcome::reached);
    CHECK(run.length < 10.6);
    CHECK(run.side * off < 0.0);  // on the short side, whatever the hand
    CHECK(count(run.marks, "hit") == 0);
  }
}

TEST_CASE("TangentBug gets out of a U and does not go back into it") {
  for (const LetterMap& map : {u_trap, u_trap.mirrored()})
    for (const char* hand : {"left", "right"}) {
      const Run run = drive(map, "tangent_bug", hand, real);
      CAPTURE(hand);
      CHECK(run.last.outcome == Outcome::reached);
      CHECK(run.length < 3.0 * shortest(map, 0.6));
      CHECK(count(run.marks, "hit") >= 1);
      CHECK(count(run.marks, "hit") <= 4);
      CHECK(count(run.marks, "reach") >= 1);
      CHECK(count(run.marks, "hit") == count(run.marks, "leave"));
      CHECK(run.least > 0.25);
    }
}

TEST_CASE("TangentBug gets out where what it saw free far away was not: poles that stand closer than it is wide") {
  // From the bottom of the U the goal is in sight between the poles of a fence, far away and through gaps that are open in one scan and not in the next.
  const LetterMap fence{{".........................", "...............#.........", ".....................#...", "...............#.........", ".....................#...", "S..............#........T",
                         ".....................#...", "...............#.........", ".....................#...", "...............#.........", "........................."}};
  for (const LetterMap& map : {fence, fence.mirrored()})
    for (const char* hand : {"left", "right"}) {
      const Run run = drive(map, "tangent_bug", hand, real);
      CAPTURE(hand);
      CHECK(run.last.outcome == Outcome::reached);
      CHECK(run.length < 2.0 * shortest(map, 0.6));
      CHECK(run.least > 0.25);
    }
}

TEST_CASE("TangentBug does not slide into the band along a wall for a goal that lies in it") {
  // The goal is 0.35 m off the wall, beside its corner, the robot keeps 0.6 m.
  const LetterMap wall{{"............", "............", "S...........", "............", "............", ".....#####..", ".....#####..", ".....#####..", "............"}};
  for (const bool mirrored : {false, true})
    for (const char* hand : {"left", "right"}) {
      const LetterMap map = mirrored ? wall.mirrored() : wall;
      const glm::dvec2 start = map.find('S'), goal(4.65, mirrored ? 5.5 : 3.5);
      const Run run = drive(TestWorld{{}, map, {}}, to(goal.x, goal.y, "tangent_bug", hand), {start, bearing(goal - start)}, real);
      CAPTURE(hand);
      CHECK(run.last.outcome == Outcome::unreachable);
      CHECK(run.least > 0.25);
    }
}

TEST_CASE("TangentBug says that an enclosed goal is unreachable, after a loop") {
  for (const char* hand : {"left", "right"}) {
    const Run run = drive(enclosed, "tangent_bug", hand, real);
    CHECK(run.last.outcome == Outcome::unreachable);
    CHECK(run.last.reason.find("the whole boundary was walked") != std::string::npos);
    CHECK(run.length > 24.0);
    CHECK(run.length < 10.0 + 3.0 * 30.0);
  }
}

TEST_CASE("a FarView sees the end of a wall, joins what the robot cannot pass, and trusts no beam farther than it ever saw") {
  FarView view(0.6);
  Contour contour;
  const auto look = [&](const std::vector<Disc>& discs, double range) {
    see({discs, {}, {}}, {{1.0, 0.0}, 0.5}, {180, range, 0.0}, 0, contour);
    view.look({{1.0, 0.0}, 0.5}, contour);
  };
  look({{{6.0, 0.0}, 1.0}}, 5.0);
  CHECK(view.sight() == doctest::Approx(4.5).epsilon(0.12));
  CHECK(view.free_toward({20.0, 0.0}) == doctest::Approx(5.0 - 1.6).epsilon(0.02));
  CHECK_FALSE(view.is_free({20.0, 0.0}));
  CHECK(view.is_free({1.0, 20.0}));
  CHECK(view.free_toward({1.0, 20.0}) == doctest::Approx(view.sight()));
  const auto left = view.tangent({20.0, 0.0}, +1), right = view.tangent({20.0, 0.0}, -1);
  REQUIRE(left);
  REQUIRE(right);
  CHECK(left->heading == doctest::Approx(-right->heading).epsilon(0.1));
  CHECK(left->heading == doctest::Approx(std::asin(1.66 / 5.0)).epsilon(0.1));
  const auto place = view.place_nearer({20.0, 0.0}, 18.0);
  REQUIRE(place);
  CHECK(place->distance < 19.0 - 3.5);
  CHECK(glm::distance(place->at, glm::dvec2(20.0, 0.0)) == doctest::Approx(place->distance));
  CHECK_FALSE(view.place_nearer({20.0, 0.0}, place->distance));      // none is nearer than the nearest
  CHECK_FALSE(view.place_nearer({20.0, 0.0}, 19.0 - view.sight()));  // nor any out of sight
  // two thin poles, 1 m apart, with 1.2 m needed: the way between them ends at a wall
  look({{{4.0, 0.5}, 0.08}, {{4.0, -0.5}, 0.08}}, 5.0);
  CHECK(view.free_toward({9.0, 0.0}) < 2.8);
}

}  // namespace thicket

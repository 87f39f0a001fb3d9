// The planners that are told apart by their rule for leaving a boundary: each reaches, gives up, hits and leaves as its rule says.
#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "disc_world.hpp"
#include "m_line.hpp"

namespace thicket {
namespace {

const TestSensor real{180, 5.0, 0.03};
const std::vector<const char*> complete = {"bug1", "bug2", "tangent_bug", "alg1", "alg2", "dist_bug", "i_bug"};

const LetterMap block{{"..................", "........###.......", "S.......###......T", "........###.......", ".................."}};
const LetterMap two{{"......................", "......##..............", "......##......##......", "S.....##......##.....T", "..............##......", "......................"}};
// With the right hand: north over the first wall, off it on the M-line, and from the second wall north, around the room and over the first wall again.
const LetterMap baffles{{"####################", "#............#.....#", "#............#.....#", "#............#.....#", "#.S...#......#...T.#", "#.....#......#.....#", "#.....#............#",
                         "#.....#............#", "#.....#............#", "####################"}};
// With the right hand the robot comes out where it went in, and past the hit point.
const LetterMap coil{{"..................", "..#############...", "..#...........#...", "..#...........#...", "..#...#####...#...", "..#...#...#...#...", "S.#...#.T.#...#...", "..#...#...#...#...",
                      "..#.......#...#...", "..#.......#...#...", "..#########...#...", ".................."}};
const LetterMap enclosed{{"...................", "..........#######..", "..........#.....#..", "S.........#..T..#..", "..........#.....#..", "..........#######..", "..................."}};
const LetterMap shut_in{{"................", ".#######........", ".#.....#........", ".#..S..#......T.", ".#.....#........", ".#######........", "................"}};

}  // namespace

TEST_CASE("every complete planner reaches the goal behind one block and behind two, on both hands, mirrored too") {
  for (const char* name : complete)
    for (const LetterMap& map : {block, two, block.mirrored(), two.mirrored()})
      for (const char* hand : {"left", "right"}) {
        CAPTURE(name);
        CAPTURE(hand);
        const Run run = drive(map, name, hand, real);
        CHECK(run.last.outcome == Outcome::reached);
        CHECK(run.least > 0.25);
        CHECK(count(run.marks, "hit") == count(run.marks, "leave"));
        CHECK(run.length < (std::string(name) == "bug1" ? 4.0 : 1.8) * shortest(map, 0.6));
      }
}

TEST_CASE("every complete planner says that an enclosed goal and a start shut in are unreachable, with evidence") {
  for (const char* name : complete)
    for (const LetterMap& map : {enclosed, shut_in})
      for (const char* hand : {"left", "right"}) {
        CAPTURE(name);
        CAPTURE(hand);
        const Run run = drive(map, name, hand, real);
        CHECK(run.last.outcome == Outcome::unreachable);
        CHECK(run.last.reason.find("the boundary hit at") != std::string::npos);
        CHECK(run.length < 110.0);
      }
}

TEST_CASE("turned and shifted worlds give the same verdict and length, mirrored ones with the other hand too") {
  const Pose2 elsewhere{{-120.0, 45.0}, 2.3};
  for (const char* name : {"bug1", "bug2", "bug2_2012", "tangent_bug", "alg1", "alg2", "com", "i_bug", "dist_bug"}) {
    const Run run = drive(two, name, "left"), turned = drive(two, name, "left", {}, elsewhere), mirrored = drive(two.mirrored(), name, "right");
    CAPTURE(name);
    CHECK(run.last.outcome == Outcome::reached);
    CHECK(turned.last.outcome == run.last.outcome);
    CHECK(mirrored.last.outcome == run.last.outcome);
    CHECK(turned.length == doctest::Approx(run.length).epsilon(0.04));
    CHECK(mirrored.length == doctest::Approx(run.length).epsilon(0.04));
  }
}

TEST_CASE("the rule of 2012 gives up where Bug2 reaches") {
  int wrong = 0;
  for (const char* hand : {"left", "right"}) {
    CAPTURE(hand);
    CHECK(drive(baffles, "bug2", hand).last.outcome == Outcome::reached);
    const Run run = drive(baffles, "bug2_2012", hand);
    if (run.last.outcome != Outcome::unreachable) continue;
    ++wrong;
    CHECK(run.last.reason.find("rule of 2012") != std::string::npos);
  }
  CHECK(wrong >= 1);
  for (const char* hand : {"left", "right"}) {  // and where nothing crosses behind the hit, it is Bug2
    const Run bug2 = drive(block, "bug2", hand), of_2012 = drive(block, "bug2_2012", hand);
    CHECK(of_2012.last.outcome == Outcome::reached);
    CHECK(of_2012.length == doctest::Approx(bug2.length));
    CHECK(drive(enclosed, "bug2_2012", hand).last.outcome == Outcome::unreachable);
  }
}

TEST_CASE("Com reaches in a simple world and leaves as soon as the way is open: before Bug2 does") {
  for (const char* hand : {"left", "right"}) {
    const Run com = drive(block, "com", hand), bug2 = drive(block, "bug2", hand);
    CHECK(com.last.outcome == Outcome::reached);
    CHECK(com.length < bug2.length - 0.5);
    CHECK(drive(enclosed, "com", hand, {}, {}, 6000).last.outcome != Outcome::reached);
  }
}

TEST_CASE("Com goes round for ever where I-Bug, which remembers one number, gets out") {
  const LetterMap hook{{"......................", "...###############....", "...#.............#....", "...#.............#....", "...#......S......#...T", "...#.............#....",
                        "...#.............#....", "...#...###########....", "......................"}};
  int for_ever = 0;
  for (const LetterMap& map : {hook, hook.mirrored()})
    for (const char* hand : {"left", "right"}) {
      CAPTURE(hand);
      const Run com = drive(map, "com", hand, {}, {}, 20000), i_bug = drive(map, "i_bug", hand, {}, {}, 6000);
      if (com.last.outcome == Outcome::stuck) {
        ++for_ever;
        CHECK(com.last.reason.find("goes round for ever") != std::string::npos);
        CHECK(count(com.marks, "hit") >= 4);
        CHECK(count(com.marks, "hit") <= 12);
      }
      CHECK(com.last.outcome != Outcome::running);
      CHECK(i_bug.last.outcome == Outcome::reached);
    }
  CHECK(for_ever >= 2);
}

TEST_CASE("Alg1 and Alg2 turn round where they meet an earlier hit point again, once, and are there sooner than Bug2 and I-Bug, which do not") {
  for (const bool mirrored : {false, true}) {
    const LetterMap map = mirrored ? coil.mirrored() : coil;
    const char* long_way = mirrored ? "left" : "right";
    const char* short_way = mirrored ? "right" : "left";
    for (const auto& [with, without] : {std::pair("alg1", "bug2"), std::pair("alg2", "i_bug")}) {
      CAPTURE(with);
      CAPTURE(mirrored);
      const Run remembers = drive(map, with, long_way, real), forgets = drive(map, without, long_way, real);
      CHECK(remembers.last.outcome == Outcome::reached);
      CHECK(forgets.last.outcome == Outcome::reached);
      CHECK(count(remembers.marks, "turn") == 1);
      CHECK(remembers.length < 0.85 * forgets.length);
      const Run other = drive(map, with, short_way, real), same = drive(map, without, short_way, real);
      CHECK(other.last.outcome == Outcome::reached);
      CHECK(count(other.marks, "turn") == 0);  // no earlier hit point is met: the same planner
      CHECK(other.track == same.track);
    }
  }
}

TEST_CASE("a boundary that comes close beside the M-line, and does not cross it, is left there by all that leave on the line") {
  const glm::dvec2 hit(0.0, 0.0), goal(10.0, 0.0);
  for (const double sign : {1.0, -1.0}) {
    BoundaryWalk walk({hit, 0.0}, goal, 0.1, 1.0, 0.0, hit);
    const auto step = [&](double x, double y) {
      walk.advance({{x, sign * y}, 0.0});
      return on_m_line(walk, hit, goal, 0.05);
    };
    CHECK_FALSE(step(-1.0, 1.0));  // behind the hit point
    CHECK_FALSE(step(-1.0, -1.0));
    CHECK_FALSE(step(2.0, -1.0));
    CHECK_FALSE(step(3.0, -0.06));
    CHECK(step(3.5, -0.04));
    CHECK_FALSE(step(4.0, -0.06));
    CHECK(step(4.1, 2.0));  // across in one step
    CHECK_FALSE(step(11.0, 1.0));
    CHECK_FALSE(step(11.0, -1.0));  // behind the goal
  }
}

TEST_CASE("DistBug leaves where it sees the goal, not before it has come round") {
  for (const char* hand : {"left", "right"}) {
    const Run dist_bug = drive(block, "dist_bug", hand, real), bug2 = drive(block, "bug2", hand, real);
    CHECK(dist_bug.last.outcome == Outcome::reached);
    CHECK(dist_bug.length < bug2.length);
    CHECK(count(dist_bug.marks, "hit") <= 2);
  }
}

}  // namespace thicket

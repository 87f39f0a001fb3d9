#include "thicket/worlds/truth.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"

using namespace thicket;

namespace {

Solid placed(Shape shape, const glm::dvec3& position = glm::dvec3(0.0), double yaw = 0.0) {
  Solid solid;
  solid.shape = std::move(shape);
  solid.position = position;
  solid.yaw = yaw;
  return solid;
}

/// A grid of one character a cell, the top row first; '#' is blocked, any letter marks a place.
struct Sketch {
  TruthGrid grid;
  std::vector<std::string> rows;

  explicit Sketch(const std::vector<std::string>& drawn, double resolution = 1.0, const glm::dvec2& low = glm::dvec2(0.0)) : rows(drawn) {
    grid.low = low;
    grid.resolution = resolution;
    grid.width = static_cast<int>(drawn[0].size());
    grid.height = static_cast<int>(drawn.size());
    for (auto row = drawn.rbegin(); row != drawn.rend(); ++row)
      for (const char letter : *row) grid.blocked.push_back(letter == '#');
  }
  glm::dvec2 at(char letter) const {
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column)
        if (rows[static_cast<std::size_t>(grid.height - 1 - row)][static_cast<std::size_t>(column)] == letter)
          return grid.centre(column, row);
    FAIL("no such letter");
    return {};
  }
  bool connected(char from, char to) const { return thicket::connected(grid, at(from), at(to)); }
};

/// The rows of a grid as a sketch has them.
std::vector<std::string> drawn(const TruthGrid& grid) {
  std::vector<std::string> rows;
  for (int row = grid.height - 1; row >= 0; --row) {
    rows.emplace_back();
    for (int column = 0; column < grid.width; ++column)
      rows.back() +=
          grid.blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(column)] ? '#' : '.';
  }
  return rows;
}
using Rows = std::vector<std::string>;

}  // namespace

TEST_CASE("inside a box") {
  const Solid box = placed(Box{{4.0, 2.0, 1.0}}, {10.0, 20.0, 0.5}, pi / 2);  // turned: 2 m along x, 4 m along y
  CHECK(inside(box, {10.0, 20.0, 0.5}));
  CHECK(inside(box, {10.9, 21.9, 0.01}));
  CHECK(inside(box, {9.1, 18.1, 0.99}));
  CHECK_FALSE(inside(box, {11.1, 20.0, 0.5}));
  CHECK_FALSE(inside(box, {10.0, 22.1, 0.5}));
  CHECK_FALSE(inside(box, {10.0, 20.0, 1.01}));
  CHECK_FALSE(inside(box, {10.0, 20.0, -0.01}));
}

TEST_CASE("inside a sphere") {
  const Solid ball = placed(Sphere{1.0}, {1.0, 2.0, 3.0});
  CHECK(inside(ball, {1.0, 2.0, 3.0}));
  CHECK(inside(ball, {1.0, 2.0, 3.99}));
  CHECK(inside(ball, {1.79, 2.0, 3.6}));  // 0.8 m off at 0.6 m of height
  CHECK_FALSE(inside(ball, {1.81, 2.0, 3.6}));
  CHECK_FALSE(inside(ball, {1.81, 2.0, 2.4}));
  CHECK_FALSE(inside(ball, {1.0, 2.0, 4.01}));
  CHECK_FALSE(inside(ball, {1.6, 2.6, 3.6}));
}

TEST_CASE("inside a cylinder") {
  const Solid pillar = placed(Cylinder{0.5, 2.0}, {1.0, 0.0, 0.0});
  CHECK(inside(pillar, {1.35, 0.35, 0.99}));
  CHECK_FALSE(inside(pillar, {1.36, 0.36, 0.0}));
  CHECK_FALSE(inside(pillar, {1.0, 0.0, 1.01}));
  CHECK_FALSE(inside(pillar, {1.0, 0.0, -1.01}));
}

TEST_CASE("inside a wall") {
  const Solid wall = placed(Wall{{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}}, 0.4, 2.0}, {0.0, 0.0, 1.0});
  CHECK(inside(wall, {2.0, 0.19, 1.01}));
  CHECK(inside(wall, {2.0, -0.19, 2.99}));
  CHECK_FALSE(inside(wall, {2.0, 0.21, 2.0}));
  CHECK_FALSE(inside(wall, {2.0, 0.0, 0.99}));
  CHECK_FALSE(inside(wall, {2.0, 0.0, 3.01}));
  // Its ends are square, its corner is round.
  CHECK(inside(wall, {0.01, 0.19, 2.0}));
  CHECK_FALSE(inside(wall, {-0.01, 0.0, 2.0}));
  CHECK(inside(wall, {4.19, 3.99, 2.0}));
  CHECK_FALSE(inside(wall, {4.0, 4.01, 2.0}));
  CHECK(inside(wall, {4.14, -0.14, 2.0}));
  CHECK_FALSE(inside(wall, {4.15, -0.15, 2.0}));
  // A ring has a round corner where it closes too.
  const Solid ring = placed(Wall{{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 0.0}}, 0.4, 2.0});
  CHECK(inside(ring, {-0.19, 0.0, 1.0}));
  CHECK_FALSE(inside(ring, {2.5, 1.5, 1.0}));
  // Turned and moved with its solid.
  const Solid turned = placed(Wall{{{0.0, 0.0}, {4.0, 0.0}}, 0.4, 2.0}, {1.0, 1.0, 0.0}, pi / 2);
  CHECK(inside(turned, {1.0, 4.9, 1.0}));
  CHECK_FALSE(inside(turned, {4.9, 1.0, 1.0}));
}

TEST_CASE("inside a map") {
  const MapSolid map = map_of({"#.?",  //
                               "..#"},
                              0.5, 2.0);
  const Solid solid = placed(map, {10.0, 0.0, 1.0});
  CHECK(inside(solid, {10.25, 0.75, 2.0}));
  CHECK(inside(solid, {11.25, 0.25, 1.0}));
  CHECK(inside(solid, {11.25, 0.75, 2.0}));  // unknown is matter
  CHECK_FALSE(inside(solid, {10.75, 0.25, 2.0}));
  CHECK_FALSE(inside(solid, {10.25, 0.75, 3.01}));
  CHECK_FALSE(inside(solid, {10.25, 0.75, 0.99}));
  CHECK_FALSE(inside(solid, {9.99, 0.75, 2.0}));
  CHECK_FALSE(inside(solid, {11.51, 0.25, 2.0}));
  CHECK_FALSE(inside(solid, {10.25, 1.01, 2.0}));
  CHECK_FALSE(inside(placed(map_of({"#.?", "..#"}, 0.5, 2.0, false), {10.0, 0.0, 1.0}), {11.25, 0.75, 2.0}));
  // Half a turn about its own origin.
  const Solid turned = placed(map, {10.0, 0.0, 1.0}, pi);
  CHECK(inside(turned, {9.75, -0.75, 2.0}));
  CHECK_FALSE(inside(turned, {9.25, -0.25, 2.0}));
}

TEST_CASE("in any matter, or in what stops motion") {
  HandMadeWorld w;
  const auto smoke = w.material("smoke", 1e-7, 0.05, true, false), wall = w.material("wall", 0.5, infinity);
  w.add(Sphere{2.0}, {0.0, 0.0, 0.0}, 0.0, smoke);
  w.add(Sphere{1.0}, {2.0, 0.0, 0.0}, 0.0, wall);
  CHECK(in_matter(w.world, {-1.0, 0.0, 0.0}));
  CHECK_FALSE(in_matter(w.world, {-1.0, 0.0, 0.0}, true));
  CHECK(in_matter(w.world, {1.5, 0.0, 0.0}, true));
  CHECK_FALSE(in_matter(w.world, {4.0, 0.0, 0.0}));
  CHECK_FALSE(in_matter(World{}, {0.0, 0.0, 0.0}));
}

TEST_CASE("connected by free cells that share an edge") {
  const Sketch maze({
      "#########",  //
      "#a..#..b#",  //
      "#.#.#.#.#",  //
      "#.#...#.#",  //
      "#########",  //
      "#c.#.d.e#",  //
      "#########",
  });
  CHECK(maze.connected('a', 'b'));
  CHECK(maze.connected('b', 'a'));
  CHECK(maze.connected('a', 'a'));
  CHECK(maze.connected('d', 'e'));
  CHECK_FALSE(maze.connected('a', 'c'));
  CHECK_FALSE(maze.connected('c', 'd'));

  // Corners are no way.
  const Sketch corner({
      "a#",  //
      "#b",
  });
  CHECK_FALSE(corner.connected('a', 'b'));

  // Neither do rows run into one another at the sides of the grid.
  const Sketch rows({
      "##b",  //
      "###",  //
      "a##",
  });
  CHECK_FALSE(rows.connected('a', 'b'));
  const Sketch wrapped({
      "b##",  //
      "##a",
  });
  CHECK_FALSE(wrapped.connected('a', 'b'));
}

TEST_CASE("nothing is connected to what is blocked or outside") {
  const Sketch room({"a.b", "..#"}, 0.5, {10.0, -1.0});
  CHECK(room.connected('a', 'b'));
  CHECK(connected(room.grid, {10.01, -0.01}, {11.49, -0.49}));
  CHECK_FALSE(connected(room.grid, room.at('a'), {11.25, -0.75}));
  CHECK_FALSE(connected(room.grid, {11.25, -0.75}, room.at('a')));
  for (const glm::dvec2 outside :
       {glm::dvec2(9.99, -0.5), glm::dvec2(11.51, -0.5), glm::dvec2(10.5, -1.01), glm::dvec2(10.5, 0.01), glm::dvec2(-50.0, 3.0)}) {
    CHECK_FALSE(room.grid.contains(outside));
    CHECK_FALSE(connected(room.grid, room.at('a'), outside));
    CHECK_FALSE(connected(room.grid, outside, room.at('a')));
  }
  CHECK(room.grid.index_at({11.25, -0.75}) == 2);
  CHECK(room.grid.index_at({10.25, -0.25}) == 3);
}

TEST_CASE("a gap closes at exactly twice what obstacles are grown by") {
  // Cells of 1/8 m with a row of centres in the very middle of the gap: there the distance to both sides is half of it.
  const auto passes = [](double gap, double grow) {
    HandMadeWorld w;
    const double half = 0.5 * gap;
    w.add(Box{{0.5, 4.0, 1.0}}, {4.0, half + 2.0, 0.5});
    w.add(Box{{0.5, 4.0, 1.0}}, {4.0, -half - 2.0, 0.5});
    const TruthGrid grid = *grown_obstacles(w.world, {0.0, -2.0625}, {8.0, 2.0625}, 0.125, grow, 0.0, 0.5);
    return connected(grid, {0.5, 0.0}, {7.5, 0.0});
  };
  CHECK(passes(1.0, 0.5));
  CHECK(passes(0.5, 0.25));
  CHECK_FALSE(passes(1.0, 0.5000001));
  CHECK_FALSE(passes(0.9999999, 0.5));
  CHECK(passes(1.0000001, 0.5));
  CHECK_FALSE(passes(0.5, 0.3));
}

TEST_CASE("obstacles grow by an exact distance, round at corners") {
  HandMadeWorld w;
  w.add(Box{{1.0, 1.0, 1.0}}, {0.0, 0.0, 0.5});
  // Centres at whole and half metres: at (1.5, 0) the distance is 1, at (1, 1) it is 0.707, at (1.5, 1) 1.118, at (1.5, 1.5) 1.414.
  const auto grown = [&](double grow) { return drawn(*grown_obstacles(w.world, {-2.25, -2.25}, {2.25, 2.25}, 0.5, grow, 0.0, 0.5)); };
  // A centre on the very edge is not nearer than nothing: nothing grown, nothing blocked but what is nearer than 0, and that is none.
  CHECK(grown(0.0) == Rows(9, "........."));
  CHECK(grown(0.01) == Rows{".........",  //
                            ".........",  //
                            ".........",  //
                            "...###...",  //
                            "...###...",  //
                            "...###...",  //
                            ".........",  //
                            ".........",  //
                            "........."});
  CHECK(grown(0.75) == Rows{".........",  //
                            ".........",  //
                            "..#####..",  //
                            "..#####..",  //
                            "..#####..",  //
                            "..#####..",  //
                            "..#####..",  //
                            ".........",  //
                            "........."});
  CHECK(grown(1.01) == Rows{".........",  //
                            "...###...",  //
                            "..#####..",  //
                            ".#######.",  //
                            ".#######.",  //
                            ".#######.",  //
                            "..#####..",  //
                            "...###...",  //
                            "........."});
}

TEST_CASE("obstacles are what stops motion at the heights of the hull") {
  HandMadeWorld w;
  const auto hard = w.material("hard", 0.5, infinity), smoke = w.material("smoke", 1e-7, 0.05, true, false);
  w.add(Cylinder{0.4, 1.0}, {0.5, 0.5, 0.5}, 0.0, hard);
  w.add(Cylinder{0.4, 1.0}, {1.5, 0.5, 0.5}, 0.0, smoke);
  w.add(Cylinder{0.4, 1.0}, {2.5, 0.5, 2.5}, 0.0, hard);  // from 2 m to 3 m
  w.add(Sphere{0.5}, {3.5, 0.5, 1.4}, 0.0, hard);         // from 0.9 m to 1.9 m
  const auto at = [&](double z_low, double z_high) {
    return drawn(*grown_obstacles(w.world, {0.0, 0.0}, {5.0, 1.0}, 1.0, 0.05, z_low, z_high)).at(0);
  };
  CHECK(at(0.0, 0.5) == "#....");
  CHECK(at(0.0, 0.95) == "#..#.");
  CHECK(at(1.1, 1.2) == "...#.");
  CHECK(at(1.1, 2.5) == "..##.");
  CHECK(at(1.95, 2.0) == ".....");
  CHECK(at(3.0, 4.0) == ".....");
}

TEST_CASE("distances that obstacles grow by, for every shape") {
  // One cell whose centre is at the origin: it is blocked as soon as the growth exceeds the distance.
  const auto distance_is = [](const Shape& shape, const glm::dvec3& position, double yaw, double expected) {
    HandMadeWorld w;
    w.add(shape, position, yaw);
    const auto blocked = [&](double grow) {
      const TruthGrid grid = *grown_obstacles(w.world, glm::dvec2(-0.5), glm::dvec2(0.5), 1.0, grow, 0.0, 0.5);
      REQUIRE(grid.blocked.size() == 1);
      return grid.blocked[0] != 0;
    };
    return blocked(expected + 1e-12) && !blocked(expected - 1e-12);
  };
  CHECK(distance_is(Sphere{1.0}, {3.0, 4.0, 0.25}, 0.0, 4.0));
  CHECK(distance_is(Sphere{1.0}, {3.0, 4.0, 1.1}, 0.0, 4.2));
  CHECK(distance_is(Sphere{1.0}, {3.0, 4.0, -0.8}, 0.0, 4.4));
  CHECK(distance_is(Cylinder{1.0, 1.0}, {3.0, 4.0, 0.0}, 0.0, 4.0));
  CHECK(distance_is(Box{{2.0, 4.0, 1.0}}, {4.0, 1.0, 0.0}, 0.0, 3.0));
  CHECK(distance_is(Box{{2.0, 4.0, 1.0}}, {4.0, 6.0, 0.0}, 0.0, 5.0));
  CHECK(distance_is(Box{{2.0, 2.0, 1.0}}, {4.0, 0.0, 0.0}, pi / 4, 4.0 - std::numbers::sqrt2));
  CHECK(distance_is(Wall{{{3.0, -5.0}, {3.0, 5.0}}, 0.5, 1.0}, {0.0, 0.0, 0.0}, 0.0, 2.75));
  CHECK(distance_is(Wall{{{3.0, 4.0}, {3.0, 9.0}}, 2.0, 1.0}, {0.0, 0.0, 0.0}, 0.0, std::hypot(2.0, 4.0)));
  CHECK(distance_is(Wall{{{9.0, 4.0}, {3.0, 4.0}, {9.0, 4.5}}, 2.0, 1.0}, {0.0, 0.0, 0.0}, 0.0, 4.0));  // its round corner
  CHECK(distance_is(map_of({".#", ".."}, 1.0), {2.0, 1.0, 0.0}, 0.0, std::hypot(3.0, 2.0)));
  CHECK(distance_is(map_of({"#"}, 2.0), {-1.0, 2.0, 0.0}, 0.0, 2.0));
}

TEST_CASE("the grid covers what was asked for, to whole cells") {
  const TruthGrid grid = *grown_obstacles(World{}, {-1.0, 2.0}, {1.05, 3.0}, 0.1, 0.3, 0.0, 1.0);
  CHECK(grid.width == 21);
  CHECK(grid.height == 10);
  CHECK(grid.blocked.size() == 210);
  CHECK(grid.centre(0, 0).x == doctest::Approx(-0.95).epsilon(1e-15));
  CHECK(grid.centre(20, 9).y == doctest::Approx(2.95).epsilon(1e-15));
  CHECK(drawn(grid) == Rows(10, std::string(21, '.')));
}

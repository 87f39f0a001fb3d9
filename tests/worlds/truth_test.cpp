#include "thicket/worlds/truth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "../hand_made_world.hpp"
#include "../outside_data.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/movingai.hpp"

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

Solid tilted(Shape shape, const glm::dvec3& position, double yaw, double pitch, double roll) {
  Solid solid = placed(std::move(shape), position, yaw);
  solid.pitch = pitch;
  solid.roll = roll;
  return solid;
}

World world_of(const Solid& solid) {
  HandMadeWorld w;
  w.material("stuff", 0.5, infinity);
  w.world.solids.push_back(solid);
  return w.world;
}

/// Axis-aligned boxes as the triangles of one mesh; an inward one is a cavity.
struct BoxMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;

  BoxMesh& box(const glm::dvec3& low, const glm::dvec3& high, bool inward = false) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i < 8; ++i) vertices.emplace_back(i & 1u ? high.x : low.x, i & 2u ? high.y : low.y, i & 4u ? high.z : low.z);
    for (const glm::uvec3& t : {glm::uvec3(0, 2, 3), {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}})
      triangles.push_back(inward ? base + glm::uvec3(t.x, t.z, t.y) : base + t);
    return *this;
  }
  MeshSolid solid(double scale = 1.0) const {
    const auto mesh = make_mesh(vertices, triangles);
    REQUIRE(mesh->closed);
    return {mesh, scale, 0.001};
  }
};

MeshSolid sheet(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles, double thickness) {
  const auto mesh = make_mesh(vertices, triangles);
  REQUIRE_FALSE(mesh->closed);
  return {mesh, 1.0, thickness};
}

const Prism frame{{{-1.0, -1.0}, {1.0, -1.0}, {1.3, 0.9}, {0.1, 0.6}, {-1.0, 1.1}}, {{{-0.5, -0.5}, {-0.5, 0.3}, {0.4, 0.2}, {0.6, -0.6}}}, 0.8};

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

Rows drawn_occupancy(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double z_low, double z_high, Convention convention) {
  return drawn(*occupancy(world, low, high, resolution, z_low, z_high, convention));
}

std::size_t count(const TruthGrid& grid) { return static_cast<std::size_t>(std::count(grid.blocked.begin(), grid.blocked.end(), 1)); }

/// Whether a square about a point, between two heights, has a point inside the solid, of 9 x 9 x 21.
bool sampled(const Solid& solid, const glm::dvec2& centre, double half, double z_low, double z_high) {
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i)
        if (inside(solid, {centre + half * glm::dvec2(0.25 * i - 1.0, 0.25 * j - 1.0), z_low + (z_high - z_low) * (k + 0.5) / 21.0})) return true;
  return false;
}

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

TEST_CASE("inside a prism, its hole is not") {
  const Solid prism = placed(frame, {10.0, 0.0, 1.0}, pi / 2);  // turned: x becomes y
  CHECK(inside(prism, {10.75, 0.0, 1.4}));
  CHECK(inside(prism, {10.75, 0.0, 1.79}));
  CHECK_FALSE(inside(prism, {10.75, 0.0, 1.81}));
  CHECK_FALSE(inside(prism, {10.75, 0.0, 0.99}));
  CHECK_FALSE(inside(prism, {10.0, 0.0, 1.4}));
  CHECK(inside(prism, {9.2, 1.2, 1.4}));   // (1.2, 0.8) of the outline
  CHECK_FALSE(inside(prism, {9.2, -0.1, 1.4}));  // (-0.1, 0.8): in the notch
}

TEST_CASE("inside a closed mesh: overlapping parts are one, an inward shell is a cavity") {
  const Solid mesh = placed(BoxMesh().box({0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}).box({1.0, 1.0, 1.0}, {3.0, 3.0, 3.0}).box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, true).solid(0.5), {1.0, 0.0, 0.0});
  const auto at = [&](double x, double y, double z) { return inside(mesh, {1.0 + 0.5 * x, 0.5 * y, 0.5 * z}); };
  CHECK(at(0.1, 0.1, 0.1));
  CHECK(at(1.5, 1.5, 1.5));
  CHECK(at(2.9, 2.9, 2.9));
  CHECK_FALSE(at(0.5, 0.5, 0.5));
  CHECK_FALSE(at(2.5, 0.5, 0.5));
  CHECK_FALSE(at(-0.1, 0.5, 0.5));
  CHECK_FALSE(at(3.1, 3.1, 3.1));
  CHECK(inside(placed(BoxMesh().box(glm::dvec3(-1.0), glm::dvec3(1.0), true).solid()), {0.5, 0.5, 0.5}));  // wholly inside out it is still a body
}

TEST_CASE("inside a sheet is within half its thickness, around its edges too") {
  const Solid triangle = placed(sheet({{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}}, {{0, 1, 2}}, 0.2));
  CHECK(inside(triangle, {0.5, 0.5, 0.099}));
  CHECK(inside(triangle, {0.5, 0.5, -0.099}));
  CHECK_FALSE(inside(triangle, {0.5, 0.5, 0.101}));
  CHECK(inside(triangle, {1.0, -0.09, 0.0}));
  CHECK_FALSE(inside(triangle, {1.0, -0.08, 0.07}));
  CHECK(inside(triangle, {1.05, 1.05, 0.0}));
  CHECK_FALSE(inside(triangle, {1.08, 1.08, 0.0}));
}

TEST_CASE("a solid that is turned holds the turned points of its own") {
  Dice dice(7);
  std::size_t in = 0;
  const Shape shapes[] = {Box{{1.0, 2.0, 0.5}}, Sphere{0.8}, Cylinder{0.6, 1.5}, frame, BoxMesh().box({-0.5, -1.0, -0.25}, {0.5, 1.0, 0.25}).solid()};
  for (const Shape& shape : shapes) {
    const Solid upright = placed(shape);
    for (int i = 0; i < 400; ++i) {
      const Solid turned = tilted(shape, dice.point(glm::dvec3(-9.0), glm::dvec3(9.0)), dice.between(-pi, pi), dice.between(-pi, pi), dice.between(-pi, pi));
      const glm::dvec3 p = dice.point(glm::dvec3(-1.2), glm::dvec3(1.2));
      in += inside(upright, p);
      CHECK(inside(turned, turned.position + rotation_of(turned) * p) == inside(upright, p));
    }
  }
  CHECK(in > 200);
}

TEST_CASE("the matter at a point: the highest attenuation, and whether any of it stops motion") {
  HandMadeWorld w;
  const auto smoke = w.material("smoke", 0.0, 0.5, true, false), leaves = w.material("leaves", 0.1, 3.0, true, true), glass = w.material("glass", 0.1, 1.0, false, true);
  w.add(Sphere{2.0}, {0.0, 0.0, 0.0}, 0.0, smoke);
  w.add(Sphere{1.0}, {2.0, 0.0, 0.0}, 0.0, leaves);
  w.add(Sphere{1.0}, {2.5, 0.0, 0.0}, 0.0, glass);
  const auto at = [&](double x) { return matter_at(w.world, {x, 0.0, 0.0}); };
  CHECK(at(0.0).any);
  CHECK(at(0.0).attenuation_db_per_m == 0.5);
  CHECK_FALSE(at(0.0).stops_motion);
  CHECK(at(1.8).attenuation_db_per_m == 3.0);
  CHECK(at(1.8).stops_motion);
  CHECK(at(3.2).attenuation_db_per_m == 1.0);
  CHECK_FALSE(at(4.0).any);
  CHECK(at(4.0).attenuation_db_per_m == 0.0);
}

TEST_CASE("occupancy of a box on the borders of cells, in both conventions") {
  const auto both = [](const Solid& solid, const glm::dvec2& low, const glm::dvec2& high, double resolution) {
    const World world = world_of(solid);
    return std::pair(drawn_occupancy(world, low, high, resolution, 0.0, 0.5, Convention::cell_centre), drawn_occupancy(world, low, high, resolution, 0.0, 0.5, Convention::any_overlap));
  };
  // From 0.3 to 0.6 and from 0.1 to 0.3, in cells of 0.1 m: no decimal of these is a double, yet no neighbour is filled.
  const Rows exact = {"......", "...###", "...###", "......"};
  for (const double far : {0.0, 100.0, -3000.0, 1e6}) {
    CAPTURE(far);
    const auto [centre, overlap] = both(placed(Box{{0.3, 0.2, 1.0}}, {far + 0.45, far + 0.2, 0.0}), {far, far}, {far + 0.6, far + 0.4}, 0.1);
    CHECK(centre == exact);
    CHECK(overlap == exact);
  }
  // From 0.26 to 0.44 along x: overlaps cells 2, 3 and 4, holds the centre of 3 (0.35) only. Along y from 0.14 to 0.25: cells 1 and 2, whose centres are on or in it.
  const auto [centre, overlap] = both(placed(Box{{0.18, 0.11, 1.0}}, {0.35, 0.195, 0.0}), {0.0, 0.0}, {0.6, 0.4}, 0.1);
  CHECK(centre == Rows{"......", "...#..", "...#..", "......"});
  CHECK(overlap == Rows{"......", "..###.", "..###.", "......"});
  // A post in the middle between centres is met by overlap alone.
  const auto [none, post] = both(placed(Cylinder{0.01, 1.0}, {0.28, 0.22, 0.0}), {0.0, 0.0}, {0.6, 0.4}, 0.1);
  CHECK(none == Rows(4, "......"));
  CHECK(post == Rows{"......", "..#...", "......", "......"});
}

TEST_CASE("occupancy of round things, counted by hand") {
  // A disc of radius 1.5 about a corner of four cells of 1 m: the far corner of the cell at (2, 2) is no part of it, but the near one is at 1.41.
  const World disc = world_of(placed(Cylinder{1.5, 1.0}, {3.0, 3.0, 0.0}));
  CHECK(drawn_occupancy(disc, {0.0, 0.0}, {6.0, 6.0}, 1.0, 0.0, 0.5, Convention::any_overlap) == Rows{"......", ".####.", ".####.", ".####.", ".####.", "......"});
  CHECK(drawn_occupancy(disc, {0.0, 0.0}, {6.0, 6.0}, 1.0, 0.0, 0.5, Convention::cell_centre) == Rows{"......", "......", "..##..", "..##..", "......", "......"});
  // With 1.4 the corner cells are out.
  const World less = world_of(placed(Cylinder{1.4, 1.0}, {3.0, 3.0, 0.0}));
  CHECK(drawn_occupancy(less, {0.0, 0.0}, {6.0, 6.0}, 1.0, 0.0, 0.5, Convention::any_overlap) == Rows{"......", "..##..", ".####.", ".####.", "..##..", "......"});
  // A ball above the slab shows the cap that reaches into it: radius 1.5 at 0.9 above, 1.2.
  const World ball = world_of(placed(Sphere{1.5}, {3.0, 3.0, 1.4}));
  CHECK(drawn_occupancy(ball, {0.0, 0.0}, {6.0, 6.0}, 1.0, 0.0, 0.5, Convention::any_overlap) == Rows{"......", "..##..", ".####.", ".####.", "..##..", "......"});
  CHECK(drawn_occupancy(ball, {0.0, 0.0}, {6.0, 6.0}, 1.0, -1.0, -0.1, Convention::any_overlap) == Rows(6, "......"));
}

TEST_CASE("occupancy of maps, walls, prisms with holes and sheets, counted by hand") {
  const World map = world_of(placed(map_of({"#.?", "..#"}, 1.0), {1.0, 1.0, 0.0}));
  for (const Convention convention : {Convention::cell_centre, Convention::any_overlap})
    CHECK(drawn_occupancy(map, {0.0, 0.0}, {5.0, 4.0}, 1.0, 0.0, 0.5, convention) == Rows{".....", ".#.#.", "...#.", "....."});
  const World wall = world_of(placed(Wall{{{1.5, 0.0}, {1.5, 3.0}}, 0.2, 1.0}));
  CHECK(drawn_occupancy(wall, {0.0, 0.0}, {3.0, 4.0}, 1.0, 0.0, 0.5, Convention::any_overlap) == Rows{"...", ".#.", ".#.", ".#."});
  const Prism ring{{{1.0, 1.0}, {6.0, 1.0}, {6.0, 6.0}, {1.0, 6.0}}, {{{2.0, 2.0}, {5.0, 2.0}, {5.0, 5.0}, {2.0, 5.0}}}, 1.0};
  const Rows frame_rows = {".......", ".#####.", ".#...#.", ".#...#.", ".#...#.", ".#####.", "......."};
  for (const Convention convention : {Convention::cell_centre, Convention::any_overlap})
    CHECK(drawn_occupancy(world_of(placed(ring)), {0.0, 0.0}, {7.0, 7.0}, 1.0, 0.0, 0.5, convention) == frame_rows);
  // A triangle that stands on its edge is a line from above: what it crosses is overlapped, no centre is.
  const World blade = world_of(placed(sheet({{0.2, 0.2, 0.0}, {2.8, 0.3, 0.0}, {1.0, 0.25, 2.0}}, {{0, 1, 2}}, 0.001)));
  CHECK(drawn_occupancy(blade, {0.0, 0.0}, {4.0, 2.0}, 1.0, 0.5, 0.6, Convention::any_overlap) == Rows{"....", "###."});
  CHECK(drawn_occupancy(blade, {0.0, 0.0}, {4.0, 2.0}, 1.0, 0.5, 0.6, Convention::cell_centre) == Rows{"....", "...."});
  // A floor is matter where the slab is nearer than half its thickness.
  const World floor = world_of(placed(sheet({{0.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}}, {{0, 1, 2}}, 0.02)));
  CHECK(count(*occupancy(floor, {0.0, 0.0}, {3.0, 3.0}, 1.0, 0.005, 0.5, Convention::cell_centre)) == 6);
  CHECK(count(*occupancy(floor, {0.0, 0.0}, {3.0, 3.0}, 1.0, 0.015, 0.5, Convention::any_overlap)) == 0);
}

TEST_CASE("occupancy of every shape in every pose, against samples of inside") {
  struct Sample {
    std::string what;
    Solid solid;
    double margin = 0.03;
  };
  const MeshSolid hollow = BoxMesh().box(glm::dvec3(-1.0), glm::dvec3(1.0)).box(glm::dvec3(-0.7), glm::dvec3(0.7), true).solid();
  const Sample samples[] = {{"box", placed(Box{{1.7, 0.6, 1.0}}, {0.1, 0.2, 0.0}, 0.4)},
                            {"tilted box", tilted(Box{{1.7, 0.6, 1.3}}, {0.1, 0.2, 0.0}, 0.4, 0.7, -0.5)},
                            {"box on its corner", tilted(Box{{1.2, 1.2, 1.2}}, {0.0, 0.1, 0.75}, 0.2, 0.6, 0.8)},
                            {"sphere", placed(Sphere{1.1}, {-0.2, 0.1, -0.8})},
                            {"cylinder", placed(Cylinder{0.9, 1.0}, {0.1, 0.2, 0.1})},
                            {"tilted cylinder", tilted(Cylinder{0.5, 1.9}, {0.1, 0.2, 0.1}, 0.3, 0.9, 0.2)},
                            {"lying cylinder", tilted(Cylinder{0.7, 1.9}, {0.1, 0.2, 0.8}, 0.3, 0.5 * pi, 0.0)},
                            {"wall", placed(Wall{{{-1.0, -1.0}, {0.8, -0.7}, {0.2, 0.9}}, 0.3, 1.0}, {0.0, 0.0, -0.2}, 0.3)},
                            {"map", placed(map_of({"#.?.", "..##", "#..#"}, 0.5, 1.0), {-0.9, -0.8, 0.0}, 0.3)},
                            {"prism", placed(frame, {0.0, 0.1, -0.1}, 0.5)},
                            {"tilted prism", tilted(frame, {0.0, 0.1, -0.1}, 0.5, 0.4, -0.7)},
                            {"hollow mesh", tilted(hollow, {0.0, 0.1, 0.0}, 0.3, 0.2, 0.1)},
                            {"thick sheet", tilted(sheet({{-1.0, -1.0, 0.0}, {1.0, -0.8, 0.2}, {0.3, 1.0, 0.0}}, {{0, 1, 2}}, 0.24), {0.0, 0.0, 0.1}, 0.1, 0.6, 0.3), 0.15}};  // may reach half its thickness too far
  constexpr double z_low = -0.15, z_high = 0.25, resolution = 0.24;
  const glm::dvec2 low(-1.8, -1.8), high(1.8, 1.8);
  for (const Sample& sample : samples) {
    CAPTURE(sample.what);
    const World world = world_of(sample.solid);
    const auto centre = *occupancy(world, low, high, resolution, z_low, z_high, Convention::cell_centre), overlap = *occupancy(world, low, high, resolution, z_low, z_high, Convention::any_overlap);
    int missed = 0, invented = 0, outside_overlap = 0;
    for (int row = 0; row < centre.height; ++row)
      for (int column = 0; column < centre.width; ++column) {
        const std::size_t cell = static_cast<std::size_t>(row * centre.width + column);
        const glm::dvec2 at = centre.centre(column, row);
        // A sample inside is proof. None inside, in a square that is larger by what may lie between samples (0.019 m of height and so much aside), is proof of the contrary.
        missed += !centre.blocked[cell] && sampled(sample.solid, at, 1e-9, z_low, z_high);
        missed += !overlap.blocked[cell] && sampled(sample.solid, at, 0.499 * resolution, z_low, z_high);
        invented += centre.blocked[cell] && !sampled(sample.solid, at, sample.margin, z_low, z_high);
        invented += overlap.blocked[cell] && !sampled(sample.solid, at, 0.5 * resolution + sample.margin, z_low, z_high);
        outside_overlap += centre.blocked[cell] && !overlap.blocked[cell];
      }
    CHECK(missed == 0);
    CHECK(invented == 0);
    CHECK(outside_overlap == 0);
    CHECK(count(overlap) > count(centre));
    CHECK(count(centre) > 5);
  }
}

TEST_CASE("a mesh cube, a prism cube and a box cube have one plan") {
  Dice dice(3);
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 half(dice.between(0.2, 1.0), dice.between(0.2, 1.0), dice.between(0.2, 1.0)), position = dice.point(glm::dvec3(-1.0), glm::dvec3(1.0));
    const bool upright = i % 3 == 0;
    const double yaw = dice.between(-pi, pi), pitch = upright ? 0.0 : dice.between(-pi, pi), roll = upright ? 0.0 : dice.between(-pi, pi);
    const Solid box = tilted(Box{2.0 * half}, position, yaw, pitch, roll), mesh = tilted(BoxMesh().box(-half, half).solid(), position, yaw, pitch, roll);
    Solid prism = tilted(Prism{{{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}}, {}, 2.0 * half.z}, position, yaw, pitch, roll);
    prism.position -= rotation_of(prism) * glm::dvec3(0.0, 0.0, half.z);
    const double z_low = dice.between(-1.0, 0.5), z_high = z_low + (i % 5 == 0 ? 0.0 : dice.between(0.0, 1.0)), resolution = dice.between(0.05, 0.3);
    const auto rasters = [&](const Solid& solid) {
      const World world = world_of(solid);
      std::vector<std::uint8_t> all;
      for (const auto& grid : {occupancy(world, glm::dvec2(-3.0), glm::dvec2(3.0), resolution, z_low, z_high, Convention::cell_centre),
                               occupancy(world, glm::dvec2(-3.0), glm::dvec2(3.0), resolution, z_low, z_high, Convention::any_overlap),
                               grown_obstacles(world, glm::dvec2(-3.0), glm::dvec2(3.0), resolution, 0.4, z_low, z_high)})
        all.insert(all.end(), grid->blocked.begin(), grid->blocked.end());
      return all;
    };
    const auto expected = rasters(box);
    CHECK(rasters(mesh) == expected);
    CHECK(rasters(prism) == expected);
  }
  // On the borders of cells, and touching the slab from below and above.
  const auto blocked = [](double z_low, double z_high, Convention convention) {
    return drawn_occupancy(world_of(placed(BoxMesh().box({0.3, 0.1, 0.0}, {0.6, 0.3, 0.5}).solid())), {0.0, 0.0}, {0.6, 0.4}, 0.1, z_low, z_high, convention);
  };
  const Rows exact = {"......", "...###", "...###", "......"}, none(4, "......");
  for (const Convention convention : {Convention::cell_centre, Convention::any_overlap}) {
    CHECK(blocked(0.0, 0.5, convention) == exact);
    CHECK(blocked(0.1, 0.4, convention) == exact);
    CHECK(blocked(0.25, 0.25, convention) == exact);
    CHECK(blocked(0.5, 1.0, convention) == none);
    CHECK(blocked(-1.0, 0.0, convention) == none);
  }
}

TEST_CASE("distances to tilted and pierced things, against samples of them") {
  for (const Solid& solid : {tilted(Box{{1.6, 0.5, 1.2}}, {0.1, 0.2, 0.1}, 0.4, 0.7, -0.5), tilted(Cylinder{0.5, 1.4}, {0.1, 0.2, 0.1}, 0.4, 0.8, 0.0), placed(frame, {0.0, 0.0, -0.2}, 0.3),
                             placed(BoxMesh().box({-1.0, -0.5, -1.0}, {1.0, 0.5, 1.0}).box({-0.6, -0.3, -2.0}, {0.5, 0.3, 2.0}).solid(), {0.0, 0.0, 0.0}, 0.2)}) {
    CAPTURE(solid.shape.index());
    constexpr double z_low = -0.1, z_high = 0.2, spacing = 0.025;
    std::vector<glm::dvec2> plan;
    for (double x = -1.9; x < 1.9; x += spacing)
      for (double y = -1.9; y < 1.9; y += spacing)
        for (double z = z_low + 0.005; z < z_high; z += 0.025)
          if (inside(solid, {x, y, z})) {
            plan.emplace_back(x, y);
            break;
          }
    REQUIRE(plan.size() > 500);
    for (const double grow : {0.06, 0.35}) {
      const TruthGrid grid = *grown_obstacles(world_of(solid), glm::dvec2(-2.0), glm::dvec2(2.0), 0.1, grow, z_low, z_high);
      int wrong = 0;
      for (int row = 0; row < grid.height; ++row)
        for (int column = 0; column < grid.width; ++column) {
          const bool blocked = grid.blocked[static_cast<std::size_t>(row * grid.width + column)] != 0;
          double distance = infinity;
          for (const glm::dvec2& p : plan) distance = std::min(distance, glm::distance(p, grid.centre(column, row)));
          wrong += distance < grow && !blocked;
          wrong += distance > grow + 0.04 && blocked;  // what may lie between samples
        }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("distances to a tilted box and to sheets, in closed form") {
  const auto distance_is = [](const Solid& solid, double z_low, double z_high, double expected) {
    const auto blocked = [&](double grow) { return grown_obstacles(world_of(solid), glm::dvec2(-0.5), glm::dvec2(0.5), 1.0, grow, z_low, z_high)->blocked.at(0) != 0; };
    return blocked(expected + 1e-12) && !blocked(expected - 1e-12);
  };
  // A cube on its edge, 4 m off: half its diagonal wide at the height of its middle, less by the height above or below.
  const Solid edge = tilted(Box{{2.0, 2.0, 2.0}}, {4.0, 0.0, 0.0}, 0.0, pi / 4, 0.0);
  CHECK(distance_is(edge, -0.5, 0.5, 4.0 - std::numbers::sqrt2));
  CHECK(distance_is(edge, 0.25, 0.5, 4.0 - std::numbers::sqrt2 + 0.25));
  CHECK(distance_is(edge, 0.25, 0.25, 4.0 - std::numbers::sqrt2 + 0.25));
  CHECK(distance_is(tilted(Cylinder{0.5, 4.0}, {4.0, 0.0, 0.0}, 0.0, pi / 2, 0.0), -1.0, 1.0, 2.0));  // lies along x
  CHECK(distance_is(placed(sheet({{3.0, -1.0, 0.0}, {3.0, 1.0, 0.0}, {3.0, 0.0, 1.0}}, {{0, 1, 2}}, 0.1)), 0.1, 0.2, 2.95));
  CHECK(distance_is(placed(sheet({{3.0, 4.0, 0.0}, {5.0, 4.0, 0.0}, {3.0, 6.0, 0.0}}, {{0, 1, 2}}, 0.1)), -0.1, 0.2, 4.95));
}

TEST_CASE("what only moves past is where the caller's time puts it") {
  World world = world_of(placed(Box{{1.0, 1.0, 1.0}}, {0.5, 0.5, 0.0}));
  world.solids[0].motion = std::make_shared<Motion>(Motion{{{0.5, 0.5, 0.0}, {4.5, 0.5, 0.0}}, 1.0, 0.0, 0.0, Motion::Mode::once});
  const auto at = [&](double time) { return drawn_occupancy(world_at(world, time), {0.0, 0.0}, {5.0, 1.0}, 1.0, 0.0, 0.4, Convention::any_overlap).at(0); };
  CHECK(at(0.0) == "#....");
  CHECK(at(2.0) == "..#..");
  CHECK(at(2.5) == "..##.");
  CHECK(at(9.0) == "....#");
}

TEST_CASE("occupancy by all matter or by what stops motion") {
  HandMadeWorld w;
  const auto smoke = w.material("smoke", 0.0, 0.5, true, false), wall = w.material("wall", 0.5, infinity);
  w.add(Box{{1.0, 1.0, 1.0}}, {0.5, 0.5, 0.0}, 0.0, smoke);
  w.add(Box{{1.0, 1.0, 1.0}}, {2.5, 0.5, 0.0}, 0.0, wall);
  CHECK(drawn(*occupancy(w.world, {0.0, 0.0}, {3.0, 1.0}, 1.0, 0.0, 0.4, Convention::cell_centre, true)) == Rows{"..#"});
  CHECK(drawn(*occupancy(w.world, {0.0, 0.0}, {3.0, 1.0}, 1.0, 0.0, 0.4, Convention::cell_centre, false)) == Rows{"#.#"});
}

TEST_CASE("absurd grids are refused with a message") {
  const auto message = [](const glm::dvec2& low, const glm::dvec2& high, double resolution, double z_low, double z_high) {
    const auto grid = occupancy(World{}, low, high, resolution, z_low, z_high, Convention::cell_centre);
    const auto grown = grown_obstacles(World{}, low, high, resolution, 0.1, z_low, z_high);
    REQUIRE_FALSE(grid);
    REQUIRE_FALSE(grown);
    CHECK(grid.error().message == grown.error().message);
    return grid.error().message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(message({0.0, 0.0}, {1.0, 1.0}, 0.0, 0.0, 1.0) == "the resolution is 0 m, expected a finite number greater than 0");
  for (const double resolution : {-1.0, infinity, nan}) CHECK(message({0.0, 0.0}, {1.0, 1.0}, resolution, 0.0, 1.0).find("the resolution is ") == 0);
  CHECK(message({0.0, 0.0}, {1e6, 1e6}, 0.05, 0.0, 1.0) ==
        "the grid would be 20000000 x 20000000 cells, expected at most 268435456 in all: take a larger resolution or smaller bounds");
  CHECK(message({0.0, 0.0}, {1e300, 1e300}, 1e-300, 0.0, 1.0).find("the grid would be ") == 0);
  for (const glm::dvec2 high : {glm::dvec2(0.0, 1.0), {1.0, -1.0}, {infinity, 1.0}, {1.0, nan}}) CHECK(message({0.0, 0.0}, high, 0.1, 0.0, 1.0).find("the bounds are 0, 0 to ") == 0);
  for (const double z_high : {-1.0, infinity, nan}) CHECK(message({0.0, 0.0}, {1.0, 1.0}, 0.1, 0.0, z_high).find("the heights are 0 to ") == 0);
  for (const double grow : {-0.1, infinity, nan}) CHECK_FALSE(grown_obstacles(World{}, {0.0, 0.0}, {1.0, 1.0}, 0.1, grow, 0.0, 1.0));
  CHECK(occupancy(World{}, {0.0, 0.0}, {1.0, 1.0}, 0.1, 0.3, 0.3, Convention::cell_centre)->width == 10);
}

TEST_CASE("the shortest path goes round corners, never through them") {
  const Sketch room({"a..b", ".#..", "c.#d"}, 0.5, {-1.0, 3.0});
  const auto length = [&](char from, char to) { return shortest_path(room.grid, room.at(from), room.at(to))->length_m; };
  CHECK(length('a', 'b') == doctest::Approx(1.5));
  CHECK(length('a', 'c') == doctest::Approx(1.0));
  CHECK(length('a', 'a') == 0.0);
  CHECK(length('b', 'd') == doctest::Approx(1.0));
  CHECK(length('c', 'd') == doctest::Approx(0.5 * (5.0 + std::numbers::sqrt2)));  // up, along the top and down again: only the diagonal down to the right passes no corner
  const auto path = shortest_path(room.grid, room.at('c'), room.at('b'));
  REQUIRE(path);
  CHECK(path->length_m == doctest::Approx(2.5));
  REQUIRE(path->points.size() == 6);
  CHECK(path->points.front() == room.at('c'));
  CHECK(path->points.back() == room.at('b'));
  double sum = 0.0;
  for (std::size_t i = 1; i < path->points.size(); ++i) sum += glm::distance(path->points[i - 1], path->points[i]);
  CHECK(sum == doctest::Approx(path->length_m));
  const Sketch open({"...b", "....", "a..."});
  CHECK(shortest_path(open.grid, open.at('a'), open.at('b'))->length_m == doctest::Approx(1.0 + 2.0 * std::numbers::sqrt2));

  const Sketch corner({"a#", "#b"});
  CHECK_FALSE(shortest_path(corner.grid, corner.at('a'), corner.at('b')));
  CHECK_FALSE(shortest_path(room.grid, room.at('a'), {-0.25, 3.75}));  // blocked
  CHECK_FALSE(shortest_path(room.grid, {-0.25, 3.75}, room.at('a')));
  CHECK_FALSE(shortest_path(room.grid, room.at('a'), {9.0, 3.0}));
  CHECK_FALSE(shortest_path(room.grid, {9.0, 3.0}, room.at('a')));
}

TEST_CASE("a path exists where points are connected, is as long either way, and is the same again") {
  Dice dice(11);
  int found = 0;
  for (int i = 0; i < 150; ++i) {
    TruthGrid grid{{0.0, 0.0}, 1.0, 17, 13, {}};
    for (int k = 0; k < 17 * 13; ++k) grid.blocked.push_back(dice.chance(0.35));
    const glm::dvec2 a = dice.point(glm::dvec2(0.0), glm::dvec2(17.0, 13.0)), b = dice.point(glm::dvec2(0.0), glm::dvec2(17.0, 13.0));
    const auto way = shortest_path(grid, a, b), back = shortest_path(grid, b, a), again = shortest_path(grid, a, b);
    CHECK(way.has_value() == connected(grid, a, b));
    if (!way) continue;
    ++found;
    REQUIRE(back);
    CHECK(way->length_m == back->length_m);
    CHECK(way->points == again->points);
  }
  CHECK(found > 20);
}

TEST_CASE("shortest paths are as long as those of the MovingAI benchmarks") {
  struct Maps {
    const char *map, *problems;
    int every;
  };
  for (const Maps& maps : {Maps{"64room_000.map", "64room_000.map.scen", 40}, {"Berlin_0_256.map", "Berlin_0_256.map.scen", 20}, {"maze-32-32-4.map", "maze-32-32-4-even-1.scen", 20},
                           {"maze-32-32-4.map", "maze-32-32-4-random-1.scen", 20}, {"random-32-32-20.map", "random-32-32-20-even-1.scen", 20}, {"random-32-32-20.map", "random-32-32-20-random-1.scen", 20},
                           {"room-64-64-16.map", "room-64-64-16-even-1.scen", 20}, {"room-64-64-16.map", "room-64-64-16-random-1.scen", 20},
                           {"warehouse-10-20-10-2-1.map", "warehouse-10-20-10-2-1-even-1.scen", 20}, {"warehouse-10-20-10-2-1.map", "warehouse-10-20-10-2-1-random-1.scen", 20}}) {
    const auto map_file = outside_data(("movingai/" + std::string(maps.map)).c_str()), problem_file = outside_data(("movingai/" + std::string(maps.problems)).c_str());
    if (!map_file || !problem_file) {
      MESSAGE("skipped: no outside data");
      return;
    }
    CAPTURE(maps.problems);
    const auto map = read_movingai_map(*map_file, 1.0);
    REQUIRE(map);
    TruthGrid grid{map->origin, 1.0, map->width, map->height, {}};
    for (const CellState state : map->cells) grid.blocked.push_back(state != CellState::free);
    std::istringstream lines(*read_text_file(*problem_file));
    std::string line;
    std::getline(lines, line);  // version 1
    int solved = 0;
    for (int number = 0; std::getline(lines, line); ++number) {
      if (number % maps.every != 0) continue;
      std::istringstream words(line);
      std::string bucket, name;
      double width = 0.0, height = 0.0, x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0, optimal = 0.0;
      if (!(words >> bucket >> name >> width >> height >> x0 >> y0 >> x1 >> y1 >> optimal)) continue;
      const auto path = shortest_path(grid, {x0 + 0.5, height - y0 - 0.5}, {x1 + 0.5, height - y1 - 0.5});
      CAPTURE(line);
      REQUIRE(path);
      CHECK(std::abs(path->length_m - optimal) <= 1e-5 * optimal);
      ++solved;
    }
    CHECK(solved >= 5);
  }
}

// Lines around grown matter against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "thicket/base/pose.hpp"
#include "thicket/worlds/free_space.hpp"

namespace thicket {
namespace {

constexpr double cell = 0.05;

World world_of(std::vector<Solid> solids) {
  World world;
  Material wall;
  wall.name = "wall";
  world.materials.push_back(wall);
  world.solids = std::move(solids);
  return world;
}

Solid disc(double x, double y, double radius) { return {"disc", 0, {x, y, 0.5}, 0.0, Cylinder{radius, 1.0}}; }
Solid box(double x, double y, double yaw, double a, double b) { return {"box", 0, {x, y, 0.5}, yaw, Box{{a, b, 1.0}}}; }

std::vector<GrownContour> contours_of(const World& world, double grow, const glm::dvec2& from) {
  const auto contours = grown_contours(world, {-5.0, -5.0}, {5.0, 5.0}, cell, grow, 0.1, 0.3, from);
  REQUIRE(contours);
  return *contours;
}

void check_length(const GrownContour& contour, double length) {
  CHECK(contour.length_m == doctest::Approx(length).epsilon(0.003));
}

}  // namespace

TEST_CASE("the contour of a grown disc is a circle, of a grown box its sides and a circle's arcs, whatever its yaw") {
  for (const double grow : {0.3, 0.65, 1.2}) {
    const auto round = contours_of(world_of({disc(0.313, -0.127, 0.8)}), grow, {4.0, 4.0});
    REQUIRE(round.size() == 1);
    check_length(round[0], 2.0 * pi * (0.8 + grow));
    for (const double yaw : {0.0, 0.3, 0.785}) {
      const auto angular = contours_of(world_of({box(0.2, 0.1, yaw, 2.0, 0.7)}), grow, {4.0, 4.0});
      REQUIRE(angular.size() == 1);
      check_length(angular[0], 2.0 * (2.0 + 0.7) + 2.0 * pi * grow);
    }
  }
}

TEST_CASE("points of a contour lie at the growth from matter") {
  const auto contours = contours_of(world_of({disc(0.313, -0.127, 0.8)}), 0.65, {4.0, 4.0});
  REQUIRE(contours.size() == 1);
  for (const glm::dvec2& p : contours[0].points) CHECK(std::hypot(p.x - 0.313, p.y + 0.127) == doctest::Approx(1.45).epsilon(0.0005));
}

TEST_CASE("a room is bounded by its wall from inside, and by what stands in it; what lies beyond is not there") {
  const World room = world_of({{"wall", 0, {0.0, 0.0, 0.0}, 0.0, Wall{{{-4, -3}, {4, -3}, {4, 3}, {-4, 3}, {-4, -3}}, 0.2, 2.0}}, disc(0.0, 0.0, 0.4), disc(-4.6, 4.6, 0.1)});
  const auto inside = contours_of(room, 0.5, {2.0, 1.0});
  REQUIRE(inside.size() == 2);
  std::vector<double> lengths = {inside[0].length_m, inside[1].length_m};
  std::sort(lengths.begin(), lengths.end());
  CHECK(lengths[0] == doctest::Approx(2.0 * pi * 0.9).epsilon(0.003));
  CHECK(lengths[1] == doctest::Approx(2.0 * (6.8 + 4.8)).epsilon(0.003));  // the inner corners of a grown wall are square
  for (const GrownContour& contour : contours_of(room, 0.5, {4.9, 0.0}))
    for (const glm::dvec2& p : contour.points) CHECK((std::abs(p.x) > 4.4 || std::abs(p.y) > 3.4));  // its corners are round
  CHECK(contours_of(room, 0.5, {0.0, 0.2}).empty());  // in the disc
}

TEST_CASE("two grown discs merge when their distance is less than twice the growth") {
  const double radius = 0.5, grow = 0.4, half = 0.8;  // of the distance of their centres
  const auto merged = contours_of(world_of({disc(-half, 0.0, radius), disc(half, 0.0, radius)}), grow, {4.0, 4.0});
  REQUIRE(merged.size() == 1);
  const double r = radius + grow;
  // A square of four nodes shows none of the notch within it.
  CHECK(std::abs(merged[0].length_m - 2.0 * r * (2.0 * pi - 2.0 * std::acos(half / r))) < 2.0 * 1.5 * cell);
  const auto apart = contours_of(world_of({disc(-half, 0.0, radius), disc(half, 0.0, radius)}), 0.25, {4.0, 4.0});
  REQUIRE(apart.size() == 2);
  check_length(apart[0], 2.0 * pi * 0.75);
}

TEST_CASE("without matter there is no contour; matter over the edge of the window is closed along it; free space is one around the window") {
  CHECK(contours_of(world_of({}), 0.5, {0.0, 0.0}).empty());
  const auto cut = contours_of(world_of({box(0.0, 0.0, 0.0, 20.0, 1.0)}), 0.5, {0.0, 4.0});
  REQUIRE(cut.size() == 1);
  CHECK(cut[0].length_m == doctest::Approx(2.0 * (10.0 + 2.0)).epsilon(0.01));
}

TEST_CASE("what is blocked is what a map of grown obstacles blocks") {
  const World world = world_of({disc(1.0, 1.0, 0.7), box(-1.0, 0.3, 0.4, 2.0, 0.3), {"prism", 0, {0.0, -2.0, 0.0}, 0.2, Prism{{{-1, -1}, {1, -1}, {1, 0.5}, {0, -0.5}, {-1, 0.5}}, {}, 1.0}}});
  const double grow = 0.3711;
  const auto grid = grown_obstacles(world, {-5.0, -5.0}, {5.0, 5.0}, cell, grow, 0.1, 0.3);
  const auto distances = distance_to_matter(world, {-5.0, -5.0}, {5.0, 5.0}, cell, 1.0, 0.1, 0.3);
  REQUIRE(grid);
  REQUIRE(distances);
  CHECK(FreeSpace(*distances, grow).grid().blocked == grid->blocked);
}

TEST_CASE("crossings of a segment with a contour; minima of the distance along it") {
  const auto u = contours_of(world_of({box(0.0, -1.5, 0.0, 3.0, 0.2), box(-1.4, 0.0, 0.0, 0.2, 3.0), box(1.4, 0.0, 0.0, 0.2, 3.0)}), 0.3, {4.0, 4.0});
  REQUIRE(u.size() == 1);
  CHECK(crossings(u[0], {-4.0, 0.5}, {4.0, 0.5}) == 4);
  CHECK(crossings(u[0], {-4.0, 0.5}, {0.0, 0.5}) == 2);
  CHECK(crossings(u[0], {-4.0, -1.5}, {4.0, -1.5}) == 2);
  CHECK(crossings(u[0], {-4.0, 3.0}, {4.0, 3.0}) == 0);
  CHECK(local_minima(u[0], {0.0, 4.0}, cell) == 4);  // the tips of both arms, the bottom between them, and its underside
  CHECK(local_minima(u[0], {0.0, -4.0}, cell) == 2);
  CHECK(distance_from(u[0], {0.0, -4.0}) == doctest::Approx(4.0 - 1.6 - 0.3).epsilon(0.001));
}

TEST_CASE("distances refuse what makes no grid") {
  CHECK_FALSE(distance_to_matter(world_of({}), {0.0, 0.0}, {1.0, 1.0}, 0.0, 1.0, 0.0, 1.0));
  CHECK_FALSE(distance_to_matter(world_of({}), {0.0, 0.0}, {1.0, 1.0}, 0.1, 0.0, 0.0, 1.0));
  CHECK_FALSE(distance_to_matter(world_of({}), {0.0, 0.0}, {1.0, -1.0}, 0.1, 1.0, 0.0, 1.0));
}

}  // namespace thicket

// Solids of several parts: walls and maps.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "brute_force.hpp"

using namespace thicket;

namespace {

std::vector<Crossing> crossings_of(const Scene& scene, const Ray& ray) {
  CrossingLists lists;
  CHECK(scene.crossings({&ray, 1}, infinity, lists, true) == 0);
  return lists.items;
}

Ray level_ray(const glm::dvec2& from, double bearing, double z = 1.0) {
  return {{from, z}, {direction(bearing), 0.0}};
}

Scene wall(std::vector<glm::dvec2> points, double thickness) {
  HandMadeWorld w;
  w.add(Wall{std::move(points), thickness, 2.5}, {0.0, 0.0, 0.0});
  return traced(w);
}

/// Compares all crossings of some rays with brute force; the number of rays that met matter.
std::size_t check_against_brute_force(const World& world, std::span<const Ray> rays) {
  const Scene scene = traced(world);
  const auto pieces = brute::pieces_of(world);
  CrossingLists lists;
  CHECK(scene.crossings(rays, infinity, lists, true) == 0);
  std::size_t wrong = 0, met = 0;
  double worst = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto expected = brute::crossings(pieces, rays[i]);
    met += !expected.empty();
    if (expected.size() != lists[i].size()) {
      ++wrong;
      continue;
    }
    for (std::size_t c = 0; c < expected.size(); ++c) {
      const Crossing &a = lists[i][c], &b = expected[c];
      wrong += a.solid != b.solid || a.starts_inside != b.starts_inside;
      worst = std::max({worst, std::abs(a.enter - b.enter), std::abs(a.leave - b.leave), glm::distance(a.enter_normal, b.enter_normal),
                        glm::distance(a.leave_normal, b.leave_normal)});
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
  return met;
}

}  // namespace

TEST_CASE("a straight wall has its thickness, and square ends") {
  const Scene scene = wall({{0.0, 0.0}, {8.0, 0.0}}, 0.25);
  SUBCASE("across") {
    const auto c = crossings_of(scene, level_ray({4.0, -3.0}, pi / 2));
    REQUIRE(c.size() == 1);
    CHECK(c[0].enter == doctest::Approx(2.875).epsilon(1e-15));
    CHECK(c[0].leave == doctest::Approx(3.125).epsilon(1e-15));
  }
  SUBCASE("at 60 degrees from its normal, twice the thickness") {
    const auto c = crossings_of(scene, level_ray({2.0, -3.0}, pi / 6));
    REQUIRE(c.size() == 1);
    CHECK(c[0].leave - c[0].enter == doctest::Approx(0.5).epsilon(1e-13));
  }
  SUBCASE("along, from end to end and no farther") {
    const auto c = crossings_of(scene, Ray{{-1.0, 0.0625, 1.0}, {1.0, 0.0, 0.0}});
    REQUIRE(c.size() == 1);
    CHECK(c[0].enter == 1.0);
    CHECK(c[0].leave == 9.0);
    CHECK(crossings_of(scene, Ray{{-0.01, -1.0, 1.0}, {0.0, 1.0, 0.0}}).empty());
    CHECK(crossings_of(scene, Ray{{8.01, -1.0, 1.0}, {0.0, 1.0, 0.0}}).empty());
  }
  SUBCASE("from the ground to its height") {
    CHECK(crossings_of(scene, Ray{{4.0, -3.0, 2.49}, {0.0, 1.0, 0.0}}).size() == 1);
    CHECK(crossings_of(scene, Ray{{4.0, -3.0, 2.51}, {0.0, 1.0, 0.0}}).empty());
    CHECK(crossings_of(scene, Ray{{4.0, -3.0, -0.01}, {0.0, 1.0, 0.0}}).empty());
  }
}

TEST_CASE("a wall is crossed once for each time its thickness is, at corners too") {
  SUBCASE("a corner from its two sides") {
    const Scene scene = wall({{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}}, 0.2);
    // Through the rounded corner along its bisector: from the inner edge at (4.9, 0.1) to the circle of 0.1 m about (5, 0).
    const auto c = crossings_of(scene, level_ray({3.0, 2.0}, -pi / 4));
    REQUIRE(c.size() == 1);
    CHECK(c[0].enter == doctest::Approx(1.9 * std::numbers::sqrt2).epsilon(1e-12));
    CHECK(c[0].leave == doctest::Approx(2.0 * std::numbers::sqrt2 + 0.1).epsilon(1e-12));
    // Across both arms: two crossings of one solid.
    CHECK(crossings_of(scene, level_ray({1.0, -1.0}, pi / 4)).size() == 2);
  }
  SUBCASE("a ring, from its middle to every side") {
    const Scene scene = wall({{-2.0, -2.0}, {2.0, -2.0}, {2.0, 2.0}, {-2.0, 2.0}, {-2.0, -2.0}}, 0.2);
    for (int degree = 0; degree < 360; ++degree) {
      const double bearing = radians(degree);
      const auto c = crossings_of(scene, level_ray({0.0, 0.0}, bearing));
      REQUIRE(c.size() == 1);
      const double steepest = std::max(std::abs(std::cos(bearing)), std::abs(std::sin(bearing)));
      CHECK(c[0].enter == doctest::Approx(1.9 / steepest).epsilon(1e-12));
      // The outside is a square of 4.2 m whose corners are rounded by 0.1 m.
      double leave = 2.1 / steepest;
      const double gentle = std::min(std::abs(std::cos(bearing)), std::abs(std::sin(bearing)));
      if (leave * gentle > 2.0) {
        const double along = 2.0 * (steepest + gentle), off = 2.0 * (steepest - gentle);
        leave = along + std::sqrt(0.01 - off * off);
      }
      CHECK(c[0].leave == doctest::Approx(leave).epsilon(1e-12));
    }
  }
  SUBCASE("points on one line leave no seam") {
    const Scene scene = wall({{0.0, 0.0}, {1.0 / 3.0, 0.1}, {2.0 / 3.0, 0.2}, {1.0, 0.3}, {2.0, 0.6}}, 0.1);
    const double along = std::atan2(0.3, 1.0);
    for (const glm::dvec2 joint : {glm::dvec2(1.0 / 3.0, 0.1), glm::dvec2(2.0 / 3.0, 0.2), glm::dvec2(1.0, 0.3)})
      for (const double angle : {0.3, 0.5 * pi, 2.0}) {
        const auto c = crossings_of(scene, level_ray(joint - 3.0 * direction(along + angle), along + angle));
        REQUIRE(c.size() == 1);
        CHECK(c[0].leave - c[0].enter == doctest::Approx(0.1 / std::sin(angle)).epsilon(1e-12));
      }
    // Lengthwise, the whole wall at once, and from inside one of its joints.
    REQUIRE(crossings_of(scene, level_ray(-direction(along), along)).size() == 1);
    const auto inside = crossings_of(scene, level_ray({1.0, 0.3}, along));
    REQUIRE(inside.size() == 1);
    CHECK(inside[0].starts_inside);
    CHECK(inside[0].leave == doctest::Approx(std::hypot(1.0, 0.3)).epsilon(1e-12));
  }
}

TEST_CASE("polylines of any shape, placed and turned, are what brute force finds") {
  Dice dice(11);
  std::size_t met = 0;
  for (int i = 0; i < 60; ++i) {
    HandMadeWorld w;
    for (int k = 0; k < 2; ++k) {
      Wall wall{{}, dice.between(0.001, 0.8), dice.between(0.5, 3.0)};
      const std::uint32_t corners = 2 + dice.pick(5);
      for (std::uint32_t p = 0; p < corners; ++p) wall.points.push_back(dice.point(glm::dvec2(-5.0), glm::dvec2(5.0)));
      if (corners > 2 && dice.chance(0.5)) wall.points.push_back(wall.points.front());
      w.add(wall, dice.point(glm::dvec3(-2.0, -2.0, -1.0), glm::dvec3(2.0, 2.0, 1.0)), dice.between(-pi, pi));
    }
    std::vector<Ray> rays;
    for (int r = 0; r < 200; ++r) {
      const glm::dvec3 origin = dice.point(glm::dvec3(-8.0, -8.0, -1.0), glm::dvec3(8.0, 8.0, 3.0));
      const glm::dvec3 target = dice.point(glm::dvec3(-6.0, -6.0, -1.0), glm::dvec3(6.0, 6.0, 3.0));
      rays.push_back({origin, glm::normalize(target - origin)});
    }
    met += check_against_brute_force(w.world, rays);
  }
  CHECK(met > 4000);
}

namespace {

/// A random map: its matter, its size and how much of each state differ.
MapSolid any_map() {
  MapSolid map;
  map.grid.width = *rc::gen::inRange(1, 14);
  map.grid.height = *rc::gen::inRange(1, 14);
  map.grid.resolution = *rc::gen::element(0.05, 0.1, 0.25, 1.0 / 3.0, 1.0);
  map.unknown_is_matter = *rc::gen::arbitrary<bool>();
  const int occupied = *rc::gen::inRange(0, 101), unknown = *rc::gen::inRange(0, 30);
  const auto cells =
      *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(map.grid.width * map.grid.height), rc::gen::inRange(0, 100));
  for (const int cell : cells)
    map.grid.cells.push_back(cell < unknown ? CellState::unknown : cell < occupied ? CellState::occupied : CellState::free);
  map.blocks = merge_cells(map);
  return map;
}

}  // namespace

TEST_CASE("the merged blocks of a map cover its matter, each cell once, and nothing else") {
  CHECK(rc::check("merged blocks", [] {
    const MapSolid map = any_map();
    std::vector<int> covered(map.grid.cells.size());
    for (const CellBlock& b : map.blocks) {
      RC_ASSERT(b.column >= 0 && b.row >= 0 && b.columns > 0 && b.rows > 0);
      RC_ASSERT(b.column + b.columns <= map.grid.width);
      RC_ASSERT(b.row + b.rows <= map.grid.height);
      for (int row = b.row; row < b.row + b.rows; ++row)
        for (int column = b.column; column < b.column + b.columns; ++column)
          ++covered[static_cast<std::size_t>(row * map.grid.width + column)];
    }
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const bool matter = map.grid.cells[i] == CellState::occupied || (map.grid.cells[i] == CellState::unknown && map.unknown_is_matter);
      RC_ASSERT(covered[i] == (matter ? 1 : 0));
    }
  }));
  // A full map is one block, a chessboard one for each of its cells.
  CHECK(map_of({"###", "###"}, 1.0).blocks.size() == 1);
  CHECK(map_of({"#.#", ".#.", "#.#"}, 1.0).blocks.size() == 5);
  CHECK(map_of({"..", ".."}, 1.0).blocks.empty());
}

TEST_CASE("a map is crossed as its cells are, one crossing for each stretch of matter") {
  CHECK(rc::check("crossings of maps", [] {
    HandMadeWorld w;
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    Dice dice(seed);
    w.add(any_map(), dice.point(glm::dvec3(-3.0, -3.0, -1.0), glm::dvec3(3.0, 3.0, 0.0)), dice.between(-pi, pi));
    const auto& map = std::get<MapSolid>(w.world.solids[0].shape);
    const Pose2 frame{glm::dvec2(w.world.solids[0].position), w.world.solids[0].yaw};
    const glm::dvec2 size = glm::dvec2(map.grid.width, map.grid.height) * map.grid.resolution;

    const Scene scene = traced(w);
    const auto pieces = brute::pieces_of(w.world);
    for (int i = 0; i < 30; ++i) {
      const glm::dvec3 origin(frame.to_outer(dice.point(-0.2 * size, 1.2 * size)), dice.between(-0.5, 1.5));
      const glm::dvec3 target(frame.to_outer(dice.point(glm::dvec2(0.0), size)), dice.between(0.0, 1.0));
      const Ray ray{origin, glm::normalize(target - origin)};
      CrossingLists found;
      scene.crossings({&ray, 1}, infinity, found, true);
      const auto expected = brute::crossings(pieces, ray);
      RC_ASSERT(found.items.size() == expected.size());
      for (std::size_t c = 0; c < expected.size(); ++c) {
        RC_ASSERT(std::abs(found.items[c].enter - expected[c].enter) <= 1e-9);
        RC_ASSERT(std::abs(found.items[c].leave - expected[c].leave) <= 1e-9);
        RC_ASSERT(found.items[c].starts_inside == expected[c].starts_inside);
      }
    }
  }));
}

TEST_CASE("the blocks of a map have no seams between them") {
  // An F: its stem is one block, its arms are two that touch it.
  const MapSolid map = map_of({"####",  //
                               "#...",  //
                               "###.",  //
                               "#...",  //
                               "#..."},
                              0.5);
  REQUIRE(map.blocks.size() == 3);

  SUBCASE("through the stem into the upper arm, at any slant, in a turned map") {
    Dice dice(12);
    HandMadeWorld w;
    const double yaw = 0.3;
    w.add(map, {1.0, 2.0, 0.0}, yaw);
    const Scene scene = traced(w);
    const Pose2 frame{{1.0, 2.0}, yaw};
    for (int i = 0; i < 1000; ++i) {
      // From the left of the F to the end of the arm, inside matter all the way.
      const glm::dvec2 begin(0.0, dice.between(2.01, 2.49)), end(2.0, dice.between(2.01, 2.49));
      const glm::dvec2 from = frame.to_outer(begin - 0.5 * (end - begin)), to = frame.to_outer(end);
      const auto c = crossings_of(scene, level_ray(from, bearing(to - from)));
      REQUIRE(c.size() == 1);
      CHECK(std::abs(c[0].leave - c[0].enter - glm::distance(begin, end)) < 1e-9);
    }
  }
  SUBCASE("along an edge between cells a ray is in exactly one of them") {
    HandMadeWorld w;
    w.add(map, {0.0, 0.0, 0.0});
    const Scene scene = traced(w);
    // y = 1 m is the upper edge of the second row and the lower edge of the third, "###.": a cell owns its lower edge.
    const auto c = crossings_of(scene, Ray{{-1.0, 1.0, 1.0}, {1.0, 0.0, 0.0}});
    REQUIRE(c.size() == 1);
    CHECK(c[0].enter == 1.0);
    CHECK(c[0].leave == 2.5);
    // x = 0.5 m is the stem's right edge: it is in the arms alone.
    const auto up = crossings_of(scene, Ray{{0.5, -1.0, 1.0}, {0.0, 1.0, 0.0}});
    REQUIRE(up.size() == 2);
    CHECK(up[0].enter == 2.0);
    CHECK(up[0].leave == 2.5);
    CHECK(up[1].enter == 3.0);
    CHECK(up[1].leave == 3.5);
  }
  SUBCASE("a ray that starts on a face between two blocks starts inside") {
    HandMadeWorld w;
    w.add(map, {0.0, 0.0, 0.0});
    const Scene scene = traced(w);
    for (const double sense : {1.0, -1.0}) {
      CAPTURE(sense);
      const auto c = crossings_of(scene, Ray{{0.5, 1.25, 1.0}, {sense, 0.0, 0.0}});
      REQUIRE(c.size() == 1);
      CHECK(c[0].starts_inside);
      CHECK(c[0].enter == 0.0);
      CHECK(c[0].leave == (sense > 0.0 ? 1.0 : 0.5));
      CHECK(c[0].enter_normal == glm::dvec3(0.0));
    }
  }
}

TEST_CASE("an extent holds its solid and no more") {
  const auto is = [](const Bounds& b, const glm::dvec3& low, const glm::dvec3& high) {
    return glm::distance(b.low, low) < 1e-12 && glm::distance(b.high, high) < 1e-12;
  };
  Solid solid;
  solid.position = {1.0, 2.0, 3.0};
  solid.shape = Sphere{0.5};
  CHECK(is(extent(solid), {0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}));
  solid.shape = Cylinder{0.5, 4.0};
  CHECK(is(extent(solid), {0.5, 1.5, 1.0}, {1.5, 2.5, 5.0}));
  solid.yaw = pi / 2;
  solid.shape = Box{{2.0, 4.0, 6.0}};
  CHECK(is(extent(solid), {-1.0, 1.0, 0.0}, {3.0, 3.0, 6.0}));
  solid.shape = map_of({".#", ".."}, 0.5, 2.0);
  CHECK(is(extent(solid), {0.0, 2.5, 3.0}, {0.5, 3.0, 5.0}));
  solid.yaw = pi / 4;
  solid.shape = Box{{2.0, 2.0, 2.0}};
  CHECK(is(extent(solid), {1.0 - std::numbers::sqrt2, 2.0 - std::numbers::sqrt2, 2.0},
           {1.0 + std::numbers::sqrt2, 2.0 + std::numbers::sqrt2, 4.0}));
  CHECK_FALSE(extent(World{}).has_value());
}

TEST_CASE("the half width of a solid between two heights") {
  Solid ball;
  ball.position = {5.0, 5.0, 1.0};
  ball.shape = Sphere{0.5};
  CHECK(half_width_between(ball, 0.9, 1.1) == 0.5);
  CHECK(half_width_between(ball, 1.3, 2.0) == doctest::Approx(0.4).epsilon(1e-15));
  CHECK(half_width_between(ball, 0.0, 0.7) == doctest::Approx(0.4).epsilon(1e-15));
  CHECK(half_width_between(ball, 1.6, 2.0) == 0.0);
  Solid pillar;
  pillar.shape = Cylinder{0.25, 2.0};
  CHECK(half_width_between(pillar, 0.9, 3.0) == 0.25);
  CHECK(half_width_between(pillar, 1.1, 3.0) == 0.0);
  Solid box;
  box.shape = Box{{3.0, 4.0, 1.0}};
  CHECK(half_width_between(box, 0.0, 0.1) == 2.5);
}

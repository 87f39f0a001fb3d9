// What must be exact, at the size that it was asked for, against oracles of this file.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "brute_force.hpp"
#include "hand_made_mesh.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/truth.hpp"

using namespace thicket;

namespace {

/// A sphere or a box in any pose, in extended precision.
struct Analytic {
  brute::Vec3 centre, half;
  glm::mat<3, 3, brute::Real> turn{1};
  bool ball = false;

  brute::Stretch through(const Ray& ray) const {
    const brute::Vec3 o = brute::Vec3(ray.origin) - centre, d(ray.direction);
    brute::Stretch s;
    if (ball) {
      if (!brute::round_stretch(o, d, half.x, s.enter, s.leave)) return {1, 0, {}, {}};
      return s;
    }
    for (int i = 0; i < 3; ++i) {
      s.keep_behind(turn[i], half[i], o, d);
      s.keep_behind(-turn[i], half[i], o, d);
    }
    return s;
  }
};

}  // namespace

TEST_CASE("100 000 rays through 500 spheres and boxes that overlap and hold one another: every entrance and exit") {
  Dice dice(71);
  HandMadeWorld w;
  std::vector<Analytic> solids;
  for (int i = 0; i < 500; ++i) {
    // A third lies about the middle of an earlier one, so that it is inside or around it.
    const bool nested = i > 10 && i % 3 == 0;
    const glm::dvec3 position = nested ? w.world.solids[dice.pick(static_cast<std::uint32_t>(i))].position + 0.05 * dice.direction()
                                       : dice.point(glm::dvec3(-10.0, -10.0, -3.0), glm::dvec3(10.0, 10.0, 3.0));
    Analytic a;
    a.centre = brute::Vec3(position);
    if (i % 2) {
      const double radius = dice.between(0.05, 1.5);
      w.add(Sphere{radius}, position);
      a.half = brute::Vec3(radius);
      a.ball = true;
    } else {
      const glm::dvec3 size = dice.point(glm::dvec3(0.05), glm::dvec3(3.0));
      w.add(Box{size}, position, dice.between(-pi, pi));
      Solid& solid = w.world.solids.back();
      if (i % 4) solid.pitch = dice.between(-1.5, 1.5);
      if (i % 4) solid.roll = dice.between(-pi, pi);
      a.half = brute::Vec3(size) / brute::Real(2);
      a.turn = glm::mat<3, 3, brute::Real>(rotation_of(solid));
    }
    solids.push_back(a);
  }
  const Scene scene = traced(w);
  std::vector<Ray> rays;
  for (int i = 0; i < 100000; ++i) rays.push_back({dice.point(glm::dvec3(-12.0, -12.0, -4.0), glm::dvec3(12.0, 12.0, 4.0)), dice.direction()});
  CrossingLists lists;
  REQUIRE(scene.crossings(rays, infinity, lists, true) == 0);
  std::size_t wrong = 0, total = 0, starts_inside = 0;
  double worst = 0.0;
  struct Found {
    double enter, leave;
    std::uint32_t solid;
    bool starts_inside;
  };
  std::vector<Found> expected;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    expected.clear();
    for (std::uint32_t i = 0; i < solids.size(); ++i) {
      // Passed by more than rounding: a shortcut, nothing else.
      const glm::dvec3 o = rays[r].origin - glm::dvec3(solids[i].centre);
      const glm::dvec3 off = o - glm::dot(o, rays[r].direction) * rays[r].direction;
      const double reach = (solids[i].ball ? 1.0 : 1.8) * static_cast<double>(std::max({solids[i].half.x, solids[i].half.y, solids[i].half.z})) + 1e-3;
      if (glm::dot(off, off) > reach * reach) continue;
      const brute::Stretch s = solids[i].through(rays[r]);
      if (s.empty() || !(s.leave > 0)) continue;
      expected.push_back({std::max(0.0, static_cast<double>(s.enter)), static_cast<double>(s.leave), i, s.enter < 0});
    }
    std::sort(expected.begin(), expected.end(), [](const Found& a, const Found& b) {
      if (a.enter != b.enter) return a.enter < b.enter;
      return a.leave != b.leave ? a.leave < b.leave : a.solid < b.solid;
    });
    total += expected.size();
    const auto found = lists[r];
    if (found.size() != expected.size()) {
      ++wrong;
      continue;
    }
    for (std::size_t c = 0; c < found.size(); ++c) {
      wrong += found[c].solid != expected[c].solid || found[c].starts_inside != expected[c].starts_inside;
      starts_inside += found[c].starts_inside;
      worst = std::max({worst, std::abs(found[c].enter - expected[c].enter), std::abs(found[c].leave - expected[c].leave)});
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
  CHECK(total > 200000);
  CHECK(starts_inside > 10000);
}

TEST_CASE("two boxes that share a face: no ray slips between them, none along the face meets both") {
  HandMadeWorld w;
  w.add(Box{{1.0, 2.0, 2.0}}, {0.0, 0.0, 0.0});
  w.add(Box{{1.0, 2.0, 2.0}}, {1.0, 0.0, 0.0});
  HandMadeWorld meshes;
  meshes.add(MeshSolid{box_soup({1.0, 2.0, 2.0}).mesh()}, {0.0, 0.0, 0.0});
  meshes.add(MeshSolid{box_soup({1.0, 2.0, 2.0}).mesh()}, {1.0, 0.0, 0.0});
  for (const Scene& scene : {traced(w), traced(meshes)}) {
    Dice dice(72);
    for (int i = 0; i < 20000; ++i) {
      // Through the shared face x = 0.5, some of them through its edges' middles and its own diagonal.
      const double y = i % 5 == 0 ? 0.0 : dice.between(-0.99, 0.99), z = i % 5 == 0 ? 0.0 : i % 7 == 0 ? y : dice.between(-0.99, 0.99);
      glm::dvec3 along = dice.direction();
      along.x = std::abs(along.x) + 0.05;
      along = glm::normalize(along);
      const glm::dvec3 through(0.5, y, z);
      const Ray ray{through - 0.4 * along / std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)}) * 0.01, along};
      CrossingLists lists;
      scene.crossings({&ray, 1}, infinity, lists, true);
      REQUIRE(lists.items.size() == 2);
      CHECK(lists.items[0].solid == 0);
      CHECK(lists.items[1].solid == 1);
      CHECK(std::abs(lists.items[0].leave - lists.items[1].enter) <= 1e-12);
    }
  }
  // Along the shared face, and along an outer one: the half-open box has it or has it not, but once.
  const Scene scene = traced(w);
  for (const double z : {0.0, 0.5, -0.25}) {
    const Ray shared{{0.5, -5.0, z}, {0.0, 1.0, 0.0}};
    CrossingLists lists;
    scene.crossings({&shared, 1}, infinity, lists, true);
    REQUIRE(lists.items.size() == 1);
    CHECK(lists.items[0].enter == 4.0);
    CHECK(lists.items[0].leave == 6.0);
  }
}

TEST_CASE("the same world as boxes, as meshes and as a map: scans agree") {
  Dice dice(73);
  constexpr int cells = 60;
  constexpr double cell = 0.25;
  std::vector<std::string> rows(cells, std::string(cells, '.'));
  HandMadeWorld boxes, meshes, map;
  const auto add = [&](int column, int row, int columns, int rows_high) {
    const glm::dvec3 size(columns * cell, rows_high * cell, 2.5), middle((column + 0.5 * columns) * cell, (row + 0.5 * rows_high) * cell, 1.25);
    boxes.add(Box{size}, middle);
    meshes.add(MeshSolid{box_soup(size).mesh()}, middle);
    for (int r = row; r < row + rows_high; ++r)
      for (int c = column; c < column + columns; ++c) rows[static_cast<std::size_t>(cells - 1 - r)][static_cast<std::size_t>(c)] = '#';
  };
  add(0, 0, cells, 1);
  add(0, cells - 1, cells, 1);
  add(0, 1, 1, cells - 2);
  add(cells - 1, 1, 1, cells - 2);
  for (int i = 0; i < 25; ++i) {
    const int columns = 1 + static_cast<int>(dice.pick(6)), high = 1 + static_cast<int>(dice.pick(6));
    const int column = 1 + static_cast<int>(dice.pick(static_cast<std::uint32_t>(cells - 2 - columns))), row = 1 + static_cast<int>(dice.pick(static_cast<std::uint32_t>(cells - 2 - high)));
    add(column, row, columns, high);
  }
  map.add(map_of(rows, cell), glm::dvec3(0.0));
  const Scene a = traced(boxes), b = traced(meshes), c = traced(map);
  std::size_t scans = 0;
  double boxes_meshes = 0.0, boxes_map = 0.0;
  while (scans < 40) {
    const glm::dvec3 from = dice.point(glm::dvec3(0.5, 0.5, 0.5), glm::dvec3(14.5, 14.5, 0.5));
    if (in_matter(boxes.world, from)) continue;
    ++scans;
    std::vector<Ray> rays;
    for (int i = 0; i < 720; ++i) rays.push_back({from, {std::cos(radians(0.5 * i)), std::sin(radians(0.5 * i)), 0.0}});
    std::vector<Hit> p(rays.size()), q(rays.size()), r(rays.size());
    a.closest_hits(rays, Stops::everything, p);
    b.closest_hits(rays, Stops::everything, q);
    c.closest_hits(rays, Stops::everything, r);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      boxes_meshes = std::max(boxes_meshes, std::abs(p[i].range - q[i].range));
      boxes_map = std::max(boxes_map, std::abs(p[i].range - r[i].range));
    }
  }
  // The cells are where the boxes are, so there is nothing to lose to the cell size.
  CHECK(boxes_meshes <= 1e-9);
  CHECK(boxes_map <= 1e-9);

  // Turned by 30 degrees the map of it has stairs: then within a cell's diagonal at the incidence there.
  World turned = boxes.world;
  for (Solid& solid : turned.solids) {
    const double yaw = radians(30.0);
    solid.position = rotation_of(yaw, 0.0, 0.0) * solid.position;
    solid.yaw = yaw;
  }
  const auto box = extent(turned);
  constexpr double fine = 0.05;
  const auto grid = occupancy(turned, glm::dvec2(box->low) - 1.0, glm::dvec2(box->high) + 1.0, fine, 0.4, 0.6, Convention::any_overlap, false);
  REQUIRE(static_cast<bool>(grid));
  HandMadeWorld stairs;
  MapSolid stairs_map;
  stairs_map.grid = {grid->width, grid->height, fine, glm::dvec2(0.0), 0.0, {}};
  for (const std::uint8_t blocked : grid->blocked) stairs_map.grid.cells.push_back(blocked ? CellState::occupied : CellState::free);
  stairs_map.blocks = merge_cells(stairs_map);
  stairs.add(stairs_map, {grid->low, 0.0});
  const Scene exact = traced(turned), stepped = traced(stairs);
  std::size_t compared = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 from = dice.point(glm::dvec3(glm::dvec2(box->low), 0.5), glm::dvec3(glm::dvec2(box->high), 0.5));
    const double bearing_to = dice.between(-pi, pi);
    const Ray ray{from, {std::cos(bearing_to), std::sin(bearing_to), 0.0}};
    if (in_matter(stairs.world, from)) continue;
    Hit hit, hit_stairs;
    exact.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
    stepped.closest_hits({&ray, 1}, Stops::everything, {&hit_stairs, 1});
    if (hit.solid == no_solid) continue;
    ++compared;
    // The map holds all of the matter, and nothing that is a cell's diagonal away from it.
    CHECK(hit_stairs.range <= hit.range + 1e-9);
    const double depth = fine * std::sqrt(2.0), cosine = std::abs(glm::dot(hit.normal, ray.direction));
    outside += hit.range - hit_stairs.range > depth / std::max(cosine, 1e-3) + 1e-9;  // but for corners that are passed narrowly
  }
  CHECK(compared > 10000);
  CHECK(static_cast<double>(outside) < 0.03 * static_cast<double>(compared));
}

TEST_CASE("extrusions: ranges are those of a walk through the grid, cell by cell") {
  Dice dice(74);
  double worst = 0.0;
  std::size_t hits_seen = 0, wrong = 0;
  for (int world = 0; world < 10; ++world) {
    constexpr int size = 80;
    const double cell = dice.between(0.05, 0.5);
    std::vector<std::string> rows(size, std::string(size, '.'));
    for (auto& row : rows)
      for (char& letter : row) letter = dice.chance(0.1) ? '#' : '.';
    HandMadeWorld w;
    const MapSolid map = map_of(rows, cell);
    w.add(map, glm::dvec3(0.0));
    const Scene scene = traced(w);
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec2 from = dice.point(glm::dvec2(0.0), glm::dvec2(size * cell));
      const double bearing_to = dice.between(-pi, pi);
      const glm::dvec2 along(std::cos(bearing_to), std::sin(bearing_to));
      // The walk: Amanatides & Woo 1987.
      int column = static_cast<int>(from.x / cell), row = static_cast<int>(from.y / cell);
      const int step_x = along.x > 0.0 ? 1 : -1, step_y = along.y > 0.0 ? 1 : -1;
      double range = 0.0, expected = infinity;
      while (column >= 0 && row >= 0 && column < size && row < size) {
        if (map.matter(column, row)) {
          expected = range;
          break;
        }
        const double to_x = ((column + (step_x > 0)) * cell - from.x) / along.x, to_y = ((row + (step_y > 0)) * cell - from.y) / along.y;
        range = std::min(to_x, to_y);
        if (to_x < to_y) column += step_x;
        else row += step_y;
      }
      const Ray ray{{from, 1.0}, glm::normalize(glm::dvec3(along, 0.0))};
      Hit hit;
      scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
      if ((hit.solid == no_solid) != (expected == infinity)) ++wrong;
      else if (expected < infinity) worst = std::max(worst, std::abs(hit.range - expected));
      hits_seen += expected < infinity;
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);  // 1e-5 was asked for
  CHECK(hits_seen > 20000);
}

TEST_CASE("a million moves: no hull is ever in matter after a step, through thin walls and at any speed") {
  Dice dice(75);
  const Hull hull{0.3, 0.0, 0.6};
  std::size_t moves = 0, contacts = 0, long_moves = 0;
  double nearest_seen = infinity, deepest = infinity;
  for (int world = 0; world < 20; ++world) {
    HandMadeWorld w;
    for (int i = 0; i < 24; ++i) {
      const glm::dvec3 position = dice.point(glm::dvec3(-10.0, -10.0, -0.3), glm::dvec3(10.0, 10.0, 0.6));
      switch (i % 4) {
        case 0: w.add(Box{{dice.between(1.0, 6.0), 0.001, 1.0}}, position, dice.between(-pi, pi)); break;  // 1 mm
        case 1: w.add(Box{dice.point(glm::dvec3(0.05), glm::dvec3(1.5))}, position, dice.between(-pi, pi)); break;
        case 2: w.add(Sphere{dice.between(0.05, 0.8)}, position); break;
        default: w.add(Cylinder{dice.between(0.005, 0.5), dice.between(0.2, 2.0)}, position);
      }
    }
    const Scene scene = traced(w);
    const auto plans = brute::plans_between(w.world, hull.z_low, hull.z_high);
    const auto clearance_at = [&](const glm::dvec2& p) {
      double least = infinity;
      for (const auto& plan : plans) {
        const glm::dvec2 off = p - glm::dvec2(plan.plan.centre);
        if (std::hypot(off.x, off.y) > 5.0) continue;
        least = std::min(least, static_cast<double>(brute::distance(plan.plan, brute::Vec2(p))));
      }
      return least - hull.radius;
    };
    glm::dvec2 at(0.0);
    do at = dice.point(glm::dvec2(-9.0), glm::dvec2(9.0));
    while (clearance_at(at) <= 0.0);
    for (int i = 0; i < 50000; ++i) {
      // From a creep to 50 m in a step.
      const double length = std::pow(10.0, dice.between(-4.0, 1.7)), heading = std::hypot(at.x, at.y) > 12.0 ? bearing(-at) + dice.between(-0.5, 0.5) : dice.between(-pi, pi);
      const glm::dvec2 along = direction(heading);
      Clearance nearest;
      double least = infinity;
      const double contact = scene.first_contact(hull, [&](double s) { return glm::dvec3(at + s * along, 0.0); }, length, 0.0, nearest, least);
      ++moves;
      long_moves += length > 1.0;
      contacts += contact <= length;
      if (contact <= length) deepest = std::min(deepest, clearance_at(at + contact * along));
      // After a contact it stands a millimetre back, where it has just been.
      at += (contact <= length ? std::max(0.0, contact - 1e-3) : length) * along;
      const double clear = clearance_at(at);
      nearest_seen = std::min(nearest_seen, clear);
      if (clear <= -1e-9) REQUIRE(clear > -1e-9);
    }
  }
  CHECK(moves == 1000000);
  CHECK(contacts > 100000);
  CHECK(long_moves > 200000);
  CHECK(nearest_seen > 0.0);
  CHECK(deepest >= -1e-9);  // where it touches
}

// Meshes, tilted solids and instances as rays meet them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "brute_force.hpp"
#include "hand_made_mesh.hpp"
#include "thicket/worlds/scene.hpp"

using namespace thicket;

namespace {

std::vector<Crossing> all_of(const Scene& scene, const Ray& ray, double budget = infinity) {
  CrossingLists lists;
  CHECK(scene.crossings({&ray, 1}, budget, lists, budget == infinity) == 0);
  return lists.items;
}

Ray towards(const glm::dvec3& from, const glm::dvec3& target, double range_max = infinity) { return {from, glm::normalize(target - from), range_max}; }

/// Where a line is inside a convex mesh, by the planes of its triangles, in extended precision.
brute::Stretch through_convex(const Soup& soup, const Ray& ray) {
  brute::Stretch s;
  for (const glm::uvec3& t : soup.triangles) {
    const brute::Vec3 a(soup.vertices[t.x]), b(soup.vertices[t.y]), c(soup.vertices[t.z]);
    const brute::Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    s.keep_behind(normal, glm::dot(normal, a), brute::Vec3(ray.origin), brute::Vec3(ray.direction));
  }
  return s;
}

glm::dmat3 some_turn(Dice& dice) { return rotation_of(dice.between(-pi, pi), dice.between(-1.5, 1.5), dice.between(-pi, pi)); }

/// Compares one ray with the planes; a stretch shorter than `grazing` may be there or not.
struct ConvexTally {
  std::size_t wrong = 0, met = 0, inside = 0;
  double worst = 0.0;
  void take(const std::vector<Crossing>& found, const brute::Stretch& expected, double grazing = 1e-9) {
    const bool there = !expected.empty() && expected.leave > 0;
    const double long_enough = static_cast<double>(expected.leave - expected.enter);
    if (found.size() > 1 || (there && long_enough > grazing && expected.leave > grazing && found.empty()) || (!there && !found.empty() && found[0].leave - found[0].enter > grazing)) {
      ++wrong;
      return;
    }
    if (!there || found.empty()) return;
    ++met;
    inside += found[0].starts_inside;
    const double enter = std::max(0.0, static_cast<double>(expected.enter));
    if (long_enough > 1e-6) worst = std::max({worst, std::abs(found[0].enter - enter), std::abs(found[0].leave - static_cast<double>(expected.leave))});
  }
};

}  // namespace

TEST_CASE("a convex mesh is entered once and left once, wherever the ray is aimed") {
  Dice dice(31);
  for (const int fineness : {0, 2, 3}) {
    const Soup soup = sphere_soup(1.0, fineness).moved(some_turn(dice), dice.point(glm::dvec3(-3.0), glm::dvec3(3.0)));
    HandMadeWorld w;
    REQUIRE(soup.mesh()->closed);
    w.add(MeshSolid{soup.mesh()}, glm::dvec3(0.0));
    const Scene scene = traced(w);
    CHECK(scene.figures().triangles == soup.triangles.size());
    const glm::dvec3 centre = 0.5 * (soup.mesh()->low + soup.mesh()->high);
    ConvexTally tally;
    for (int i = 0; i < 6000; ++i) {
      const glm::dvec3 a = soup.vertices[dice.pick(static_cast<std::uint32_t>(soup.vertices.size()))];
      const glm::uvec3 t = soup.triangles[dice.pick(static_cast<std::uint32_t>(soup.triangles.size()))];
      const glm::dvec3 edge = 0.5 * (soup.vertices[t.x] + soup.vertices[t.y]);
      const glm::dvec3 target = i % 3 == 0 ? a : i % 3 == 1 ? edge : centre + 1.2 * dice.direction();
      const double away = i % 4 == 0 ? dice.between(0.0, 0.8) : dice.between(1.5, 10.0);  // a quarter starts inside
      const Ray ray = towards(centre + away * dice.direction(), target);
      tally.take(all_of(scene, ray), through_convex(soup, ray));
    }
    CAPTURE(fineness);
    CHECK(tally.wrong == 0);
    CHECK(tally.worst <= 1e-9);
    CHECK(tally.met > 3500);
    CHECK(tally.inside > 1000);
  }
}

TEST_CASE("rays along the edges and faces of a mesh, and from its corners, keep entrances and exits apart") {
  // No answer is right alone for a ray that lies in a face; but never is matter entered that is not left.
  const Soup soup = box_soup({2.0, 2.0, 2.0});
  HandMadeWorld w;
  w.add(MeshSolid{soup.mesh()}, glm::dvec3(0.0));
  const Scene scene = traced(w);
  std::vector<Ray> rays;
  for (const glm::dvec3& from : soup.vertices)
    for (const glm::dvec3& to : soup.vertices) {
      if (from == to) continue;
      for (const double back : {0.0, 0.5, 3.0}) rays.push_back({from - back * glm::normalize(to - from), glm::normalize(to - from)});
    }
  for (const Ray& ray : rays)
    for (const double range_max : {infinity, 100.0, 1.0}) {
      const auto found = all_of(scene, {ray.origin, ray.direction, range_max});
      REQUIRE(found.size() <= 1);
      if (found.empty()) continue;
      CHECK(found[0].leave > found[0].enter);
      if (range_max >= 100.0) CHECK(found[0].leave <= 10.0);  // it is left
    }
  // Through the body's diagonal, from a corner.
  const auto diagonal = all_of(scene, towards({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}));
  REQUIRE(diagonal.size() == 1);
  CHECK(diagonal[0].enter == doctest::Approx(0.0));
  CHECK(diagonal[0].leave == doctest::Approx(2.0 * std::sqrt(3.0)));
}

TEST_CASE("a box as a mesh, tilted, is the box") {
  Dice dice(32);
  HandMadeWorld boxes, meshes;
  std::vector<glm::dvec3> sizes;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 size = dice.point(glm::dvec3(0.1), glm::dvec3(3.0)), position = dice.point(glm::dvec3(-6.0), glm::dvec3(6.0));
    boxes.add(Box{size}, position, dice.between(-pi, pi));
    boxes.world.solids.back().pitch = dice.between(-1.5, 1.5);
    boxes.world.solids.back().roll = dice.between(-pi, pi);
    meshes.add(MeshSolid{box_soup(size / 4.0).mesh(), 4.0}, position);
    meshes.world.solids.back().yaw = boxes.world.solids.back().yaw;
    meshes.world.solids.back().pitch = boxes.world.solids.back().pitch;
    meshes.world.solids.back().roll = boxes.world.solids.back().roll;
    sizes.push_back(size);
  }
  const Scene box_scene = traced(boxes), mesh_scene = traced(meshes);
  double worst = 0.0, worst_normal = 0.0;
  std::size_t met = 0, wrong = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray{dice.point(glm::dvec3(-8.0), glm::dvec3(8.0)), dice.direction()};
    const auto a = all_of(box_scene, ray), b = all_of(mesh_scene, ray);
    if (a.size() != b.size()) {
      ++wrong;
      continue;
    }
    for (std::size_t c = 0; c < a.size(); ++c) {
      ++met;
      wrong += a[c].solid != b[c].solid || a[c].starts_inside != b[c].starts_inside;
      worst = std::max({worst, std::abs(a[c].enter - b[c].enter), std::abs(a[c].leave - b[c].leave)});
      worst_normal = std::max({worst_normal, glm::distance(a[c].enter_normal, b[c].enter_normal), glm::distance(a[c].leave_normal, b[c].leave_normal)});
    }
    // The tilted box itself, against the untilted one in its own frame.
    Hit hit;
    box_scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
    CHECK((hit.solid == no_solid) == a.empty());
    if (!a.empty()) CHECK(hit.range == a[0].enter);
  }
  CHECK(wrong == 0);
  CHECK(met > 2000);
  CHECK(worst <= 1e-9);
  CHECK(worst_normal <= 1e-9);

  HandMadeWorld alone;
  alone.world.materials = boxes.world.materials;
  for (std::size_t i = 0; i < sizes.size(); i += 10) {
    const Solid& solid = boxes.world.solids[i];
    HandMadeWorld one;
    one.add(Box{sizes[i]}, glm::dvec3(0.0));
    const auto pieces = brute::pieces_of(one.world);
    const glm::dmat3 turn = rotation_of(solid);
    for (int k = 0; k < 200; ++k) {
      const Ray outer{dice.point(glm::dvec3(-8.0), glm::dvec3(8.0)), glm::normalize(solid.position - dice.point(glm::dvec3(-8.0), glm::dvec3(8.0)))};
      const Ray inner{(outer.origin - solid.position) * turn, outer.direction * turn};
      const auto expected = brute::crossings(pieces, inner);
      auto found = all_of(box_scene, outer);
      std::erase_if(found, [i](const Crossing& c) { return c.solid != i; });
      REQUIRE(found.size() == expected.size());
      if (!found.empty()) CHECK(std::abs(found[0].enter - expected[0].enter) + std::abs(found[0].leave - expected[0].leave) <= 1e-9);
    }
  }
}

TEST_CASE("parts of one mesh that touch, overlap, or lie in one another") {
  const auto crossings_along_x = [](const Soup& soup) {
    HandMadeWorld w;
    w.add(MeshSolid{soup.mesh()}, glm::dvec3(0.0));
    REQUIRE(soup.mesh()->closed);
    return all_of(traced(w), {{-10.0, 0.013, 0.007}, {1.0, 0.0, 0.0}});
  };
  const glm::dmat3 as_is(1.0);
  Soup touching = box_soup({1.0, 1.0, 1.0});
  touching.add(box_soup({1.0, 1.0, 1.0}).moved(as_is, {1.0, 0.0, 0.0}));
  const auto one = crossings_along_x(touching);
  REQUIRE(one.size() == 1);
  CHECK(one[0].enter == 9.5);
  CHECK(one[0].leave == 11.5);

  Soup overlapping = box_soup({1.0, 1.0, 1.0});
  overlapping.add(box_soup({1.0, 1.0, 1.0}).moved(as_is, {0.5, 0.1, 0.1}));
  const auto joined = crossings_along_x(overlapping);
  REQUIRE(joined.size() == 1);
  CHECK(joined[0].leave == doctest::Approx(11.0));

  Soup hollow = box_soup({3.0, 3.0, 3.0});
  hollow.add(box_soup({1.0, 1.0, 1.0}).flipped());
  const auto shell = crossings_along_x(hollow);
  REQUIRE(shell.size() == 2);
  CHECK(shell[0].enter == 8.5);
  CHECK(shell[0].leave == 9.5);
  CHECK(shell[1].enter == 10.5);
  CHECK(shell[1].leave == 11.5);

  Soup nested = box_soup({3.0, 3.0, 3.0});
  nested.add(box_soup({1.0, 1.0, 1.0}));
  CHECK(crossings_along_x(nested).size() == 1);
}

TEST_CASE("a ray that starts inside a mesh knows it, however short it is and whatever ends it") {
  HandMadeWorld w;
  const auto foliage = w.material("foliage", 0.05, 1.0), wall = w.material("wall", 0.5, infinity);
  w.add(MeshSolid{sphere_soup(5.0, 3).mesh()}, glm::dvec3(0.0), 0.3, foliage);
  w.add(Box{{0.1, 10.0, 10.0}}, {2.0, 0.0, 0.0}, 0.0, wall);
  const Scene scene = traced(w);
  for (const glm::dvec3& from : {glm::dvec3(0.0), glm::dvec3(0.3, -0.2, 0.1)}) {
    const auto short_ray = all_of(scene, {from, {1.0, 0.0, 0.0}, 0.5}, 10.0);
    REQUIRE(short_ray.size() == 1);
    CHECK(short_ray[0].solid == 0);
    CHECK(short_ray[0].starts_inside);
    CHECK(short_ray[0].leave > 0.5);
    const auto to_wall = all_of(scene, {from, {1.0, 0.0, 0.0}, 50.0}, 10.0);
    REQUIRE(to_wall.size() == 2);
    CHECK(to_wall[0].starts_inside);
    CHECK(to_wall[0].leave > to_wall[1].enter);
    CHECK(to_wall[1].solid == 1);
    Hit hit;
    const Ray ray{from, {1.0, 0.0, 0.0}, 50.0};
    scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
    CHECK(hit.range == 0.0);
    CHECK(hit.solid == 0);
  }
  // From just outside of it nothing is started inside of.
  const auto outside = all_of(scene, {{-5.01, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.005}, 10.0);
  CHECK(outside.empty());
}

TEST_CASE("on the surface of a mesh: inward the ray enters at 0, outward it meets nothing") {
  HandMadeWorld w;
  w.add(MeshSolid{box_soup({2.0, 2.0, 2.0}).mesh()}, {10.0, 0.0, 0.0});
  const Scene scene = traced(w);
  Dice dice(33);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 from(9.0, dice.between(-0.9, 0.9), dice.between(-0.9, 0.9));
    glm::dvec3 inward = dice.direction();
    inward.x = std::abs(inward.x) + 0.01;
    inward = glm::normalize(inward);
    for (const double range_max : {infinity, 50.0, 0.5}) {
      const auto in = all_of(scene, {from, inward, range_max}, 100.0);
      REQUIRE(in.size() == 1);
      CHECK(in[0].enter == doctest::Approx(0.0));
      CHECK(all_of(scene, {from, {-inward.x, inward.y, inward.z}, range_max}, 100.0).empty());
    }
  }
}

TEST_CASE("an open mesh is a sheet of its stated thickness") {
  Soup sheet;
  sheet.vertices = {{0.0, -1.0, -1.0}, {0.0, 1.0, -1.0}, {0.0, 1.0, 1.0}, {0.0, -1.0, 1.0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  HandMadeWorld w;
  CHECK_FALSE(sheet.mesh()->closed);
  w.add(MeshSolid{sheet.mesh(), 1.0, 0.02}, {3.0, 0.0, 0.0});
  const Scene scene = traced(w);
  for (const double y : {0.0, 0.3}) {  // 0: along the edge that both triangles share
    const auto front = all_of(scene, {{0.0, y, y}, {1.0, 0.0, 0.0}});
    REQUIRE(front.size() == 1);
    CHECK(front[0].enter == doctest::Approx(3.0));
    CHECK(front[0].leave == doctest::Approx(3.02));
    CHECK(front[0].enter_normal.x == -1.0);
    CHECK(front[0].leave_normal.x == 1.0);
    const auto back = all_of(scene, {{6.0, y, y}, {-1.0, 0.0, 0.0}});
    REQUIRE(back.size() == 1);
    CHECK(back[0].leave - back[0].enter == doctest::Approx(0.02));
    CHECK(back[0].enter_normal.x == 1.0);
  }
  // At 60 degrees the way through is twice as long; along it, no longer than the triangle.
  const auto oblique = all_of(scene, {{3.0 - 0.5, -0.5 * std::sqrt(3.0), 0.1}, {0.5, 0.5 * std::sqrt(3.0), 0.0}});
  REQUIRE(oblique.size() == 1);
  CHECK(oblique[0].leave - oblique[0].enter == doctest::Approx(0.04));
  const double grazing = 1e-5;
  const auto flat = all_of(scene, towards({3.0 - grazing, -1.0, 0.0}, {3.0 + grazing, 1.0, 0.0}));
  REQUIRE(flat.size() == 1);
  CHECK(flat[0].leave - flat[0].enter <= 2.0 * std::sqrt(2.0) + 1e-9);
}

TEST_CASE("a thousand poses of one mesh are what a thousand meshes are") {
  Dice dice(34);
  const Soup soup = sphere_soup(0.4, 1);
  const auto shared = soup.mesh();
  HandMadeWorld instances, copies;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 position = dice.point(glm::dvec3(-20.0, -20.0, 0.0), glm::dvec3(20.0, 20.0, 3.0));
    const double scale = dice.between(0.2, 3.0);
    instances.add(MeshSolid{shared, scale}, position, dice.between(-pi, pi));
    Solid& solid = instances.world.solids.back();
    if (i % 2) solid.pitch = dice.between(-1.0, 1.0);
    if (i % 3) solid.roll = dice.between(-1.0, 1.0);
    copies.add(MeshSolid{soup.moved(rotation_of(solid), position, scale).mesh()}, glm::dvec3(0.0));
  }
  const Scene a = traced(instances), b = traced(copies);
  CHECK(a.figures().triangles == soup.triangles.size());
  CHECK(a.figures().instances == 1000);
  CHECK(b.figures().triangles == 1000 * soup.triangles.size());
  CHECK(10 * a.figures().memory_bytes < 8 * b.figures().memory_bytes);
  std::size_t met = 0, wrong = 0;
  double worst = 0.0, worst_clearance = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray{dice.point(glm::dvec3(-20.0, -20.0, 0.0), glm::dvec3(20.0, 20.0, 3.0)), dice.direction(), i % 2 ? infinity : 15.0};
    const auto p = all_of(a, ray), q = all_of(b, ray);
    met += p.size();
    if (p.size() != q.size()) {
      ++wrong;
      continue;
    }
    for (std::size_t c = 0; c < p.size(); ++c) {
      wrong += p[c].solid != q[c].solid || p[c].starts_inside != q[c].starts_inside;
      worst = std::max({worst, std::abs(p[c].enter - q[c].enter), std::isinf(p[c].leave) ? 0.0 : std::abs(p[c].leave - q[c].leave)});
    }
    const Hull hull{0.2, 0.1, 0.9};
    const Clearance near = a.clearance(hull, ray.origin, 5.0), same = b.clearance(hull, ray.origin, 5.0);
    CHECK((near.solid == no_solid) == (same.solid == no_solid));
    if (near.solid != no_solid) worst_clearance = std::max(worst_clearance, std::abs(near.distance - same.distance));
  }
  CHECK(wrong == 0);
  CHECK(met > 4000);
  CHECK(worst <= 1e-9);
  CHECK(worst_clearance <= 1e-9);
}

TEST_CASE("a mesh with map coordinates, and a mesh a million metres off, are as exact as one at the origin") {
  const glm::dvec3 far(512345.678, 5432109.876, 123.0);
  Dice dice(35);
  const Soup near = sphere_soup(2.0, 2);
  const Soup at_far = near.moved(glm::dmat3(1.0), far);
  HandMadeWorld here, coordinates, moved;
  here.add(MeshSolid{near.mesh()}, glm::dvec3(0.0));
  coordinates.add(MeshSolid{at_far.mesh()}, glm::dvec3(0.0));
  moved.add(MeshSolid{near.mesh()}, far);
  const Scene a = traced(here), b = traced(coordinates), c = traced(moved);
  for (int i = 0; i < 500; ++i) {
    const Ray ray = towards(10.0 * dice.direction(), dice.direction());
    const Ray far_ray{ray.origin + far, ray.direction};
    const auto p = all_of(a, ray), q = all_of(b, far_ray), r = all_of(c, far_ray);
    REQUIRE(p.size() == 1);
    REQUIRE(q.size() == 1);
    REQUIRE(r.size() == 1);
    CHECK(std::abs(p[0].enter - q[0].enter) <= 1e-7);  // the far vertices are rounded to 1e-9 m
    CHECK(std::abs(p[0].enter - r[0].enter) <= 1e-7);
  }
}

TEST_CASE("a hull and tilted boxes, cylinders and meshes") {
  Dice dice(36);
  const Hull hull{0.3, 0.0, 0.6};
  SUBCASE("a tilted box is the mesh of it") {
    double worst = 0.0;
    std::size_t near_ones = 0;
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 size = dice.point(glm::dvec3(0.1), glm::dvec3(2.0)), position = dice.point(glm::dvec3(-1.0), glm::dvec3(1.0));
      HandMadeWorld box, mesh;
      box.add(Box{size}, position, dice.between(-pi, pi));
      mesh.add(MeshSolid{box_soup(size).mesh()}, position);
      for (double Solid::*angle : {&Solid::pitch, &Solid::roll}) box.world.solids[0].*angle = dice.between(-1.5, 1.5);
      for (double Solid::*angle : {&Solid::yaw, &Solid::pitch, &Solid::roll}) mesh.world.solids[0].*angle = box.world.solids[0].*angle;
      const Scene a = traced(box), b = traced(mesh);
      for (int k = 0; k < 20; ++k) {
        const glm::dvec3 at = dice.point(glm::dvec3(-3.0, -3.0, -1.0), glm::dvec3(3.0, 3.0, 1.0));
        const Clearance p = a.clearance(hull, at, 10.0), q = b.clearance(hull, at, 10.0);
        REQUIRE((p.solid == no_solid) == (q.solid == no_solid));
        if (p.solid == no_solid) continue;
        ++near_ones;
        worst = std::max(worst, std::abs(std::max(p.distance, -hull.radius) - std::max(q.distance, -hull.radius)));
      }
    }
    CHECK(near_ones > 2000);
    CHECK(worst <= 1e-9);
  }
  SUBCASE("a tilted cylinder is, nearly, a prism of 720 faces") {
    double worst = 0.0;
    std::size_t near_ones = 0;
    for (int i = 0; i < 40; ++i) {
      const double radius = dice.between(0.05, 1.0), height = dice.between(0.1, 3.0);
      const glm::dvec3 position = dice.point(glm::dvec3(-1.0), glm::dvec3(1.0));
      Soup soup;
      constexpr int corners = 720;
      for (int k = 0; k < corners; ++k)
        for (const double z : {-0.5, 0.5}) soup.vertices.emplace_back(radius * std::cos(2 * pi * k / corners), radius * std::sin(2 * pi * k / corners), z * height);
      const auto at_corner = [](int k, int up) { return static_cast<std::uint32_t>(2 * (k % corners) + up); };
      for (int k = 0; k < corners; ++k) {
        soup.triangles.emplace_back(at_corner(k, 0), at_corner(k + 1, 0), at_corner(k + 1, 1));
        soup.triangles.emplace_back(at_corner(k, 0), at_corner(k + 1, 1), at_corner(k, 1));
        if (k > 0 && k + 1 < corners) {
          soup.triangles.emplace_back(at_corner(0, 1), at_corner(k, 1), at_corner(k + 1, 1));
          soup.triangles.emplace_back(at_corner(0, 0), at_corner(k + 1, 0), at_corner(k, 0));
        }
      }
      REQUIRE(soup.mesh()->closed);
      REQUIRE(signed_volume(*soup.mesh()) > 0.0);
      HandMadeWorld cylinder, mesh;
      cylinder.add(Cylinder{radius, height}, position, dice.between(-pi, pi));
      mesh.add(MeshSolid{soup.mesh()}, position);
      cylinder.world.solids[0].pitch = i % 5 == 0 ? 0.5 * pi : dice.between(-1.5, 1.5);
      cylinder.world.solids[0].roll = i % 7 == 0 ? 0.5 * pi : dice.between(-1.5, 1.5);
      for (double Solid::*angle : {&Solid::yaw, &Solid::pitch, &Solid::roll}) mesh.world.solids[0].*angle = cylinder.world.solids[0].*angle;
      const Scene a = traced(cylinder), b = traced(mesh);
      for (int k = 0; k < 20; ++k) {
        const glm::dvec3 at = dice.point(glm::dvec3(-3.0, -3.0, -1.0), glm::dvec3(3.0, 3.0, 1.0));
        const Clearance p = a.clearance(hull, at, 10.0), q = b.clearance(hull, at, 10.0);
        if ((p.solid == no_solid) != (q.solid == no_solid)) continue;  // only just touches the slab
        if (p.solid == no_solid) continue;
        ++near_ones;
        worst = std::max(worst, std::abs(p.distance - q.distance));
        const Ray ray = towards(at, position + 0.5 * radius * dice.direction());
        const auto c = all_of(a, ray), d = all_of(b, ray);
        REQUIRE(c.size() == d.size());
      }
    }
    CHECK(near_ones > 400);
    CHECK(worst <= 3e-3);  // a slab may cut the prism where the cylinder is 1e-5 m wider, and that much higher up it is wider still
  }
  SUBCASE("inside a closed mesh that is far larger than the hull") {
    HandMadeWorld w;
    w.add(MeshSolid{sphere_soup(5.0, 2).mesh()}, glm::dvec3(0.0));
    const Scene scene = traced(w);
    CHECK(scene.clearance(hull, {0.0, 0.0, 0.0}, 1.0).distance <= 0.0);
    CHECK(scene.clearance(hull, {0.0, 0.0, 0.0}, 1.0).solid == 0);
    CHECK(scene.clearance(hull, {8.0, 0.0, 0.0}, 100.0).distance == doctest::Approx(2.7).epsilon(0.02));
    CHECK(scene.clearance(hull, {8.0, 0.0, 0.0}, 1.0).solid == no_solid);
  }
}

TEST_CASE("moving solids are, at every time, where they are") {
  Dice dice(37);
  HandMadeWorld w;
  w.add(Box{{40.0, 0.2, 3.0}}, {0.0, 9.0, 0.0});
  const auto motion = [&](Motion::Mode mode, double spin) {
    Motion m;
    const double z = dice.between(0.0, 1.0);
    for (int i = 0; i < 4; ++i) m.points.emplace_back(dice.point(glm::dvec2(-8.0), glm::dvec2(8.0)), z);
    m.speed = dice.between(0.5, 3.0);
    m.start_s = dice.between(0.0, 2.0);
    m.spin = spin;
    m.mode = mode;
    return std::make_shared<const Motion>(m);
  };
  const auto mesh = box_soup({1.0, 0.4, 1.5}).mesh();
  for (int i = 0; i < 12; ++i) {
    if (i % 4 == 0) w.add(Box{{0.5, 1.0, 1.5}}, glm::dvec3(0.0), 0.4);
    if (i % 4 == 1) w.add(Sphere{0.5}, glm::dvec3(0.0));
    if (i % 4 == 2) w.add(Cylinder{0.3, 2.0}, glm::dvec3(0.0));
    if (i % 4 == 3) w.add(MeshSolid{mesh}, glm::dvec3(0.0));
    Solid& solid = w.world.solids.back();
    solid.motion = motion(static_cast<Motion::Mode>(i % 3), i % 2 ? 0.7 : 0.0);
    solid.position = solid.motion->points.front();
    if (i == 8) solid.roll = 0.5;
  }
  Scene scene = traced(w);
  CHECK(scene.moves());
  CHECK(scene.figures().moving == 12);
  const Scene before = scene;  // a copy stays where it is
  const Hull hull{0.2, 0.0, 0.5};
  for (const double time : {0.0, 0.1, 1.7, 5.0, 123.4, 7.0}) {
    scene.set_time(time);
    CHECK(scene.time() == time);
    const Scene still = traced(world_at(w.world, time));
    CHECK_FALSE(still.moves());
    std::size_t met = 0;
    for (int i = 0; i < 400; ++i) {
      const Ray ray{dice.point(glm::dvec3(-9.0, -9.0, 0.0), glm::dvec3(9.0, 9.0, 1.0)), dice.direction()};
      const auto a = all_of(scene, ray), b = all_of(still, ray);
      REQUIRE(a.size() == b.size());
      met += a.size();
      for (std::size_t c = 0; c < a.size(); ++c) {
        CHECK(a[c].solid == b[c].solid);
        CHECK(std::abs(a[c].enter - b[c].enter) + std::abs(a[c].leave - b[c].leave) <= 1e-9);
      }
      const Clearance p = before.clearance(hull, Moment{ray.origin, time}, 20.0), q = still.clearance(hull, ray.origin, 20.0);
      REQUIRE((p.solid == no_solid) == (q.solid == no_solid));
      if (p.solid != no_solid && std::max(p.distance, q.distance) > -0.2) CHECK(std::abs(p.distance - q.distance) <= 1e-9);
    }
    CHECK(met > 50);
  }
  // The copy has not moved, whatever its origin did.
  const Scene at_start = traced(world_at(w.world, 0.0));
  const Ray ray{{-9.0, -9.0, 0.3}, glm::normalize(glm::dvec3(1.0, 1.0, 0.0))};
  CHECK(all_of(before, ray).size() == all_of(at_start, ray).size());
}

TEST_CASE("ways of moving") {
  Solid solid;
  solid.yaw = 0.25;
  Motion m;
  m.points = {{0.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, {4.0, 3.0, 0.0}};
  m.speed = 2.0;
  m.start_s = 1.0;
  m.spin = 0.5;
  const auto at = [&](Motion::Mode mode, double time) {
    m.mode = mode;
    solid.motion = std::make_shared<const Motion>(m);
    return standing_at(solid, time);
  };
  using enum Motion::Mode;
  for (const auto mode : {once, loop, back_and_forth}) {
    CHECK(at(mode, 0.5).position == glm::dvec3(0.0, 0.0, 0.0));  // it waits
    CHECK(at(mode, 2.0).position == glm::dvec3(2.0, 0.0, 0.0));
    CHECK(at(mode, 4.0).position == glm::dvec3(4.0, 2.0, 0.0));
    CHECK(at(mode, 4.0).yaw == doctest::Approx(2.25));
  }
  CHECK(at(once, 100.0).position == glm::dvec3(4.0, 3.0, 0.0));
  CHECK(at(loop, 1.0 + 4.75).position.x == doctest::Approx(2.0));  // 9.5 m: 2.5 of the 5 m back to the first
  CHECK(at(loop, 1.0 + 4.75).position.y == doctest::Approx(1.5));
  CHECK(at(loop, 1.0 + 6.0 * 1000 + 1.0).position.x == doctest::Approx(2.0));
  CHECK(at(back_and_forth, 1.0 + 4.5).position.y == doctest::Approx(1.0));  // 9 m: 2 m back
  CHECK(at(back_and_forth, 1.0 + 7.0).position == glm::dvec3(0.0, 0.0, 0.0));
}

TEST_CASE("a solid that comes at a hull touches it, between steps too") {
  HandMadeWorld w;
  w.add(Sphere{0.5}, {10.0, 0.0, 0.3});
  Motion m;
  m.points = {{10.0, 0.0, 0.3}, {-10.0, 0.0, 0.3}};
  m.speed = 40.0;  // in one step of 0.5 s it is past the hull
  w.world.solids[0].motion = std::make_shared<const Motion>(m);
  const Scene scene = traced(w);
  const Hull hull{0.3, 0.0, 0.6};
  CHECK(scene.fastest() == 40.0);
  // The hull stands still, so all of the length is the solid's.
  const double step = 0.5, length = scene.fastest() * step;
  Clearance nearest;
  double least = infinity;
  const double contact = scene.first_contact(hull, [&](double s) { return Moment{glm::dvec3(0.0), step * s / length}; }, length, infinity, nearest, least);
  CHECK(contact == doctest::Approx(10.0 - 0.8).epsilon(1e-6));
  CHECK(nearest.solid == 0);
}

TEST_CASE("a hull in line with an upright sheet or side is as far from it as its edge") {
  const Hull hull{0.05, 0.0, 0.3};
  Dice dice(38);
  for (int i = 0; i < 500; ++i) {
    const double angle = dice.between(-pi, pi), near = dice.between(0.5, 2.0), far = near + dice.between(0.1, 2.0);
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0.0), up(0.0, 0.0, 2.5);
    Soup soup;
    soup.vertices = {near * along - 0.1 * up, far * along - 0.1 * up, far * along + up, near * along + up};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}};
    HandMadeWorld w;
    w.add(MeshSolid{soup.mesh()}, glm::dvec3(0.0));
    CHECK(traced(w).clearance(hull, glm::dvec3(0.0), 10.0).distance == doctest::Approx(near - hull.radius));
  }
}

TEST_CASE("rays from an edge, a corner or a re-entrant edge of a mesh go into matter or do not, whatever limits them") {
  // A cube, and an L: a prism with a re-entrant edge at x = y = 1.
  const auto l_shape = prism_mesh({{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}}, {}, 1.0);
  const auto in_l = [](const glm::dvec3& p) { return p.z > 0.0 && p.z < 1.0 && p.x > 0.0 && p.y > 0.0 && p.x < 2.0 && p.y < 2.0 && (p.x < 1.0 || p.y < 1.0); };
  HandMadeWorld w;
  w.add(MeshSolid{l_shape}, glm::dvec3(0.0));
  const Scene scene = traced(w);
  Dice dice(39);
  std::size_t inward = 0, outward = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 from = i % 4 == 0 ? glm::dvec3(1.0, 1.0, dice.between(0.1, 0.9)) : i % 4 == 1 ? glm::dvec3(0.0, 0.0, dice.between(0.1, 0.9)) : i % 4 == 2 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 1.0, 1.0);
    const glm::dvec3 along = dice.direction();
    if (std::min({std::abs(along.x), std::abs(along.y), std::abs(along.z)}) < 0.01) continue;
    const bool goes_in = in_l(from + 1e-6 * along);
    for (const double range_max : {infinity, 9.0, 0.5}) {
      const Ray ray{from, along, range_max};
      const auto found = all_of(scene, ray, 100.0);  // opaque: what lies behind the first entrance may be missing
      Hit hit;
      scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
      if (goes_in) {
        ++inward;
        REQUIRE(!found.empty());
        CHECK(found[0].enter == doctest::Approx(0.0));
        CHECK(hit.range == doctest::Approx(0.0));
      } else {
        ++outward;
        for (const Crossing& c : found) CHECK(c.enter > 1e-3);
        CHECK(hit.range > 1e-3);
        CHECK((hit.solid == no_solid) == found.empty());
      }
    }
  }
  CHECK(inward > 2000);
  CHECK(outward > 2000);
}

TEST_CASE("a scene with moving solids can be assigned over another") {
  const auto build = [](double x) {
    HandMadeWorld w;
    w.add(Box{{1.0, 1.0, 1.0}}, {x, 0.0, 0.0});
    Motion m;
    m.points = {{x, 0.0, 0.0}, {x + 5.0, 0.0, 0.0}};
    w.world.solids[0].motion = std::make_shared<const Motion>(m);
    return traced(w);
  };
  Scene scene = build(3.0);
  scene.set_time(1.0);
  scene = build(10.0);
  CHECK(all_of(scene, {{0.0, 0.1, 0.1}, {1.0, 0.0, 0.0}}).at(0).enter == doctest::Approx(9.5));
}

TEST_CASE("what cannot move is told, what has no matter may") {
  HandMadeWorld w;
  w.add(Box{{1.0, 1.0, 0.1}}, {0.0, 0.0, 3.0});
  Motion m;
  m.points = {{0.0, 0.0, 3.0}, {0.0, 0.0, 0.0}};
  w.world.solids[0].motion = std::make_shared<const Motion>(m);
  const auto falls = Scene::build(w.world);
  REQUIRE_FALSE(falls);
  CHECK(falls.error().message.find("moves up or down") != std::string::npos);
  w.world.materials[0].stops_motion = false;  // smoke may rise
  CHECK(static_cast<bool>(Scene::build(w.world)));

  HandMadeWorld empty;
  empty.add(map_of({"..", ".."}, 1.0), glm::dvec3(0.0));
  m.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  empty.world.solids[0].motion = std::make_shared<const Motion>(m);
  CHECK(static_cast<bool>(Scene::build(empty.world)));
}

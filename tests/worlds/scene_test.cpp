#include "thicket/worlds/scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "../hand_made_world.hpp"
#include "brute_force.hpp"

using namespace thicket;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Materials of every kind that tracing tells apart: what stops light, what stops motion, what a radar ray passes.
void add_materials(HandMadeWorld& w) {
  w.material("wall", 0.5, infinity);
  w.material("foliage", 0.05, 7.5);
  w.material("smoke", 1e-7, 0.05, true, false);
  w.material("glass", 0.1, 34.0, false, true);
  w.material("air curtain", 0.0, 0.0, false, false);
}

/// Balls, pillars and turned boxes that overlap and hold one another, in a room of 12 x 12 x 4 m about the origin.
HandMadeWorld jumble(Dice& dice, int count) {
  HandMadeWorld w;
  add_materials(w);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 position = dice.point(glm::dvec3(-6.0, -6.0, -2.0), glm::dvec3(6.0, 6.0, 2.0));
    const double yaw = dice.between(-pi, pi);
    const std::uint32_t material = dice.pick(5);
    switch (i % 3) {
      case 0:
        w.add(Sphere{dice.between(0.1, 1.5)}, position, yaw, material);
        break;
      case 1:
        w.add(Box{dice.point(glm::dvec3(0.1), glm::dvec3(3.0))}, position, yaw, material);
        break;
      default:
        w.add(Cylinder{dice.between(0.1, 1.0), dice.between(0.1, 3.0)}, position, yaw, material);
    }
  }
  return w;
}

std::vector<Ray> rays_through(Dice& dice, std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 origin = dice.point(glm::dvec3(-8.0, -8.0, -3.0), glm::dvec3(8.0, 8.0, 3.0));
    rays.push_back({origin, dice.direction(), dice.chance(0.5) ? infinity : dice.between(0.0, 10.0)});
  }
  return rays;
}

CrossingLists all_crossings(const Scene& scene, std::span<const Ray> rays) {
  CrossingLists lists;
  CHECK(scene.crossings(rays, infinity, lists, true) == 0);
  CHECK(lists.first.size() == rays.size() + 1);
  return lists;
}
std::vector<Crossing> all_crossings(const Scene& scene, const Ray& ray) {
  return all_crossings(scene, {&ray, 1}).items;
}

Hit closest(const Scene& scene, const Ray& ray, Stops stops = Stops::everything) {
  Hit hit;
  CHECK(scene.closest_hits({&ray, 1}, stops, {&hit, 1}) == 0);
  return hit;
}

/// The largest difference of two crossings in range (m); +inf if they are not of the same solid or not of the same kind.
double difference(const Crossing& a, const Crossing& b) {
  if (a.solid != b.solid || a.starts_inside != b.starts_inside) return infinity;
  return std::max(std::abs(a.enter - b.enter), std::abs(a.leave - b.leave));
}
double normals_differ(const Crossing& a, const Crossing& b) {
  return std::max(glm::distance(a.enter_normal, b.enter_normal), glm::distance(a.leave_normal, b.leave_normal));
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const glm::dvec3& a, const glm::dvec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const Crossing& a, const Crossing& b) {
  return same_bits(a.enter, b.enter) && same_bits(a.leave, b.leave) && a.solid == b.solid && a.starts_inside == b.starts_inside &&
         same_bits(a.enter_normal, b.enter_normal) && same_bits(a.leave_normal, b.leave_normal);
}
bool same_bits(const Hit& a, const Hit& b) {
  return same_bits(a.range, b.range) && a.solid == b.solid && same_bits(a.normal, b.normal);
}

bool stops_it(const Material& material, Stops stops) {
  return stops == Stops::everything || (stops == Stops::light ? material.stops_light : material.stops_motion);
}

/// The first of a ray's crossings whose matter stops what is named.
Hit first_of(const std::vector<Crossing>& crossings, const World& world, const Ray& ray, Stops stops) {
  for (const Crossing& c : crossings)
    if (stops_it(world.material_of(c.solid), stops)) return {c.enter, c.solid, c.starts_inside ? -ray.direction : c.enter_normal};
  return {};
}

}  // namespace

TEST_CASE("crossings are what brute force finds") {
  Dice dice(1);
  const World world = jumble(dice, 300).world;
  const Scene scene = traced(world);
  CHECK(scene.figures().parts == 300);
  CHECK(scene.figures().memory_bytes > 0);
  const auto rays = rays_through(dice, 20000);
  const auto lists = all_crossings(scene, rays);
  const auto pieces = brute::pieces_of(world);

  std::size_t wrong = 0, total = 0, from_inside = 0;
  double worst = 0.0, worst_normal = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto expected = brute::crossings(pieces, rays[i]);
    const auto found = lists[i];
    total += expected.size();
    if (found.size() != expected.size()) {
      ++wrong;
      continue;
    }
    for (std::size_t c = 0; c < expected.size(); ++c) {
      worst = std::max(worst, difference(found[c], expected[c]));
      worst_normal = std::max(worst_normal, normals_differ(found[c], expected[c]));
      from_inside += expected[c].starts_inside;
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
  CHECK(worst_normal <= 1e-7);  // of a ball of 0.1 m whose ranges are right to 1e-8
  // The dice gave something worth comparing.
  CHECK(total > 50000);
  CHECK(from_inside > 5000);
}

TEST_CASE("closest hits are what brute force finds, for all that can be stopped") {
  Dice dice(2);
  const World world = jumble(dice, 300).world;
  const Scene scene = traced(world);
  const auto rays = rays_through(dice, 20000);
  const auto pieces = brute::pieces_of(world);
  std::vector<std::vector<Crossing>> expected;
  for (const Ray& ray : rays) expected.push_back(brute::crossings(pieces, ray));

  for (const Stops stops : {Stops::everything, Stops::light, Stops::motion}) {
    CAPTURE(static_cast<int>(stops));
    std::vector<Hit> hits(rays.size());
    CHECK(scene.closest_hits(rays, stops, hits) == 0);
    std::size_t wrong = 0, misses = 0;
    double worst = 0.0, worst_normal = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit should = first_of(expected[i], world, rays[i], stops);
      misses += should.solid == no_solid;
      // Where a ray starts inside several solids, any of them is the first: only the range and the normal are told.
      if (hits[i].solid != should.solid && !(should.range == 0.0 && hits[i].solid != no_solid)) {
        ++wrong;
      } else if (should.solid != no_solid) {
        worst = std::max(worst, std::abs(hits[i].range - should.range));
        worst_normal = std::max(worst_normal, glm::distance(hits[i].normal, should.normal));
      } else {
        wrong += hits[i].range != infinity;
      }
    }
    CHECK(wrong == 0);
    CHECK(worst <= 1e-9);
    CHECK(worst_normal <= 1e-7);
    CHECK(misses > 100);
  }
}

TEST_CASE("what is small and far away is met as exactly as what is near") {
  // 5 cm things, 50 km away: single precision would be off by metres.
  constexpr double far = 50000.0;
  HandMadeWorld w;
  w.add(Sphere{0.05}, {far, 0.0, 0.0});
  w.add(Cylinder{0.05, 1.0}, {far, 10.0, 0.0});
  w.add(Box{{0.1, 0.1, 0.1}}, {far, 20.0, 0.0});
  const Scene scene = traced(w);
  const auto pieces = brute::pieces_of(w.world);
  for (const double off : {0.0, 0.01, 0.04})
    for (const double y : {0.0, 10.0, 20.0}) {
      CAPTURE(off);
      CAPTURE(y);
      const glm::dvec3 target(far, y + off, 0.02);
      const Ray ray{{-3.0, 1.0, 0.5}, glm::normalize(target - glm::dvec3(-3.0, 1.0, 0.5))};
      const auto found = all_crossings(scene, ray), expected = brute::crossings(pieces, ray);
      REQUIRE(expected.size() == 1);
      REQUIRE(found.size() == 1);
      CHECK(difference(found[0], expected[0]) <= 1e-9);
    }
}

TEST_CASE("boxes that share a face have no gap between them") {
  HandMadeWorld w;
  const auto left = w.add(Box{{1.0, 2.0, 2.0}}, {0.5, 0.0, 0.0});
  const auto right = w.add(Box{{1.0, 2.0, 2.0}}, {1.5, 0.0, 0.0});
  const Scene scene = traced(w);

  SUBCASE("dyadic: the exit of one is the entrance of the other, to the last bit") {
    Dice dice(3);
    int through_both = 0;
    for (int i = 0; i < 2000; ++i) {
      // Through a point of the shared face, from anywhere.
      const glm::dvec3 origin(std::round(dice.between(-6.0, -1.0) * 1024.0) / 1024.0, std::round(dice.between(-4.0, 4.0) * 1024.0) / 1024.0,
                              0.125);
      const glm::dvec3 target(1.0, dice.between(-0.9, 0.9), dice.between(-0.9, 0.9));
      const auto c = all_crossings(scene, Ray{origin, glm::normalize(target - origin)});
      REQUIRE(c.size() == 2);
      CHECK(c[0].solid == left);
      CHECK(c[1].solid == right);
      CHECK(same_bits(c[0].leave, c[1].enter));
      ++through_both;
    }
    CHECK(through_both == 2000);
  }
  SUBCASE("a ray along the shared face meets exactly one of them") {
    for (const double z : {0.0, 0.5, -0.999}) {
      const auto c = all_crossings(scene, Ray{{1.0, -5.0, z}, {0.0, 1.0, 0.0}});
      REQUIRE(c.size() == 1);
      CHECK(c[0].enter == 4.0);
      CHECK(c[0].leave == 6.0);
    }
    const auto up = all_crossings(scene, Ray{{1.0, 0.25, -5.0}, {0.0, 0.0, 1.0}});
    REQUIRE(up.size() == 1);
    CHECK(up[0].enter == 4.0);
    CHECK(up[0].leave == 6.0);
  }
  SUBCASE("a ray that starts on the shared face meets what lies ahead") {
    const auto ahead = all_crossings(scene, Ray{{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
    REQUIRE(ahead.size() == 1);
    CHECK(ahead[0].solid == right);
    CHECK(ahead[0].enter == 0.0);
    CHECK(ahead[0].leave == 1.0);
    CHECK_FALSE(ahead[0].starts_inside);
    CHECK(ahead[0].enter_normal == glm::dvec3(-1.0, 0.0, 0.0));
  }
}

TEST_CASE("turned boxes that share a face have no gap wider than rounding") {
  Dice dice(4);
  for (int i = 0; i < 500; ++i) {
    HandMadeWorld w;
    const double yaw = dice.between(-pi, pi);
    const glm::dvec3 position(dice.point(glm::dvec2(-5.0), glm::dvec2(5.0)), 0.0);
    const glm::dvec2 along = direction(yaw);
    const double a = dice.between(0.1, 2.0), b = dice.between(0.1, 2.0);
    w.add(Box{{a, 3.0, 3.0}}, position, yaw);
    w.add(Box{{b, 3.0, 3.0}}, position + glm::dvec3(0.5 * (a + b) * along, 0.0), yaw);
    const glm::dvec3 shared = position + glm::dvec3(0.5 * a * along, 0.0);
    const glm::dvec3 target = shared + glm::dvec3(dice.between(-0.5, 0.5) * glm::dvec2(-along.y, along.x), dice.between(-0.5, 0.5));
    const glm::dvec3 origin = shared - glm::dvec3(dice.between(3.0, 8.0) * along, dice.between(-0.5, 0.5));
    const auto c = all_crossings(traced(w), Ray{origin, glm::normalize(target - origin)});
    REQUIRE(c.size() == 2);
    CHECK(std::abs(c[0].leave - c[1].enter) < 1e-13 * 20.0);  // a few last places of numbers below 20
  }
}

TEST_CASE("rays aimed at the vertices and edges of a box") {
  Dice dice(5);
  int hit = 0, missed = 0;
  for (int i = 0; i < 2000; ++i) {
    HandMadeWorld w;
    const glm::dvec3 size = dice.point(glm::dvec3(0.5), glm::dvec3(2.0));
    const double yaw = dice.between(-pi, pi);
    const glm::dvec3 position = dice.point(glm::dvec3(-3.0), glm::dvec3(3.0));
    w.add(Box{size}, position, yaw);
    // A vertex, or a point of an edge.
    glm::dvec3 corner =
        0.5 * size * glm::dvec3(dice.chance(0.5) ? 1.0 : -1.0, dice.chance(0.5) ? 1.0 : -1.0, dice.chance(0.5) ? 1.0 : -1.0);
    if (i % 2 == 1) corner[static_cast<int>(dice.pick(3))] *= dice.between(-0.9, 0.9);
    const glm::dvec2 turned = Pose2{glm::dvec2(position), yaw}.to_outer(glm::dvec2(corner));
    const glm::dvec3 target(turned, position.z + corner.z);
    const glm::dvec3 origin = target + dice.between(2.0, 6.0) * dice.direction();
    const Ray ray{origin, glm::normalize(target - origin)};

    const auto found = all_crossings(traced(w), ray), expected = brute::crossings(brute::pieces_of(w.world), ray);
    const double chord = expected.empty() ? 0.0 : expected[0].leave - expected[0].enter;
    if (chord > 1e-9) {
      // It goes on into the box: an edge is no hole.
      ++hit;
      REQUIRE(found.size() == 1);
      CHECK(difference(found[0], expected[0]) <= 1e-9);
    } else {
      // It brushes the edge: met or not, but never for a way that is not there.
      ++missed;
      REQUIRE(found.size() <= 1);
      if (!found.empty()) {
        CHECK(found[0].leave - found[0].enter < 1e-9);
        CHECK(std::abs(found[0].enter - glm::distance(origin, target)) < 1e-9);
      }
    }
  }
  CHECK(hit > 500);
  CHECK(missed > 200);
}

TEST_CASE("rays that start inside, graze or miss") {
  HandMadeWorld w;
  const auto box = w.add(Box{{2.0, 2.0, 2.0}}, {0.0, 0.0, 0.0});
  w.add(Sphere{1.0}, {0.0, 10.0, 0.0});
  w.add(Cylinder{1.0, 2.0}, {0.0, 20.0, 0.0});
  const Scene scene = traced(w);

  SUBCASE("inside") {
    const auto c = all_crossings(scene, Ray{{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}});
    REQUIRE(c.size() == 1);
    CHECK(c[0].starts_inside);
    CHECK(c[0].enter == 0.0);
    CHECK(c[0].leave == 0.5);
    CHECK(c[0].enter_normal == glm::dvec3(0.0));
    CHECK(c[0].leave_normal == glm::dvec3(1.0, 0.0, 0.0));
    const Hit hit = closest(scene, Ray{{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}});
    CHECK(hit.range == 0.0);
    CHECK(hit.solid == box);
    CHECK(hit.normal == glm::dvec3(-1.0, 0.0, 0.0));
  }
  SUBCASE("inside, with no range at all") {
    const auto c = all_crossings(scene, Ray{{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0});
    REQUIRE(c.size() == 1);
    CHECK(c[0].leave == 0.5);  // it may lie beyond what was asked for
  }
  SUBCASE("on a surface, outward and inward") {
    CHECK(all_crossings(scene, Ray{{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}).empty());
    const auto inward = all_crossings(scene, Ray{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
    REQUIRE(inward.size() == 1);
    CHECK_FALSE(inward[0].starts_inside);
    CHECK(inward[0].enter == 0.0);
    CHECK(inward[0].leave == 2.0);
  }
  SUBCASE("a line that only touches what is round meets nothing") {
    CHECK(all_crossings(scene, Ray{{-5.0, 11.0, 0.0}, {1.0, 0.0, 0.0}}).empty());
    CHECK(all_crossings(scene, Ray{{-5.0, 21.0, 0.0}, {1.0, 0.0, 0.0}}).empty());
    CHECK(all_crossings(scene, Ray{{-5.0, 10.0, 1.0}, {1.0, 0.0, 0.0}}).empty());
    CHECK(all_crossings(scene, Ray{{1.0, 20.0, -5.0}, {0.0, 0.0, 1.0}}).empty());
  }
  SUBCASE("a line just inside what is round has its chord") {
    const double depth = 0x1p-20;  // chord: 2 sqrt(2 r d - d^2)
    const double chord = 2.0 * std::sqrt(2.0 * depth - depth * depth);
    for (const double y : {11.0 - depth, 21.0 - depth}) {
      const auto c = all_crossings(scene, Ray{{-5.0, y, 0.0}, {1.0, 0.0, 0.0}});
      REQUIRE(c.size() == 1);
      CHECK(c[0].enter == doctest::Approx(5.0 - 0.5 * chord).epsilon(1e-12));
      CHECK(c[0].leave == doctest::Approx(5.0 + 0.5 * chord).epsilon(1e-12));
    }
  }
  SUBCASE("range_max is met, what is beyond it is not") {
    CHECK(closest(scene, Ray{{-6.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0}).range == 5.0);
    CHECK(closest(scene, Ray{{-6.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, std::nextafter(5.0, 0.0)}).range == infinity);
    CHECK(all_crossings(scene, Ray{{-6.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, std::nextafter(5.0, 0.0)}).empty());
  }
  SUBCASE("misses") {
    for (const Ray& ray :
         {Ray{{-5.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}, Ray{{-5.0, 5.0, 0.0}, {1.0, 0.0, 0.0}}, Ray{{0.0, 0.0, 1.5}, {0.0, 0.0, 1.0}},
          Ray{{1e9, 0.0, 0.0}, {0.0, 1.0, 0.0}}, Ray{{-1e12, 1e12, 1e12}, {0.0, 0.0, 1.0}}}) {
      CHECK(all_crossings(scene, ray).empty());
      const Hit hit = closest(scene, ray);
      CHECK(hit.range == infinity);
      CHECK(hit.solid == no_solid);
    }
  }
  SUBCASE("along the axes of what is round, and through caps") {
    const auto c = all_crossings(scene, Ray{{0.25, 20.0, -5.0}, {0.0, 0.0, 1.0}});
    REQUIRE(c.size() == 1);
    CHECK(c[0].enter == 4.0);
    CHECK(c[0].leave == 6.0);
    CHECK(c[0].enter_normal == glm::dvec3(0.0, 0.0, -1.0));
    CHECK(c[0].leave_normal == glm::dvec3(0.0, 0.0, 1.0));
  }
}

TEST_CASE("rejected rays are counted and meet nothing") {
  HandMadeWorld w;
  w.add(Box{{100.0, 100.0, 100.0}}, {0.0, 0.0, 0.0});
  const Scene scene = traced(w);
  const Ray good{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0};
  const std::vector<Ray> bad = {
      {{not_a_number, 0.0, 0.0}, {1.0, 0.0, 0.0}},
      {{0.0, infinity, 0.0}, {1.0, 0.0, 0.0}},
      {{0.0, 0.0, -infinity}, {1.0, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {not_a_number, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {infinity, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {0.99999, 0.0, 0.0}},
      {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}},
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, -1.0},
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, not_a_number},
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, -infinity},
  };
  std::vector<Ray> rays;
  for (const Ray& ray : bad) {
    rays.push_back(good);
    rays.push_back(ray);
  }
  std::vector<Hit> hits(rays.size(), Hit{7.0, 7, glm::dvec3(7.0)});
  CHECK(scene.closest_hits(rays, Stops::everything, hits) == bad.size());
  CrossingLists lists;
  CHECK(scene.crossings(rays, infinity, lists, true) == bad.size());
  REQUIRE(lists.first.size() == rays.size() + 1);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const bool is_good = i % 2 == 0;
    CHECK(lists[i].size() == (is_good ? 1 : 0));
    CHECK(hits[i].range == (is_good ? 0.0 : infinity));
    CHECK(hits[i].solid == (is_good ? 0 : no_solid));
  }
  // What rounding leaves of a unit vector is not rejected.
  const Ray nearly{{0.0, 0.0, 0.0}, {1.0 + 0.9e-6, 0.0, 0.0}};
  CHECK(scene.closest_hits({&nearly, 1}, Stops::everything, {hits.data(), 1}) == 0);
  CHECK(scene.crossings({}, 10.0, lists) == 0);
  CHECK(lists.first == std::vector<std::uint32_t>{0});
  CHECK(lists.items.empty());
}

TEST_CASE("an empty world is open everywhere") {
  const Scene scene = traced(World{});
  CHECK(scene.figures().parts == 0);
  Dice dice(6);
  const auto rays = rays_through(dice, 20);
  CHECK(all_crossings(scene, rays).items.empty());
  std::vector<Hit> hits(rays.size());
  CHECK(scene.closest_hits(rays, Stops::everything, hits) == 0);
  for (const Hit& hit : hits) CHECK(hit.range == infinity);
  CHECK(scene.clearance({}, {0.0, 0.0, 0.0}, infinity).distance == infinity);
  const Ray bad{{not_a_number, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  CHECK(scene.closest_hits({&bad, 1}, Stops::everything, {hits.data(), 1}) == 1);

  // A map without matter is as empty.
  HandMadeWorld w;
  w.add(map_of({"..", ".."}, 1.0), {5.0, 5.0, 0.0});
  CHECK(all_crossings(traced(w), Ray{{0.0, 5.5, 1.0}, {1.0, 0.0, 0.0}}).empty());
}

TEST_CASE("a world with numbers that are not finite is not built") {
  for (const double wrong : {not_a_number, infinity, -infinity}) {
    CAPTURE(wrong);
    const auto fails = [&](const Shape& shape, const glm::dvec3& position = glm::dvec3(0.0), double yaw = 0.0) {
      HandMadeWorld w;
      w.add(Sphere{1.0}, {3.0, 0.0, 0.0});
      w.add(shape, position, yaw);
      const auto scene = Scene::build(w.world);
      return !scene && scene.error().message.find("solid 1") != std::string::npos &&
             scene.error().message.find("finite") != std::string::npos;
    };
    CHECK(fails(Sphere{wrong}));
    CHECK(fails(Sphere{1.0}, {wrong, 0.0, 0.0}));
    CHECK(fails(Sphere{1.0}, {0.0, 0.0, wrong}));
    CHECK(fails(Box{{1.0, wrong, 1.0}}));
    CHECK(fails(Box{{1.0, 1.0, 1.0}}, glm::dvec3(0.0), wrong));
    CHECK(fails(Box{{1.0, 1.0, wrong}}));
    CHECK(fails(Cylinder{wrong, 1.0}));
    CHECK(fails(Cylinder{1.0, wrong}));
    CHECK(fails(Wall{{{0.0, 0.0}, {wrong, 1.0}}, 0.1, 2.5}));
    CHECK(fails(Wall{{{0.0, 0.0}, {1.0, 1.0}}, wrong, 2.5}));
    CHECK(fails(Wall{{{0.0, 0.0}, {1.0, 1.0}}, 0.1, wrong}));
    CHECK(fails(map_of({"#"}, wrong)));
    CHECK(fails(map_of({"#"}, 1.0, wrong)));
  }
}

TEST_CASE("a world far out gives the ranges of the same world at home") {
  // Everything in steps of 2^-10 m, so that a shift by a power of two loses nothing. Two boxes hold the turned ones, whose corners are no
  // such numbers.
  Dice dice(7);
  const auto dyadic = [&](double low, double high) { return std::round(dice.between(low, high) * 1024.0) / 1024.0; };
  const auto dyadic_point = [&](double reach) { return glm::dvec3(dyadic(-reach, reach), dyadic(-reach, reach), dyadic(-2.0, 2.0)); };
  HandMadeWorld w;
  w.add(Box{{0.5, 0.5, 0.5}}, {-10.0, -10.0, -6.0});
  w.add(Box{{0.5, 0.5, 0.5}}, {10.0, 10.0, 6.0});
  for (int i = 0; i < 60; ++i) {
    w.add(Sphere{dyadic(0.125, 1.5)}, dyadic_point(6.0));
    w.add(Box{{dyadic(0.25, 3.0), dyadic(0.25, 3.0), dyadic(0.25, 3.0)}}, dyadic_point(6.0), dice.between(-pi, pi));
    w.add(Cylinder{dyadic(0.125, 1.0), dyadic(0.25, 3.0)}, dyadic_point(6.0));
  }
  std::vector<Ray> rays;
  for (int i = 0; i < 5000; ++i) rays.push_back({dyadic_point(8.0), dice.direction(), dice.chance(0.5) ? infinity : dyadic(0.0, 20.0)});
  const auto at_home = all_crossings(traced(w), rays);
  CHECK(at_home.items.size() > 10000);

  const auto shifted = [&](const glm::dvec3& offset) {
    World world = w.world;
    for (Solid& solid : world.solids) solid.position += offset;
    std::vector<Ray> moved = rays;
    for (Ray& ray : moved) ray.origin += offset;
    return all_crossings(traced(world), moved);
  };

  SUBCASE("at 2^20 m, to the last bit") {
    const auto far_out = shifted(glm::dvec3(0x1p20, -0x1p20, 0x1p20));
    REQUIRE(far_out.first == at_home.first);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < at_home.items.size(); ++i) differ += !same_bits(at_home.items[i], far_out.items[i]);
    CHECK(differ == 0);
  }
  SUBCASE("at 1000000.1 m, to what rounding makes of a grazing ray") {
    // There a position is a multiple of 2^-33 m and so off by 2^-34 along each axis, of a solid and of a ray: by e = 2 sqrt(3) 2^-34 at
    // most. The least chord of a ball of radius r that this can make or take away is 2 sqrt(2 r e), which is 4.9e-5 m for r = 1.5 m; its
    // ends move by half of that.
    constexpr double most = 3e-5;
    const auto far_out = shifted(glm::dvec3(1e6 + 0.1, 1e6 + 0.1, 1e6 + 0.1));
    const auto whole = [](std::span<const Crossing> list) {
      std::vector<Crossing> kept;
      for (const Crossing& c : list)
        if (c.leave - c.enter > 2.0 * most) kept.push_back(c);
      std::sort(kept.begin(), kept.end(), [](const Crossing& a, const Crossing& b) { return a.solid < b.solid; });
      return kept;
    };
    double worst = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto a = whole(at_home[i]), b = whole(far_out[i]);
      REQUIRE(a.size() == b.size());
      for (std::size_t c = 0; c < a.size(); ++c) worst = std::max(worst, difference(a[c], b[c]));
    }
    CHECK(worst <= most);
  }
}

TEST_CASE("an answer depends on its own ray alone") {
  Dice dice(8);
  const Scene scene = traced(jumble(dice, 200));
  const auto rays = rays_through(dice, 1000);
  for (const double budget : {infinity, 10.0}) {
    CAPTURE(budget);
    CrossingLists together;
    scene.crossings(rays, budget, together);
    std::vector<Hit> hits(rays.size());
    scene.closest_hits(rays, Stops::light, hits);
    for (const std::size_t size : {1, 2, 3, 7, 8, 9, 64, 999}) {
      CAPTURE(size);
      std::size_t differ = 0;
      for (std::size_t first = 0; first < rays.size(); first += size) {
        const auto some = std::span(rays).subspan(first, std::min(size, rays.size() - first));
        CrossingLists lists;
        scene.crossings(some, budget, lists);
        std::vector<Hit> some_hits(some.size());
        scene.closest_hits(some, Stops::light, some_hits);
        for (std::size_t i = 0; i < some.size(); ++i) {
          differ += !same_bits(some_hits[i], hits[first + i]);
          differ +=
              !std::ranges::equal(lists[i], together[first + i], [](const Crossing& a, const Crossing& b) { return same_bits(a, b); });
        }
      }
      CHECK(differ == 0);
    }
    // Nor on the order of the rays.
    const std::vector<Ray> backward(rays.rbegin(), rays.rend());
    CrossingLists lists;
    scene.crossings(backward, budget, lists);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      differ += !std::ranges::equal(lists[i], together[rays.size() - 1 - i],
                                    [](const Crossing& a, const Crossing& b) { return same_bits(a, b); });
    CHECK(differ == 0);
  }
}

TEST_CASE("copies of a scene share it") {
  HandMadeWorld w;
  w.add(Sphere{1.0}, {5.0, 0.0, 0.0});
  const Scene scene = traced(w);
  const Scene copy = scene;
  CHECK(&copy.world() == &scene.world());
  CHECK(closest(copy, Ray{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}).range == 4.0);
}

namespace {

/// Where a ray with a budget is exhausted: matter's loss is integrated from change to change, and of overlapping solids the highest
/// attenuation counts.
double exhaustion(const std::vector<Crossing>& crossings, const World& world, double budget) {
  std::vector<double> changes = {0.0};
  for (const Crossing& c : crossings) {
    changes.push_back(c.enter);
    changes.push_back(c.leave);
  }
  std::sort(changes.begin(), changes.end());
  double lost = 0.0;
  for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
    const double middle = 0.5 * (changes[i] + changes[i + 1]);
    double highest = 0.0;
    for (const Crossing& c : crossings)
      if (c.enter < middle && middle < c.leave) highest = std::max(highest, world.material_of(c.solid).attenuation_db_per_m);
    if (highest == 0.0) continue;
    if (lost + highest * (changes[i + 1] - changes[i]) >= budget)
      return highest == infinity ? changes[i] : changes[i] + (budget - lost) / highest;
    lost += highest * (changes[i + 1] - changes[i]);
  }
  return infinity;
}

}  // namespace

TEST_CASE("a penetration budget loses nothing that lies before the point of exhaustion") {
  Dice dice(9);
  HandMadeWorld w = jumble(dice, 150);
  // Walls have several parts each, so that one of them alone must not end a ray too early.
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 a = dice.point(glm::dvec2(-6.0), glm::dvec2(6.0)), b = a + dice.between(1.0, 4.0) * direction(dice.between(-pi, pi));
    w.add(Wall{{a, b, b + dice.between(1.0, 4.0) * direction(dice.between(-pi, pi))}, dice.between(0.05, 1.0), 6.0}, {0.0, 0.0, -3.0}, 0.0,
          dice.pick(5));
  }
  const World& world = w.world;
  const Scene scene = traced(world);
  const auto rays = rays_through(dice, 3000);
  const auto everything = all_crossings(scene, rays);
  for (const double budget : {0.0, 0.5, 3.0, 10.0, 60.0, infinity}) {
    CAPTURE(budget);
    CrossingLists lists;
    CHECK(scene.crossings(rays, budget, lists) == 0);
    std::size_t wrong = 0, exhausted = 0, left_out = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::vector<Crossing> all(everything[i].begin(), everything[i].end());
      const double end = exhaustion(all, world, budget);
      exhausted += end < rays[i].range_max;
      left_out += all.size() - lists[i].size();
      const auto before_end = [&](std::span<const Crossing> list) {
        std::vector<Crossing> kept;
        for (Crossing c : list) {
          if (c.enter >= end) continue;
          c.leave = std::min(c.leave, end);  // how far a solid goes on behind that point may be left out too
          if (c.leave == end) c.leave_normal = glm::dvec3(0.0);
          kept.push_back(c);
        }
        std::sort(kept.begin(), kept.end(), [](const Crossing& a, const Crossing& b) {
          return a.enter != b.enter ? a.enter < b.enter : a.leave != b.leave ? a.leave < b.leave : a.solid < b.solid;
        });
        return kept;
      };
      const auto expected = before_end(all), found = before_end(lists[i]);
      wrong += !std::ranges::equal(found, expected, [](const Crossing& a, const Crossing& b) { return same_bits(a, b); });
      // And it is still told that the ray ends: the solids that use it up are there to their ends or to that point.
      wrong += end != infinity && !(std::abs(exhaustion({lists[i].begin(), lists[i].end()}, world, budget) - end) <= 1e-9);
    }
    CHECK(wrong == 0);
    CHECK(exhausted > 500);
    CHECK((budget == infinity || left_out > 1000));
  }
}

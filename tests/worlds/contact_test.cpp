// Clearance and contact of a hull.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "brute_force.hpp"
#include "thicket/worlds/truth.hpp"

using namespace thicket;

namespace {

/// Contact begins at this clearance (scene.hpp).
constexpr double touching = 1e-6;

/// A hall of 60 x 60 m with walls of 1 mm, pillars, boxes, balls in the air and on the ground, a map, and some smoke that stops nothing.
HandMadeWorld hall(Dice& dice) {
  HandMadeWorld w;
  const auto hard = w.material("hard", 0.5, infinity);
  const auto smoke = w.material("smoke", 1e-7, 0.05, true, false);
  const auto material = [&] { return dice.chance(0.8) ? hard : smoke; };
  const auto place = [&] { return glm::dvec3(dice.point(glm::dvec2(-30.0), glm::dvec2(30.0)), dice.between(-1.0, 2.0)); };
  for (int i = 0; i < 12; ++i) {
    w.add(Sphere{dice.between(0.1, 2.0)}, place(), 0.0, material());
    w.add(Box{dice.point(glm::dvec3(0.05), glm::dvec3(4.0, 4.0, 2.0))}, place(), dice.between(-pi, pi), material());
    w.add(Cylinder{dice.between(0.02, 1.0), dice.between(0.2, 3.0)}, place(), 0.0, material());
    const glm::dvec2 a = dice.point(glm::dvec2(-30.0), glm::dvec2(30.0)), b = a + dice.between(1.0, 8.0) * direction(dice.between(-pi, pi));
    w.add(Wall{{a, b, b + dice.between(1.0, 8.0) * direction(dice.between(-pi, pi))}, 0.001, 2.5}, {0.0, 0.0, dice.between(-2.0, 1.0)}, 0.0,
          material());
  }
  w.add(map_of({"##..#", "#...#", "..#..", "#####"}, 0.7, 1.5), {5.0, 5.0, 0.0}, 0.4, hard);
  return w;
}

double true_distance(const std::vector<brute::PlanOfSolid>& plans, const glm::dvec3& position) {
  brute::Real least = infinity;
  for (const auto& p : plans) least = std::min(least, brute::distance(p.plan, brute::Vec2(position)));
  return static_cast<double>(least);
}

/// Where the axis of a hull that moves straight first comes nearer to matter than `grow`, as far as `length`.
double first_nearer(const std::vector<brute::PlanOfSolid>& plans, const glm::dvec3& start, const glm::dvec2& along, double grow,
                    double length) {
  brute::Real first = infinity;
  for (const auto& p : plans) first = std::min(first, brute::first_nearer(p.plan, brute::Vec2(start), brute::Vec2(along), grow));
  return first <= length ? static_cast<double>(first) : infinity;
}

struct Move {
  double contact;
  Clearance nearest;
  double least = infinity;
};
Move straight(const Scene& scene, const Hull& hull, const glm::dvec3& start, const glm::dvec2& along, double length, double limit = 0.0) {
  Move move;
  const auto position_at = [&](double s) { return start + glm::dvec3(s * along, 0.0); };
  move.contact = scene.first_contact(hull, position_at, length, limit, move.nearest, move.least);
  return move;
}

}  // namespace

TEST_CASE("clearance of a hull from each shape, by hand") {
  const Hull hull{0.25, 0.0, 0.5};
  const auto clearance_of = [&](const Shape& shape, const glm::dvec3& position, double yaw = 0.0) {
    HandMadeWorld w;
    w.add(shape, position, yaw);
    return traced(w).clearance(hull, {0.0, 0.0, 0.0}, infinity).distance;
  };
  CHECK(clearance_of(Sphere{1.0}, {3.0, 4.0, 0.25}) == 3.75);
  CHECK(clearance_of(Sphere{1.0}, {3.0, 4.0, 1.1}) ==
        doctest::Approx(5.0 - 0.8 - 0.25).epsilon(1e-15));  // its circle 0.6 m under its middle
  CHECK(clearance_of(Sphere{1.0}, {3.0, 4.0, -0.6}) == doctest::Approx(5.0 - 0.8 - 0.25).epsilon(1e-15));
  CHECK(clearance_of(Cylinder{1.0, 2.0}, {3.0, 4.0, 0.0}) == 3.75);
  CHECK(clearance_of(Box{{2.0, 2.0, 2.0}}, {4.0, 0.5, 0.0}) == 2.75);
  CHECK(clearance_of(Box{{2.0, 2.0, 2.0}}, {4.0, 5.0, 0.0}) == doctest::Approx(5.0 - 0.25).epsilon(1e-15));
  CHECK(clearance_of(Box{{2.0, 2.0, 2.0}}, {4.0, 0.0, 0.0}, pi / 4) == doctest::Approx(4.0 - std::numbers::sqrt2 - 0.25).epsilon(1e-14));
  CHECK(clearance_of(Wall{{{-5.0, 0.0}, {5.0, 0.0}}, 0.5, 1.0}, {0.0, 3.0, 0.0}) == doctest::Approx(2.5).epsilon(1e-15));
  CHECK(clearance_of(Wall{{{3.0, 4.0}, {30.0, 4.0}}, 2.0, 1.0}, {0.0, 0.0, 0.0}) ==
        doctest::Approx(std::hypot(3.0, 3.0) - 0.25).epsilon(1e-14));
  CHECK(clearance_of(map_of({".#", ".."}, 1.0), {2.0, -1.0, 0.0}) == 2.75);
  // Overlapped: the axis 0.125 m from a face, and inside.
  CHECK(clearance_of(Box{{2.0, 2.0, 2.0}}, {1.125, 0.0, 0.0}) == -0.125);
  CHECK(clearance_of(Box{{2.0, 2.0, 2.0}}, {0.5, 0.0, 0.0}) <= -0.25);
  CHECK(clearance_of(Sphere{1.0}, {0.5, 0.0, 0.25}) <= -0.25);
}

TEST_CASE("a hull passes under and over, and meets what shares any of its heights") {
  HandMadeWorld w;
  w.add(Box{{2.0, 2.0, 1.0}}, {2.0, 0.0, 1.5});  // from 1 m to 2 m
  const Scene scene = traced(w);
  const auto meets = [&](double z_low, double z_high, double z) {
    return scene.clearance({0.5, z_low, z_high}, {0.0, 0.0, z}, infinity).distance == 0.5;
  };
  CHECK(meets(0.0, 1.5, 0.0));
  CHECK(meets(0.0, 3.0, 0.0));
  CHECK(meets(1.4, 1.6, 0.0));
  CHECK(meets(0.0, 0.5, 1.75));
  CHECK(meets(0.3, 0.5, 0.51));
  CHECK_FALSE(meets(0.0, 0.99, 0.0));
  CHECK_FALSE(meets(2.01, 3.0, 0.0));
  CHECK_FALSE(meets(0.0, 0.5, 0.49));
  CHECK_FALSE(meets(0.1, 0.5, 1.91));
  // Standing on it, or just fitting under it, is no contact.
  CHECK_FALSE(meets(0.0, 1.0, 0.0));
  CHECK_FALSE(meets(0.0, 1.0, 2.0));
}

TEST_CASE("clearance is what brute force finds, as far as its limit, and matter that does not stop motion has none") {
  Dice dice(21);
  const HandMadeWorld w = hall(dice);
  const Scene scene = traced(w);
  std::size_t near_ones = 0, inside_ones = 0, beyond = 0, wrong = 0;
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Hull hull{dice.between(0.05, 1.0), dice.between(0.0, 0.3), dice.between(0.31, 1.5)};
    const double z = dice.between(-1.0, 2.0);
    const auto plans = brute::plans_between(w.world, z + hull.z_low, z + hull.z_high);
    for (int k = 0; k < 50; ++k) {
      const glm::dvec3 position(dice.point(glm::dvec2(-32.0), glm::dvec2(32.0)), z);
      const double limit = dice.chance(0.5) ? infinity : dice.between(0.0, 4.0);
      const Clearance found = scene.clearance(hull, position, limit);
      const double distance = true_distance(plans, position) - hull.radius;
      if (distance > limit) {
        ++beyond;
        wrong += found.distance != infinity || found.solid != no_solid;
      } else if (distance > -hull.radius) {
        ++near_ones;
        worst = std::max(worst, std::abs(found.distance - distance));
        wrong += found.solid == no_solid || !w.world.material_of(found.solid).stops_motion;
      } else {
        ++inside_ones;
        wrong += !(found.distance <= -hull.radius);
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
  CHECK(near_ones > 3000);
  CHECK(inside_ones > 100);
  CHECK(beyond > 1000);
}

TEST_CASE("clearance tells the solid that is nearest, and of equals the first") {
  HandMadeWorld w;
  const auto smoke = w.material("smoke", 1e-7, 0.05, true, false), hard = w.material("hard", 0.5, infinity);
  w.add(Cylinder{1.0, 2.0}, {1.5, 0.0, 0.0}, 0.0, smoke);
  const auto right = w.add(Cylinder{1.0, 2.0}, {3.0, 0.0, 0.0}, 0.0, hard);
  w.add(Cylinder{1.0, 2.0}, {-3.0, 0.0, 0.0}, 0.0, hard);
  const auto top = w.add(Box{{1.0, 1.0, 1.0}}, {0.0, 2.25, 0.0}, 0.0, hard);
  const Scene scene = traced(w);
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {0.0, 0.0, 0.0}, infinity).solid == top);
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {0.0, -1.0, 0.0}, infinity).solid == right);
}

TEST_CASE("clearance of a hull that is far from its world") {
  HandMadeWorld w;
  w.add(Cylinder{1.0, 2.0}, {1000000.1, 0.0, 0.0});
  const Scene scene = traced(w);
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {1000003.1, 4.0, 0.0}, infinity).distance == doctest::Approx(3.5).epsilon(1e-9));
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {0.1, 0.0, 0.0}, infinity).distance == doctest::Approx(1e6 - 1.5).epsilon(1e-15));
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {0.1, 0.0, 0.0}, 1e5).distance == infinity);
  CHECK(scene.clearance({0.5, 0.0, 0.5}, {NAN, 0.0, 0.0}, infinity).distance == infinity);
}

TEST_CASE("straight moves end where they touch: nothing is tunnelled through, nothing is entered") {
  Dice dice(22);
  const HandMadeWorld w = hall(dice);
  const Scene scene = traced(w);
  std::size_t contacts = 0, clear = 0, too_early = 0, too_late = 0, entered = 0, in_truth = 0;
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Hull hull{dice.between(0.2, 0.5), dice.between(0.0, 0.3), dice.between(0.31, 1.5)};
    const double z = dice.between(-1.0, 2.0);
    const auto plans = brute::plans_between(w.world, z + hull.z_low, z + hull.z_high);
    for (int k = 0; k < 100; ++k) {
      glm::dvec3 start;
      do start = {dice.point(glm::dvec2(-32.0), glm::dvec2(32.0)), z};
      while (true_distance(plans, start) < hull.radius + 2.0 * touching);
      const glm::dvec2 along = direction(dice.between(-pi, pi));
      const double length = dice.chance(0.5) ? 100.0 : dice.chance(0.5) ? dice.between(0.5, 5.0) : 0.05;
      const Move move = straight(scene, hull, start, along, length);

      // Clearance falls below 1e-6 m at `earliest`, and matter itself begins at `latest`. (A way that dips into the last micrometre by no
      // more than 1e-8 m may be taken for either.)
      const double earliest = first_nearer(plans, start, along, hull.radius + touching + 1e-8, length);
      const double latest = first_nearer(plans, start, along, hull.radius + touching - 1e-8, length);
      too_early += move.contact < earliest - 1e-9;
      too_late += move.contact > latest + 1e-5;
      if (latest == infinity) {
        ++clear;
      } else {
        ++contacts;
        worst = std::max(worst, move.contact - latest);
      }
      const double s = std::min(move.contact, length);
      const glm::dvec3 end = start + glm::dvec3(s * along, 0.0);
      entered += true_distance(plans, end) < hull.radius - 1e-9;
      if (move.contact < infinity)
        entered += !(move.nearest.distance < touching && move.nearest.distance > -1e-9 && move.nearest.solid != no_solid);
      // By code that shares nothing with contact: no point of the hull is in matter where it ends.
      if (k % 10 == 0)
        for (int spoke = 0; spoke < 12; ++spoke) {
          const glm::dvec3 rim = end + glm::dvec3((hull.radius - 1e-8) * direction(spoke * pi / 6), dice.between(hull.z_low, hull.z_high));
          in_truth += in_matter(w.world, rim, true);
        }
    }
  }
  CHECK(too_early == 0);
  CHECK(too_late == 0);
  CHECK(worst <= 1e-5);
  CHECK(entered == 0);
  CHECK(in_truth == 0);
  CHECK(contacts > 3000);
  CHECK(clear > 3000);
}

TEST_CASE("a wall of 1 mm stops any step, at any angle, at the place that geometry gives") {
  HandMadeWorld w;
  w.add(Wall{{{0.0, -300.0}, {0.0, 300.0}}, 0.001, 2.5}, {0.0, 0.0, 0.0});
  const Scene scene = traced(w);
  const Hull hull{0.25, 0.0, 0.5};
  Dice dice(23);
  for (int i = 0; i < 1000; ++i) {
    const double from_wall = dice.between(0.2506, 60.0), angle = dice.between(-1.3, 1.3);
    const Move move = straight(scene, hull, {-from_wall, dice.between(-50.0, 50.0), 0.0}, direction(angle), 300.0);
    const double expected = (from_wall - 0.25 - 0.0005) / std::cos(angle);
    REQUIRE(move.contact <= expected + 1e-9);
    REQUIRE(move.contact >= expected - touching / std::cos(angle) - 1e-9);
    REQUIRE(move.nearest.solid == 0);
    REQUIRE(move.least == move.nearest.distance);
  }
}

TEST_CASE("moves that start at contact, that do not move, and along a wall") {
  HandMadeWorld w;
  w.add(Box{{2.0, 20.0, 2.0}}, {0.0, 0.0, 0.0});
  const Scene scene = traced(w);
  const Hull hull{0.5, 0.0, 0.5};
  CHECK(straight(scene, hull, {-1.5, 0.0, 0.0}, {1.0, 0.0}, 1.0).contact == 0.0);
  CHECK(straight(scene, hull, {-1.2, 0.0, 0.0}, {1.0, 0.0}, 1.0).contact == 0.0);
  CHECK(straight(scene, hull, {-1.6, 0.0, 0.0}, {1.0, 0.0}, 0.0).contact == infinity);
  const Move still = straight(scene, hull, {-1.75, 0.0, 0.0}, {1.0, 0.0}, 0.0, 1.0);
  CHECK(still.contact == infinity);
  CHECK(still.nearest.distance == 0.25);
  CHECK(still.least == 0.25);
  // It ends exactly short of the wall.
  CHECK(straight(scene, hull, {-2.5, 0.0, 0.0}, {1.0, 0.0}, 0.9999).contact == infinity);
  CHECK(straight(scene, hull, {-2.5, 0.0, 0.0}, {1.0, 0.0}, 1.0).contact == doctest::Approx(1.0).epsilon(1e-6));
  // It ends half a micrometre short of the wall: that is contact.
  CHECK(straight(scene, hull, {-2.5, 0.0, 0.0}, {1.0, 0.0}, 1.0 - 0.5 * touching).contact <= 1.0 - 0.5 * touching);
  // A hair beside it.
  const Move beside = straight(scene, hull, {-1.5 - 0x1p-10, -15.0, 0.0}, {0.0, 1.0}, 30.0);
  CHECK(beside.contact == infinity);
  CHECK(beside.least == doctest::Approx(0x1p-10).epsilon(1e-9));
}

TEST_CASE("the least clearance of a step is that of its way, to half of what lies between two looks") {
  Dice dice(24);
  const HandMadeWorld w = hall(dice);
  const Scene scene = traced(w);
  const Hull hull{0.3, 0.0, 0.5};
  const auto plans = brute::plans_between(w.world, hull.z_low, hull.z_high);
  constexpr double step = 0.035;  // 0.7 m/s for 0.05 s
  std::size_t wrong = 0, seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 start(dice.point(glm::dvec2(-32.0), glm::dvec2(32.0)), 0.0);
    const glm::dvec2 along = direction(dice.between(-pi, pi));
    const Move move = straight(scene, hull, start, along, step, 5.0);
    if (move.contact < infinity) continue;
    double least = infinity;
    for (int k = 0; k <= 100; ++k)
      least = std::min(least, true_distance(plans, start + glm::dvec3(0.01 * k * step * along, 0.0)) - hull.radius);
    if (least > 5.0) continue;
    ++seen;
    wrong += move.least < least - 0.005 * step || move.least > least + 0.5 * step;
  }
  CHECK(wrong == 0);
  CHECK(seen > 1000);
}

TEST_CASE("moves along an arc touch where dense sampling says") {
  Dice dice(25);
  const HandMadeWorld w = hall(dice);
  const Scene scene = traced(w);
  const Hull hull{0.3, 0.0, 0.5};
  const auto plans = brute::plans_between(w.world, hull.z_low, hull.z_high);
  std::size_t wrong = 0, contacts = 0;
  constexpr double look = 0.005;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec2 centre = dice.point(glm::dvec2(-28.0), glm::dvec2(28.0));
    const double radius = dice.between(0.5, 4.0), begin = dice.between(-pi, pi), length = dice.between(1.0, 6.0);
    const auto position_at = [&](double s) { return glm::dvec3(centre + radius * direction(begin + s / radius), 0.0); };
    if (true_distance(plans, position_at(0.0)) < hull.radius + 1e-5) continue;
    Clearance nearest;
    double least = infinity;
    const double contact = scene.first_contact(hull, position_at, length, 0.0, nearest, least);
    // Before the contact nothing touches; at it something does.
    for (double s = 0.0; s < std::min(contact, length); s += look) wrong += true_distance(plans, position_at(s)) < hull.radius;
    if (contact == infinity) {
      wrong += true_distance(plans, position_at(length)) < hull.radius;
      continue;
    }
    ++contacts;
    const double at_contact = true_distance(plans, position_at(contact)) - hull.radius;
    wrong += !(at_contact < touching + 1e-9 && at_contact > -1e-9);
  }
  CHECK(wrong == 0);
  CHECK(contacts > 20);
}

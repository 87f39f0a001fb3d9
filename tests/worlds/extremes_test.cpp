// A scene at the ends of what it is made for: far away, tiny, huge, turned, and of geometry that nobody would draw on purpose. Bounds and results: docs/extremes.md.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "../hand_made_world.hpp"
#include "hand_made_mesh.hpp"
#include "thicket/worlds/scene.hpp"

using namespace thicket;

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Numbers in steps of 2^-10 m.
double dyadic(Dice& dice, double low, double high) { return std::round(dice.between(low, high) * 1024.0) / 1024.0; }
glm::dvec3 dyadic_point(Dice& dice, double reach) { return {dyadic(dice, -reach, reach), dyadic(dice, -reach, reach), dyadic(dice, -2.0, 2.0)}; }

/// Solids of all closed forms and a mesh, in steps of 2^-10 m, within a box of 32 m that two small boxes span.
HandMadeWorld mixed(Dice& dice, int count) {
  HandMadeWorld w;
  w.add(Box{{0.5, 0.5, 0.5}}, {-16.0, -16.0, -6.0});
  w.add(Box{{0.5, 0.5, 0.5}}, {16.0, 16.0, 6.0});
  const auto ball = sphere_soup(1.0, 1).mesh();
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 at = dyadic_point(dice, 10.0);
    switch (i % 4) {
      case 0: w.add(Sphere{dyadic(dice, 0.125, 1.5)}, at); break;
      case 1: w.add(Box{{dyadic(dice, 0.25, 3.0), dyadic(dice, 0.25, 3.0), dyadic(dice, 0.25, 3.0)}}, at, dice.between(-pi, pi)); break;
      case 2: w.add(Cylinder{dyadic(dice, 0.125, 1.0), dyadic(dice, 0.25, 3.0)}, at); break;
      default: w.add(MeshSolid{ball}, at, dice.between(-pi, pi));
    }
  }
  return w;
}

std::vector<Ray> looks(Dice& dice, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back({dyadic_point(dice, 12.0), dice.direction()});
  return rays;
}

std::vector<Hit> hits_of(const World& world, const std::vector<Ray>& rays) {
  const Scene scene = traced(world);
  std::vector<Hit> hits(rays.size());
  CHECK(scene.closest_hits(rays, Stops::everything, hits) == 0);
  return hits;
}

CrossingLists crossings_of(const Scene& scene, const std::vector<Ray>& rays) {
  CrossingLists lists;
  CHECK(scene.crossings(rays, infinity, lists, true) == 0);
  return lists;
}

/// How far the ranges of two looks at one world are apart. Of rays that graze (cosine below 0.01) at one of both, where rounding of positions is magnified without limit, the share is told.
struct Apart {
  double worst = 0.0;
  std::size_t met = 0, grazing = 0, other_solid = 0;
};
Apart apart(const std::vector<Ray>& rays, const std::vector<Hit>& a, const std::vector<Ray>& rays_b, const std::vector<Hit>& b, double scale = 1.0) {
  Apart result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto cosine = [](const Ray& ray, const Hit& hit) { return hit.solid == no_solid ? 1.0 : std::abs(glm::dot(ray.direction, hit.normal)); };
    if (cosine(rays[i], a[i]) < 0.01 || cosine(rays_b[i], b[i]) < 0.01) {
      ++result.grazing;
      continue;
    }
    if (a[i].solid != b[i].solid) ++result.other_solid;
    else if (a[i].solid != no_solid) {
      ++result.met;
      result.worst = std::max(result.worst, std::abs(a[i].range - b[i].range / scale));
    }
  }
  return result;
}

}  // namespace

TEST_CASE("extremes: place: 2^14, 2^20 and 2^27 m away all crossings are the same bits; at 10^4, 10^6 and 10^8 m ranges are within 3e-5 m") {
  Dice dice(301);
  const HandMadeWorld w = mixed(dice, 120);
  const std::vector<Ray> rays = looks(dice, 4000);
  const auto moved = [&](const glm::dvec3& by, std::vector<Ray>& there) {
    World world = w.world;
    for (Solid& solid : world.solids) solid.position += by;
    there = rays;
    for (Ray& ray : there) ray.origin += by;
    return world;
  };
  const CrossingLists home = crossings_of(traced(w), rays);
  const std::vector<Hit> hits = hits_of(w.world, rays);
  CHECK(home.items.size() > 3000);
  for (const double far : {0x1p14, 0x1p20, 0x1p27}) {
    CAPTURE(far);
    std::vector<Ray> there;
    const CrossingLists away = crossings_of(traced(moved({far, -far, far}, there)), there);
    REQUIRE(away.first == home.first);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < home.items.size(); ++i)
      differ += !(same_bits(home.items[i].enter, away.items[i].enter) && same_bits(home.items[i].leave, away.items[i].leave) && home.items[i].solid == away.items[i].solid);
    CHECK(differ == 0);
  }
  for (const double far : {1e4 + 0.1, 1e6 + 0.1, 1e8 + 0.1}) {
    CAPTURE(far);
    std::vector<Ray> there;
    const World world = moved({far, -far, 0.1}, there);
    const Apart a = apart(rays, hits, there, hits_of(world, there));
    CHECK(a.worst <= 3e-5);
    CHECK(a.met > 1500);
    CHECK(a.grazing < 80);
    CHECK(a.other_solid <= 2);  // an edge that is just met or just missed
  }
}

TEST_CASE("extremes: scale: a world of 1 cm and one of 100 km have the ranges of one of 32 m, to 1e-9 of its size") {
  Dice dice(302);
  const HandMadeWorld w = mixed(dice, 120);
  const std::vector<Ray> rays = looks(dice, 4000);
  const std::vector<Hit> hits = hits_of(w.world, rays);
  for (const double scale : {0.01 / 32.0, 1e5 / 32.0}) {
    CAPTURE(scale);
    World world = w.world;
    for (Solid& solid : world.solids) {
      solid.position *= scale;
      if (auto* box = std::get_if<Box>(&solid.shape)) box->size *= scale;
      if (auto* ball = std::get_if<Sphere>(&solid.shape)) ball->radius *= scale;
      if (auto* post = std::get_if<Cylinder>(&solid.shape)) *post = {post->radius * scale, post->height * scale};
      if (auto* mesh = std::get_if<MeshSolid>(&solid.shape)) mesh->scale = scale;
    }
    std::vector<Ray> there = rays;
    for (Ray& ray : there) ray.origin *= scale;
    const Apart a = apart(rays, hits, there, hits_of(world, there), scale);
    CHECK(a.worst <= 32e-9);
    CHECK(a.met > 1500);
    CHECK(a.other_solid == 0);
  }
}

TEST_CASE("extremes: rotation: a world that is turned about any axis has the same ranges, to 1e-9 m") {
  Dice dice(303);
  const HandMadeWorld w = mixed(dice, 120);
  const std::vector<Ray> rays = looks(dice, 1500);
  const std::vector<Hit> hits = hits_of(w.world, rays);
  for (int i = 0; i < 6; ++i) {
    // Quarter turns, straight up, and any.
    const double yaw = i == 0 ? 0.5 * pi : dice.between(-pi, pi), pitch = i == 1 ? 0.5 * pi : i == 0 ? 0.0 : dice.between(-0.5 * pi, 0.5 * pi), roll = i < 2 ? 0.0 : dice.between(-pi, pi);
    CAPTURE(i);
    const glm::dmat3 turn = rotation_of(yaw, pitch, roll);
    World world = w.world;
    for (Solid& solid : world.solids) {
      // The angles of a matrix that turns by roll, then pitch, then yaw.
      const glm::dmat3 own = turn * rotation_of(solid);
      solid.position = turn * solid.position;
      solid.pitch = std::asin(std::clamp(-own[0].z, -1.0, 1.0));
      const bool upright = std::abs(own[0].z) > 1.0 - 1e-12;
      solid.yaw = upright ? std::atan2(-own[1].x, own[1].y) : std::atan2(own[0].y, own[0].x);
      solid.roll = upright ? 0.0 : std::atan2(own[1].z, own[2].z);
    }
    std::vector<Ray> there = rays;
    for (Ray& ray : there) ray = {turn * ray.origin, glm::normalize(turn * ray.direction)};
    const Apart a = apart(rays, hits, there, hits_of(world, there));
    // Angles of a pitch near 90 degrees lose half of their digits in the arc sine, 1e-8; so this is asked for elsewhere.
    CHECK(a.worst <= (i == 1 ? 1e-6 : 1e-9));
    CHECK(a.met > 500);
    CHECK(a.other_solid == 0);
  }
}

TEST_CASE("extremes: geometry: faces met at 89.99 degrees are met at their closed-form range, to 1e-9 m") {
  const double angle = radians(89.99), height = 0.001, expected = height / std::cos(angle);  // 5.7 m
  const glm::dvec3 along(std::sin(angle), 0.0, -std::cos(angle));
  const std::vector<std::pair<const char*, Shape>> floors = {{"box", Box{{20.0, 2.0, 1.0}}},
                                                             {"mesh", MeshSolid{box_soup({20.0, 2.0, 1.0}).mesh()}},
                                                             {"cylinder", Cylinder{9.0, 1.0}},
                                                             {"prism", Prism{{{-10.0, -1.0}, {10.0, -1.0}, {10.0, 1.0}, {-10.0, 1.0}}, {}, 1.0}},
                                                             {"wall", Wall{{{-10.0, 0.0}, {10.0, 0.0}}, 2.0, 1.0}},
                                                             {"map", map_of({"####################", "####################"}, 1.0, 1.0)}};
  for (const auto& [name, shape] : floors) {
    CAPTURE(name);
    HandMadeWorld w;
    const bool centred = std::string(name) == "box" || std::string(name) == "mesh" || std::string(name) == "cylinder";
    w.add(shape, std::string(name) == "map" ? glm::dvec3(-10.0, -1.0, -1.0) : glm::dvec3(0.0, 0.0, centred ? -0.5 : -1.0));
    const Scene scene = traced(w);
    for (const double y : {-0.7, 0.0, 0.3}) {
      const Ray ray{{-3.0, y, height}, along};
      Hit hit;
      scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
      CHECK(std::abs(hit.range - expected) <= 1e-9);
      CHECK(hit.normal.z == doctest::Approx(1.0));
    }
  }
  // Balls and posts, met where their normal stands at this angle.
  for (const bool ball : {true, false}) {
    HandMadeWorld w;
    if (ball) w.add(Sphere{2.0}, {0.0, 0.0, 0.0});
    else w.add(Cylinder{2.0, 4.0}, {0.0, 0.0, 0.0});
    const Scene scene = traced(w);
    const double off = 2.0 * std::sin(angle);
    const Ray ray{{-10.0, off, 0.0}, {1.0, 0.0, 0.0}};
    Hit hit;
    scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
    CHECK(std::abs(hit.range - (10.0 - 2.0 * std::cos(angle))) <= 1e-9);
  }
}

TEST_CASE("extremes: geometry: solids at the very same place are each crossed once, and a mesh whose faces all stand twice is its matter once") {
  HandMadeWorld w;
  for (int i = 0; i < 3; ++i) w.add(Box{{2.0, 2.0, 2.0}}, {0.0, 0.0, 0.0});
  Soup twice = box_soup(glm::dvec3(2.0));
  twice.add(box_soup(glm::dvec3(2.0)));
  w.add(MeshSolid{twice.mesh()}, {0.0, 0.0, 0.0});
  const Scene scene = traced(w);
  Dice dice(304);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 along = dice.direction();
    rays.push_back({dice.point(glm::dvec3(-0.99), glm::dvec3(0.99)) - 8.0 * along, along});
  }
  const CrossingLists lists = crossings_of(scene, rays);
  std::size_t wrong = 0;
  double worst = 0.0;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const auto list = lists[r];
    if (list.size() != 4) {
      ++wrong;
      continue;
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
      wrong += std::ranges::count(list, i, &Crossing::solid) != 1;
      worst = std::max({worst, std::abs(list[i].enter - list[0].enter), std::abs(list[i].leave - list[0].leave)});
    }
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
}

TEST_CASE("extremes: geometry: a closed mesh with triangles of no area and needles of 1e-9 m is crossed as the box that it is, to 1e-9 m") {
  // The top of a box is cut off in a strip of a needle's width; and on one edge a point stands in the middle for one face and not for the other: a triangle without area closes that.
  for (const double needle : {1e-3, 1e-6, 1e-9}) {
    CAPTURE(needle);
    Soup soup = box_soup(glm::dvec3(2.0));
    std::vector<glm::uvec3> kept;
    for (const glm::uvec3& t : soup.triangles) {
      const bool top = soup.vertices[t.x].z > 0 && soup.vertices[t.y].z > 0 && soup.vertices[t.z].z > 0;
      if (!top) kept.push_back(t);
    }
    REQUIRE(kept.size() == 10);
    soup.triangles = kept;
    // Corners of the top: 4 (-,-), 5 (+,-), 6 (-,+), 7 (+,+). A line from 5 to 7 beside the edge at x = 1, a needle's width in; m is the middle of the edge from 4 to 6.
    const auto a = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.push_back({1.0 - needle, 0.0, 1.0});  // a
    soup.vertices.push_back({-1.0, 0.0, 1.0});          // m
    const std::uint32_t m = a + 1;
    for (const glm::uvec3& t : {glm::uvec3(5, 7, a), glm::uvec3(4, 5, a), glm::uvec3(a, 7, 6), glm::uvec3(4, a, m), glm::uvec3(m, a, 6), glm::uvec3(4, m, 6)}) soup.triangles.push_back(t);
    const auto mesh = soup.mesh();
    REQUIRE(mesh->closed);
    HandMadeWorld w;
    w.add(MeshSolid{mesh}, {0.0, 0.0, 0.0});
    w.add(Box{glm::dvec3(2.0)}, {0.0, 0.0, 0.0});
    const Scene scene = traced(w);
    Dice dice(305);
    std::vector<Ray> rays;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec3 along = dice.direction();
      // A third goes through the needle, a third through the edge of the triangle without area.
      const glm::dvec3 through = i % 3 == 0 ? glm::dvec3(1.0 - 0.5 * needle, dice.between(-0.9, 0.9), 1.0) : i % 3 == 1 ? glm::dvec3(-1.0, dice.between(-0.9, 0.9), 1.0) : dice.point(glm::dvec3(-0.9), glm::dvec3(0.9));
      rays.push_back({through - 8.0 * along, along});
    }
    const CrossingLists lists = crossings_of(scene, rays);
    std::size_t wrong = 0;
    double worst = 0.0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const auto list = lists[r];
      double length[2] = {0.0, 0.0}, first[2] = {infinity, infinity};
      for (const Crossing& c : list) {
        length[c.solid] += c.leave - c.enter;
        first[c.solid] = std::min(first[c.solid], c.enter);
      }
      // Through an edge from outside both have a chord of rounding, or none.
      if (length[0] < 1e-6 && length[1] < 1e-6) continue;
      wrong += list.size() != 2;
      worst = std::max({worst, std::abs(length[0] - length[1]), std::abs(first[0] - first[1])});
    }
    CHECK(wrong == 0);
    CHECK(worst <= 1e-9);
  }
}

TEST_CASE("extremes: geometry: 10 016 solids in 313 nests, 32 deep: every entrance and exit of each, to 1e-9 m") {
  HandMadeWorld w;
  constexpr int nests = 313, deep = 32;
  const auto middle = [](int nest) { return glm::dvec3(10.0 * (nest % 20), 10.0 * (nest / 20), 0.0); };
  for (int nest = 0; nest < nests; ++nest)
    for (int d = 0; d < deep; ++d) w.add(Sphere{4.0 - 0.1 * d}, middle(nest));
  CHECK(w.world.solids.size() == 10016);
  const Scene scene = traced(w);
  Dice dice(306);
  std::vector<Ray> rays;
  for (int nest = 0; nest < nests; ++nest) {
    const glm::dvec3 along = dice.direction();
    rays.push_back({middle(nest) - 4.5 * along, along, 9.0});
  }
  const CrossingLists lists = crossings_of(scene, rays);
  double worst = 0.0;
  for (int nest = 0; nest < nests; ++nest) {
    // Other nests may be met too, where the ray reaches over.
    std::vector<Crossing> own;
    for (const Crossing& c : lists[static_cast<std::size_t>(nest)])
      if (static_cast<int>(c.solid) / deep == nest) own.push_back(c);
    REQUIRE(own.size() == deep);
    for (int d = 0; d < deep; ++d) {
      worst = std::max({worst, std::abs(own[static_cast<std::size_t>(d)].enter - (0.5 + 0.1 * d)), std::abs(own[static_cast<std::size_t>(d)].leave - (8.5 - 0.1 * d))});
      CHECK(static_cast<int>(own[static_cast<std::size_t>(d)].solid) % deep == d);
    }
  }
  CHECK(worst <= 1e-9);
}

TEST_CASE("extremes: geometry: a wall 0.1 mm thick is crossed once, 0.1 mm over the cosine long, and stops a hull at any speed") {
  HandMadeWorld w;
  w.add(Box{{0.0001, 20.0, 2.0}}, {0.0, 0.0, 1.0}, radians(30.0));
  const Scene scene = traced(w);
  const glm::dvec3 normal(std::cos(radians(30.0)), std::sin(radians(30.0)), 0.0);
  Dice dice(307);
  double worst = 0.0;
  std::size_t wrong = 0, tunnelled = 0;
  const Hull hull{0.3, 0.0, 0.5};
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 target = glm::dvec3(-normal.y, normal.x, 0.0) * dice.between(-6.0, 6.0) + glm::dvec3(0.0, 0.0, dice.between(0.2, 1.8));
    glm::dvec3 along = dice.direction();
    along.z *= 0.05;
    along = glm::normalize(along);
    const double cosine = std::abs(glm::dot(along, normal));
    if (cosine < 0.05) continue;
    const Ray ray{target - 3.0 * along, along};
    CrossingLists lists;
    scene.crossings({&ray, 1}, infinity, lists, true);
    if (lists.items.size() == 1) worst = std::max(worst, std::abs(lists.items[0].leave - lists.items[0].enter - 0.0001 / cosine));
    else ++wrong;
    // Moves of a centimetre to a kilometre through its middle.
    const glm::dvec2 heading = glm::normalize(glm::dvec2(along));
    const double length = std::pow(10.0, dice.between(0.5, 3.0));
    const glm::dvec2 from = glm::dvec2(target) - 0.9 * length * heading;
    if (std::abs(glm::dot(from, glm::dvec2(normal))) <= hull.radius + 1e-3) continue;
    Clearance nearest;
    double least = infinity;
    tunnelled += scene.first_contact(hull, [&](double s) { return glm::dvec3(from + s * heading, 0.0); }, length, 0.0, nearest, least) > length;
  }
  CHECK(wrong == 0);
  CHECK(worst <= 1e-9);
  CHECK(tunnelled == 0);
}

TEST_CASE("extremes: geometry: 10^7 triangles" * doctest::skip() * doctest::description("Takes a minute and some gigabytes: build/release/tests/test_worlds -ns -tc='*10^7 triangles'")) {
  const Soup ball = sphere_soup(1.0, 6);  // 81 920
  Soup all;
  for (int i = 0; i < 123; ++i) all.add(ball.moved(glm::dmat3(1.0), {3.0 * (i % 12), 3.0 * (i / 12), 0.0}));
  HandMadeWorld w;
  w.add(MeshSolid{all.mesh()}, {0.0, 0.0, 0.0});
  const Scene scene = traced(w);
  CHECK(scene.figures().triangles == 123 * 81920);
  MESSAGE(scene.figures().triangles, " triangles, built in ", scene.figures().build_s, " s, ", static_cast<double>(scene.figures().memory_bytes) / 1e9, " GB");
  Dice dice(308);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) rays.push_back({glm::dvec3(3.0 * (i % 123 % 12), 3.0 * (i % 123 / 12), 0.0), dice.direction()});
  const CrossingLists lists = crossings_of(scene, rays);
  double worst = 0.0;
  std::size_t wrong = 0;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const auto list = lists[r];
    if (list.empty() || !list[0].starts_inside) ++wrong;
    else worst = std::max(worst, 1.0 - list[0].leave);
  }
  CHECK(wrong == 0);
  CHECK(worst <= 3e-4);  // the sag of a triangle of the ball
}

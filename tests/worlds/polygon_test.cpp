// Polygons: their faults, their triangles, and the prisms that are made of them.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "polygon.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/mesh.hpp"

using namespace thicket;

namespace {

double area(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

double area(const Ring& outline, const std::vector<Ring>& holes) {
  double sum = area(outline);
  for (const Ring& hole : holes) sum -= area(hole);
  return sum;
}

/// The triangles' areas summed, each of which must be positive.
double triangulated_area(const Ring& outline, const std::vector<Ring>& holes) {
  std::vector<glm::dvec2> points = outline;
  for (const Ring& hole : holes) points.insert(points.end(), hole.begin(), hole.end());
  double sum = 0.0;
  int wrong = 0;
  const auto triangles = triangulate(outline, holes);
  for (const glm::uvec3& t : triangles) {
    const glm::dvec2 a = points[t.x], b = points[t.y], c = points[t.z];
    wrong += orientation(a, b, c) <= 0.0;
    sum += 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  CHECK(wrong == 0);
  CHECK(triangles.size() == points.size() + 2 * holes.size() - 2);
  return sum;
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

Ring square(double low, double high) {
  return {{low, low}, {high, low}, {high, high}, {low, high}};
}

/// About a centre, at sorted bearings: simple.
template <class Engine>
Ring star(Engine& engine, int corners, const glm::dvec2& centre, double least, double most) {
  std::uniform_real_distribution<double> radius(least, most);
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double bearing = 2.0 * pi * i / corners, r = radius(engine);
    ring.push_back(centre + r * glm::dvec2(std::cos(bearing), std::sin(bearing)));
  }
  return ring;
}

void check_prism(const Ring& outline, const std::vector<Ring>& holes, double height) {
  const auto mesh = prism_mesh(outline, holes, height);
  CHECK(mesh->closed);
  CHECK(signed_volume(*mesh) == doctest::Approx(area(outline, holes) * height).epsilon(1e-11));
  CHECK(mesh->low.z == 0.0);
  CHECK(mesh->high.z == height);
}

void expect_fault(const Ring& outline, const std::vector<Ring>& holes, const std::string& part) {
  const auto fault = polygon_fault(outline, holes);
  REQUIRE(fault.has_value());
  INFO(*fault);
  CHECK(fault->find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("the orientation of three points is exact where rounding would decide") {
  // On the line y = x far from its origin, moved by the smallest step.
  const glm::dvec2 a(12.0, 12.0), b(24.0, 24.0);
  const double up = std::nextafter(0.5, 1.0);
  CHECK(orientation(a, b, {0.5, 0.5}) == 0.0);
  CHECK(orientation(a, b, {0.5, up}) > 0.0);
  CHECK(orientation(a, b, {up, 0.5}) < 0.0);
  const glm::dvec2 c(1e6 + 0.1, 1e6 + 0.1), d(1e6 + 0.7, 1e6 + 0.7);
  CHECK(orientation(c, d, {-3.3, -3.3}) == 0.0);
  CHECK(orientation(c, d, {-3.3, std::nextafter(-3.3, 0.0)}) > 0.0);
  CHECK(orientation(c, d, {-3.3, std::nextafter(-3.3, -4.0)}) < 0.0);
}

TEST_CASE("polygons of either direction are cut into counter-clockwise triangles of their area") {
  const Ring l_shape = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  const Ring comb = {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1}, {5, 3}, {4, 3},
                     {4, 1}, {3, 1}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  const Ring on_lines = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  for (const Ring& ring : {l_shape, comb, on_lines}) {
    CHECK(triangulated_area(ring, {}) == area(ring));
    CHECK(triangulated_area(reversed(ring), {}) == area(ring));
    check_prism(ring, {}, 2.5);
    check_prism(reversed(ring), {}, 2.5);
  }
}

TEST_CASE("holes are left out, whichever way they run") {
  const Ring outline = square(0, 10);
  const std::vector<Ring> holes = {
      square(1, 2), reversed(square(4, 6)), square(7, 9), {{1, 8}, {3, 8}, {3, 9}, {2, 8.5}}, {{7, 1}, {9, 1}, {9, 2}, {7, 2}}};
  CHECK_FALSE(polygon_fault(outline, holes).has_value());
  CHECK(triangulated_area(outline, holes) == doctest::Approx(100.0 - 1.0 - 4.0 - 4.0 - area(holes[3]) - 2.0).epsilon(1e-14));
  check_prism(outline, holes, 3.0);
  check_prism(reversed(outline), holes, 3.0);
}

TEST_CASE("holes in rows and columns, whose ends are level with one another") {
  std::vector<Ring> holes;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y) holes.push_back({{x + 0.25, y + 0.25}, {x + 0.75, y + 0.25}, {x + 0.75, y + 0.75}, {x + 0.25, y + 0.75}});
  CHECK_FALSE(polygon_fault(square(0, 6), holes).has_value());
  CHECK(triangulated_area(square(0, 6), holes) == 27.0);
  check_prism(square(0, 6), holes, 0.5);
}

TEST_CASE("random stars with star-shaped holes give closed prisms of their volume") {
  CHECK(rc::check("prisms of stars", [] {
    std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
    const int corners = *rc::gen::inRange(5, 80);
    const double far = *rc::gen::element(0.0, 1e3, 1e6);
    Ring outline = star(engine, corners, {far, -far}, 6.0, 20.0);
    std::vector<Ring> holes;
    const int count = *rc::gen::inRange(0, 5);
    for (int i = 0; i < count; ++i) {
      const double bearing = 2.0 * pi * i / 4.0 + 0.3;
      holes.push_back(
          star(engine, *rc::gen::inRange(3, 12), glm::dvec2(far, -far) + 2.0 * glm::dvec2(std::cos(bearing), std::sin(bearing)), 0.2, 1.0));
    }
    // Stars of few corners may cut their chords through the middle: those are none of this test.
    if (polygon_fault(outline, holes)) return;
    if (*rc::gen::arbitrary<bool>()) outline = reversed(outline);
    check_prism(outline, holes, 1.5);
    const double exact = area(outline, holes);
    RC_ASSERT(std::abs(triangulated_area(outline, holes) - exact) < 1e-9 * exact);
  }));
}

TEST_CASE("ten thousand points are cut") {
  std::mt19937_64 engine(7);
  const Ring ring = star(engine, 10000, {0.0, 0.0}, 5.0, 10.0);
  CHECK_FALSE(polygon_fault(ring, {}).has_value());
  CHECK(triangulated_area(ring, {}) == doctest::Approx(area(ring)).epsilon(1e-11));
}

TEST_CASE("what is no polygon still ends, with as many triangles") {
  CHECK(triangulate({{0, 0}, {2, 2}, {2, 0}, {0, 2}}, {}).size() == 2);
  CHECK(triangulate({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}, {}).size() == 3);
  CHECK(triangulate(square(0, 1), {square(5, 6)}).size() == 8);
  CHECK(triangulate({{0, 0}, {1, 1}}, {}).empty());
}

TEST_CASE("a polygon's faults are named") {
  CHECK_FALSE(polygon_fault(square(0, 1), {}).has_value());
  expect_fault({{0, 0}, {1, 0}}, {}, "the outline has 2 points, expected 3 or more");
  expect_fault({{0, 0}, {1, 0}, {NAN, 1}}, {}, "point 3 of the outline is not finite");
  expect_fault({{0, 0}, {1, 0}, {1, 1}, {0, 0}}, {}, "points 1 and 4 of the outline are the same, [0, 0]");
  expect_fault({{0, 0}, {1, 1}, {3, 3}}, {}, "no area");
  expect_fault({{0, 0}, {2, 2}, {2, 0}, {0, 2}}, {}, "the outline meets itself: edge 1 ([0, 0] to [2, 2]) and edge 3 ([2, 0] to [0, 2])");
  expect_fault({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}, {}, "edge 1 ([0, 0] to [4, 0]) and edge 3 ([4, 4] to [2, 0])");
  expect_fault({{0, 0}, {4, 0}, {2, 0}, {2, 3}}, {}, "edge 1 ([0, 0] to [4, 0]) and edge 2 ([4, 0] to [2, 0])");
  expect_fault({{2, 0}, {2, 3}, {0, 0}, {4, 0}}, {}, "meets itself");  // the same spike, at the ring's end
  expect_fault(square(0, 4), {square(5, 6)}, "hole 1 lies outside the outline");
  expect_fault(square(0, 4), {square(3, 5)}, "hole 1 meets the outline");
  expect_fault(square(0, 4), {{{0, 1}, {1, 1}, {1, 2}}}, "hole 1 meets the outline");
  expect_fault(square(0, 9), {square(1, 4), square(3, 6)}, "hole 2 meets hole 1");
  expect_fault(square(0, 9), {square(1, 4), square(2, 3)}, "hole 2 lies inside hole 1");
  expect_fault(square(0, 9), {square(2, 3), square(1, 4)}, "hole 1 lies inside hole 2");
  expect_fault(square(0, 9), {{{1, 1}, {2, 1}}}, "hole 1 has 2 points");
}

#include "thicket/nav/bumper.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

constexpr double hull = 0.3, press = 1.0;

ContourPoint at(double degree, double range) { return {range * direction(radians(degree)), range, radians(degree)}; }
ContourPoint silent(double degree) { return {{0.0, 0.0}, std::numeric_limits<double>::infinity(), radians(degree)}; }

/// A ring of rays one degree apart that end at `range(degree)` from the axis.
template <class Range>
Contour ring(Range&& range) {
  Contour contour;
  for (int degree = -180; degree < 180; ++degree) {
    const double r = range(degree);
    contour.push_back(std::isfinite(r) ? at(degree, r) : silent(degree));
  }
  return contour;
}

constexpr double far = std::numeric_limits<double>::infinity();

BumperSpec rule(const char* name) {
  BumperSpec spec;
  spec.rule = name;
  return spec;
}

bool left_pressed(BumperRing bumpers, const Contour& contour) {
  bumpers.read(contour);
  return bumpers.bumpers()[2].pressed;
}

/// A sensor of one fixed beam with an opening, looking to `yaw_deg`.
Scan lobe(double yaw_deg, double range, double opening_deg = 65.0) {
  Scan scan;
  scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, radians(yaw_deg)).orientation;
  scan.azimuth_opening = radians(opening_deg);
  Beam beam;
  if (std::isfinite(range)) {
    beam.echo_count = 1;
    scan.echoes.push_back({range});
  }
  scan.beams.push_back(beam);
  return scan;
}

}  // namespace

TEST_CASE("a quantile presses when that share of the sector's rays is near, and no ray less") {
  BumperSpec spec = rule("quantile");
  for (const auto& [share, needed] : {std::pair{0.5, 22}, std::pair{0.2, 9}, std::pair{1.0, 44}, std::pair{0.01, 1}}) {
    spec.quantile = share;
    const BumperRing bumpers(spec, hull, press);
    CAPTURE(share);
    // The left sector has 44 rays strictly inside and 45 or 46 with its borders; those are far.
    const auto near_rays = [&](int rays) { return ring([rays](int degree) { return degree >= 68 && degree < 68 + rays ? 1.0 : degree < 68 || degree > 112 ? far : far; }); };
    int fewest = 0;
    for (int rays = 1; rays <= 45 && fewest == 0; ++rays)
      if (left_pressed(bumpers, near_rays(rays))) fewest = rays;
    CHECK(std::abs(fewest - needed) <= 1);
  }
}

TEST_CASE("the rule any feels a post that all and a half miss; a wall presses all of them") {
  const Contour post = ring([](int degree) { return std::abs(degree - 90) <= 2 ? 1.1 : far; });
  const Contour wall = ring([](int degree) { return degree > 20 && degree < 160 ? 0.8 / std::sin(radians(degree)) : far; });
  for (const auto& [name, feels] : {std::pair{"any", true}, std::pair{"quantile", false}, std::pair{"all", false}}) {
    CAPTURE(name);
    CHECK(left_pressed(BumperRing(rule(name), hull, press), post) == feels);
    CHECK(left_pressed(BumperRing(rule(name), hull, press), wall));
  }
}

TEST_CASE("the band of 2012 is pressed when all rays are in it, and one ray that is nearer than the clearance releases it") {
  const BumperRing bumpers(rule("band2012"), hull, 99.0, 0.4);  // from 0.7 to 1.2 m about the axis, whatever the press distance
  CHECK(left_pressed(bumpers, ring([](int) { return 1.0; })));
  CHECK_FALSE(left_pressed(bumpers, ring([](int) { return 1.25; })));
  CHECK_FALSE(left_pressed(bumpers, ring([](int) { return 0.65; })));
  CHECK_FALSE(left_pressed(bumpers, ring([](int degree) { return degree == 90 ? 0.65 : 1.0; })));
  CHECK_FALSE(left_pressed(bumpers, ring([](int degree) { return degree == 90 ? far : 1.0; })));
}

TEST_CASE("every rule but the band of 2012 has hysteresis") {
  for (const auto& [name, keeps] : {std::pair{"any", true}, std::pair{"quantile", true}, std::pair{"all", true}, std::pair{"band2012", false}}) {
    BumperSpec spec = rule(name);
    spec.press_margin_m = 0.6;
    BumperRing bumpers(spec, hull, press, 0.4);
    const auto state_at = [&](double range) {
      bumpers.read(ring([range](int) { return range; }));
      return bumpers.bumpers()[5].pressed;
    };
    CAPTURE(name);
    CHECK_FALSE(state_at(1.35));
    CHECK(state_at(1.25));
    CHECK(state_at(1.35) == keeps);
    CHECK_FALSE(state_at(1.45));
    CHECK_FALSE(state_at(1.35));
  }
}

TEST_CASE("every bearing belongs to the sector whose middle is nearest, for 4 to 36 sectors") {
  for (int count = 4; count <= 36; ++count) {
    BumperSpec spec;
    spec.count = count;
    for (int degree = -180; degree <= 180; degree += 3) {
      if (std::abs(std::remainder(degree * count / 180.0, 2.0)) > 0.999) continue;  // a border between two
      BumperRing bumpers(spec, hull, press);
      bumpers.read({at(degree, 0.9)});
      for (const Bumper& b : bumpers.bumpers()) {
        CAPTURE(count);
        CAPTURE(degree);
        CHECK(b.pressed == (std::abs(wrap_angle(b.centre - radians(degree))) < pi / count));
      }
    }
  }
}

TEST_CASE("a lobe gives an interval of bearings, a thin ray one bearing") {
  Contour contour;
  read_contour(lobe(0.0, 1.2, 30.0), contour);
  BumperSpec spec;
  spec.count = 4;
  BumperRing bumpers(spec, hull, press);
  bumpers.read(contour);
  CHECK(bumpers.bumpers()[0].distance == doctest::Approx(0.9));
  CHECK(bumpers.bumpers()[0].bearing_low == doctest::Approx(radians(-15.0)));
  CHECK(bumpers.bumpers()[0].bearing_high == doctest::Approx(radians(15.0)));
  read_contour(lobe(180.0, 1.2, 30.0), contour);
  bumpers.read(contour);
  CHECK(bumpers.bumpers()[0].distance == far);
  CHECK(bumpers.bumpers()[2].bearing_high - bumpers.bumpers()[2].bearing_low == doctest::Approx(radians(30.0)));
  CHECK(std::abs(wrap_angle(bumpers.bumpers()[2].bearing_low - radians(165.0))) < 1e-9);
  contour.push_back(at(100.0, 0.5));
  contour.push_back(at(101.0, 0.6));
  bumpers.read(contour);
  CHECK(bumpers.bumpers()[1].bearing_low == doctest::Approx(radians(100.0)));
  CHECK(bumpers.bumpers()[1].bearing_high == doctest::Approx(radians(100.0)));
}

TEST_CASE("a lobe's interval ends at the sector, and a nearer ray in the middle of it takes its place") {
  Contour contour;
  read_contour(lobe(0.0, 1.2), contour);  // 65 degrees, sectors of 45
  contour.push_back(at(5.0, 0.9));
  BumperRing bumpers(BumperSpec{}, hull, press);
  bumpers.read(contour);
  CHECK(bumpers.bumpers()[0].bearing_low == bumpers.bumpers()[0].bearing_high);
  CHECK(bumpers.bumpers()[0].distance == doctest::Approx(0.6));
  CHECK(bumpers.bumpers()[1].bearing_low == doctest::Approx(radians(22.5)).epsilon(0.1));
  CHECK(bumpers.bumpers()[1].bearing_low >= radians(22.5));
  CHECK(bumpers.bumpers()[1].bearing_high == doctest::Approx(radians(32.5)));
}

TEST_CASE("what no beam covers is unseen: the gaps between four lobes, the blind sector of a laser scanner, nothing of a scanner with few rays") {
  Contour contour;
  ContourReader reader;
  for (const double yaw : {0.0, 90.0, 180.0, 270.0}) reader.add(lobe(yaw, yaw == 90.0 ? far : 2.0), contour);
  BumperSpec eight, four;
  four.count = 4;
  const auto unseen = [](const BumperSpec& spec, const Contour& what) {
    BumperRing bumpers(spec, hull, press);
    std::vector<double> list;
    for (const Bumper& b : bumpers.bumpers()) CHECK(b.unseen == doctest::Approx(2.0 * pi / spec.count));  // before the first scan
    bumpers.read(what);
    for (const Bumper& b : bumpers.bumpers()) list.push_back(degrees(b.unseen));
    return list;
  };
  const auto by_eight = unseen(eight, contour), by_four = unseen(four, contour);
  for (std::size_t i = 0; i < 8; ++i) CHECK(std::abs(by_eight[i] - (i % 2 ? 25.0 : 0.0)) <= 0.5);
  for (const double u : by_four) CHECK(std::abs(u - 25.0) <= 0.5);

  contour.clear();
  for (int degree = -120; degree <= 120; ++degree) contour.push_back(at(degree, 3.0));
  const auto laser = unseen(four, contour);
  CHECK(laser[0] == 0.0);
  CHECK(std::abs(laser[1] - 15.0) <= 0.5);
  CHECK(std::abs(laser[2] - 90.0) <= 0.5);

  contour.clear();
  for (int degree = -180; degree < 180; degree += 20) contour.push_back(silent(degree));
  for (const double u : unseen(four, contour)) CHECK(u == 0.0);
}

TEST_CASE("the contour of a mount off the axis has the bearings of its points, near and far") {
  Scan scan;
  scan.mount_position = {0.3, -0.2, 1.0};
  scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, 0.7).orientation;
  for (int i = 0; i < 360; ++i) {
    Beam beam;
    beam.azimuth = radians(i);
    beam.direction = glm::dvec3(direction(beam.azimuth), 0.0);
    beam.first_echo = static_cast<std::uint32_t>(i);
    beam.echo_count = 1;
    scan.beams.push_back(beam);
    scan.echoes.push_back({0.05 + 0.0007 * i * i});
  }
  Contour contour, again;
  ContourReader reader;
  reader.add(scan, contour);
  reader.add(scan, again);  // what it remembers now
  REQUIRE(contour.size() == 360);
  for (std::size_t i = 0; i < 360; ++i) {
    const glm::dvec2 expected = glm::dvec2(0.3, -0.2) + scan.echoes[i].range * direction(radians(static_cast<double>(i)) + 0.7);
    CHECK(glm::distance(contour[i].position, expected) < 1e-12);
    CHECK(std::abs(wrap_angle(contour[i].bearing - bearing(expected))) < 1e-14);
    CHECK(contour[i].distance == doctest::Approx(glm::length(expected)));
    CHECK(again[i].bearing == contour[i].bearing);
  }
  // Rays at random places point elsewhere in the next scan.
  scan.beams[7].direction = glm::dvec3(direction(radians(7.4)), 0.0);
  again.clear();
  reader.add(scan, again);
  CHECK(again[7].bearing != contour[7].bearing);
  CHECK(again[8].bearing == contour[8].bearing);
}

TEST_CASE("an older scan is moved by how the robot moved since") {
  Scan scan;
  Beam ahead, left;
  ahead.echo_count = 1;
  left.direction = {0.0, 1.0, 0.0};
  scan.beams = {ahead, left};
  scan.echoes = {{2.0}};
  Contour contour;
  // The robot was half a metre farther back and has turned left by 90 degrees since: then is to its right, facing right.
  const Pose2 then{{0.0, 0.5}, -0.5 * pi}, now_to_then = then;
  ContourReader().add(scan, now_to_then, contour);
  CHECK(glm::distance(contour[0].position, glm::dvec2(0.0, -1.5)) < 1e-12);
  CHECK(contour[0].bearing == doctest::Approx(-0.5 * pi));
  CHECK(contour[0].distance == doctest::Approx(1.5));
  CHECK(contour[1].distance == far);
  CHECK(contour[1].bearing == doctest::Approx(0.0));
}

}  // namespace thicket

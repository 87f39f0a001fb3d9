// Where antennas send their rays, and what each of them stands for.
#include "antenna.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "../hand_made_world.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"

using namespace thicket;

namespace {

double sum_of_shares(const Antenna& antenna) {
  return std::accumulate(antenna.rays().begin(), antenna.rays().end(), 0.0, [](double sum, const SubRay& ray) { return sum + ray.share; });
}

LobeRadarSpec lobe(double azimuth_deg, double elevation_deg, std::int64_t azimuth_rays, std::int64_t elevation_rays, const char* gain = "flat", const char* section = "square") {
  LobeRadarSpec spec;
  spec.azimuth_opening_deg = azimuth_deg;
  spec.elevation_opening_deg = elevation_deg;
  spec.azimuth_rays = azimuth_rays;
  spec.elevation_rays = elevation_rays;
  spec.gain = gain;
  spec.section = section;
  return spec;
}

/// Smooth, and alike in no direction: what is on the left, on the right, above and below weighs differently.
double scenery(double azimuth, double elevation) { return 1.0 + 0.7 * azimuth - 0.4 * elevation + azimuth * elevation + 2.0 * azimuth * azimuth; }

/// Mean of `scenery` as a beam weighs it: over g^2 cos(elevation) on a fine grid, nothing but `gain` is asked.
double seen_by_gain(const Antenna& antenna, double azimuth_opening, double elevation_opening) {
  constexpr int n = 1500;
  double sum = 0.0, weights = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double azimuth = azimuth_opening * ((i + 0.5) / n - 0.5), elevation = elevation_opening * ((j + 0.5) / n - 0.5);
      const double g = antenna.gain(azimuth, elevation), weight = g * g * std::cos(elevation);
      sum += weight * scenery(azimuth, elevation);
      weights += weight;
    }
  return sum / weights;
}

struct Estimate {
  double mean, error;
};
/// Mean over scans of what the jittered rays see, and its standard error; of their shares too, if `shares` is given.
Estimate seen_by_jitter(const Antenna& antenna, int scans, std::uint64_t seed, bool shares = false) {
  const Random random(seed, 0);
  double sum = 0.0, squares = 0.0;
  for (int scan = 0; scan < scans; ++scan) {
    double seen = 0.0;
    for (const SubRay& ray : antenna.rays()) {
      const auto u = random.uniform(static_cast<std::uint64_t>(scan), 0, RandomUse::sampling, ray.index);
      const SubRay moved = antenna.jittered(ray, {u[0], u[1]});
      seen += moved.share * (shares ? 1.0 : scenery(moved.azimuth, moved.elevation));
    }
    sum += seen;
    squares += seen * seen;
  }
  const double mean = sum / scans;
  return {mean, std::sqrt(std::max(0.0, squares / scans - mean * mean) / scans)};
}

std::vector<Antenna> all_kinds() {
  std::vector<Antenna> kinds;
  for (const char* gain : {"flat", "gaussian", "table"})
    for (const char* section : {"square", "elliptic"})
      for (const double elevation_deg : {65.0, 20.0}) {
        LobeRadarSpec spec = lobe(80.0, elevation_deg, 9, 6, gain, section);
        spec.gain_table_db = {{0.0, 0.0}, {20.0, -1.0}, {50.0, -12.0}};
        kinds.emplace_back(spec);
      }
  for (const char* divergence : {"none", "side_rays", "cone"})
    for (const double elevation_deg : {0.0, 40.0}) {
      ScanningRadarSpec spec;
      spec.step_deg = 4.0;
      spec.divergence = divergence;
      spec.cone_opening_deg = 8.0;
      spec.elevation_opening_deg = elevation_deg;
      spec.elevation_rays = 5;
      kinds.emplace_back(spec);
    }
  return kinds;
}

}  // namespace

TEST_CASE("shares sum to 1") {
  for (const Antenna& antenna : all_kinds()) CHECK(sum_of_shares(antenna) == doctest::Approx(1.0).epsilon(1e-12));
  for (const std::int64_t rays : {1, 2, 10, 58}) {
    CHECK(sum_of_shares(Antenna(lobe(65.0, 65.0, rays, rays, "gaussian"))) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(sum_of_shares(Antenna(lobe(65.0, 65.0, rays, rays, "flat", "elliptic"))) == doctest::Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("a share is the two-way power of its cell") {
  // From 10 x 10 rays on the sum over the cells' middles is the integral to 0.1 %, so that it makes no difference by which of them shares are divided.
  for (const char* gain : {"flat", "gaussian"}) {
    const Antenna antenna(lobe(65.0, 65.0, 10, 10, gain));
    for (const SubRay& ray : antenna.rays()) {
      const double g = antenna.gain(ray.azimuth, ray.elevation);
      const double share = g * g * std::cos(ray.elevation) * ray.azimuth_cell * ray.elevation_cell / antenna.two_way_solid_angle();
      REQUIRE(ray.share == doctest::Approx(share).epsilon(gain == std::string("flat") ? 1e-3 : 3e-3));
    }
  }
}

TEST_CASE("solid angles in closed form") {
  const double azimuth = radians(65.0), elevation = radians(50.0);
  const Antenna square(lobe(65.0, 50.0, 8, 8));
  CHECK(square.two_way_solid_angle() == doctest::Approx(azimuth * 2.0 * std::sin(0.5 * elevation)).epsilon(1e-12));
  CHECK(square.directivity() == doctest::Approx(4.0 * pi / (azimuth * 2.0 * std::sin(0.5 * elevation))).epsilon(1e-12));
  // Of a small ellipse the area. Of a large one: the integral of (a / 2) sqrt(1 - (2 el / b)^2) 2 cos(el) is a b pi / 4 times 2 J1(b / 2) / (b / 2).
  const Antenna small(lobe(0.02, 0.01, 8, 8, "flat", "elliptic"));
  CHECK(small.two_way_solid_angle() == doctest::Approx(0.25 * pi * radians(0.02) * radians(0.01)).epsilon(1e-8));
  const Antenna ellipse(lobe(65.0, 50.0, 8, 8, "flat", "elliptic"));
  CHECK(ellipse.two_way_solid_angle() ==
        doctest::Approx(0.25 * pi * azimuth * elevation * 2.0 * std::cyl_bessel_j(1.0, 0.5 * elevation) / (0.5 * elevation)).epsilon(1e-12));
  // A narrow Gaussian in a wide opening: g^2 has the integral pi w^2 / (8 ln 2), g twice that.
  LobeRadarSpec narrow = lobe(30.0, 30.0, 8, 8, "gaussian");
  narrow.gain_width_deg = {1.0, 1.0};
  const double w = radians(1.0);
  CHECK(Antenna(narrow).two_way_solid_angle() == doctest::Approx(pi * w * w / (8.0 * std::log(2.0))).epsilon(1e-4));
  CHECK(Antenna(narrow).directivity() == doctest::Approx(4.0 * pi / (pi * w * w / (4.0 * std::log(2.0)))).epsilon(1e-4));
  // All that a scanner with a plane beam has: a step by a step. A cone: its disc.
  ScanningRadarSpec spec;
  CHECK(Antenna(spec).two_way_solid_angle() == doctest::Approx(radians(1.0) * 2.0 * std::sin(radians(0.5))).epsilon(1e-12));
  spec.divergence = "cone";
  CHECK(Antenna(spec).two_way_solid_angle() == doctest::Approx(pi * std::pow(radians(1.0), 2)).epsilon(1e-3));
}

TEST_CASE("directivity of the X4M05") {
  // A Gaussian of 65 degrees has 9.9 dB. The sheet says 5.97 dB of gain: the other 3.9 dB are losses, and what the real antenna sends elsewhere, as the model does not. Cut at the
  // opening it has 2.1 dB more, for the rest of the Gaussian is left out.
  const auto directivity_db = [](const Antenna& antenna) { return 10.0 * std::log10(antenna.directivity()); };
  LobeRadarSpec uncut = lobe(180.0, 170.0, 4, 4, "gaussian");
  uncut.gain_width_deg = {65.0, 65.0};
  CHECK(directivity_db(Antenna(uncut)) == doctest::Approx(9.862).epsilon(1e-4));
  const Antenna cut(lobe(65.0, 65.0, 58, 58, "gaussian"));
  CHECK(directivity_db(cut) == doctest::Approx(11.921).epsilon(1e-4));
  double sum = 0.0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double azimuth = radians(65.0) * ((i + 0.5) / n - 0.5), elevation = radians(65.0) * ((j + 0.5) / n - 0.5);
      sum += cut.gain(azimuth, elevation) * std::cos(elevation) * std::pow(radians(65.0) / n, 2);
    }
  CHECK(cut.directivity() == doctest::Approx(4.0 * pi / sum).epsilon(1e-6));
}

TEST_CASE("a Gaussian gain has half its power at half its width") {
  const Antenna as_opening(lobe(65.0, 40.0, 4, 4, "gaussian"));
  CHECK(as_opening.gain(0.0, 0.0) == 1.0);
  CHECK(as_opening.gain(radians(32.5), 0.0) == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(as_opening.gain(0.0, radians(-20.0)) == doctest::Approx(0.5).epsilon(1e-14));
  LobeRadarSpec spec = lobe(120.0, 120.0, 4, 4, "gaussian");
  spec.gain_width_deg = {50.0, 30.0};
  const Antenna antenna(spec);
  CHECK(antenna.gain(radians(25.0), 0.0) == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(antenna.gain(0.0, radians(15.0)) == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(antenna.gain(radians(-50.0), radians(30.0)) == doctest::Approx(1.0 / 256.0).epsilon(1e-13));
}

TEST_CASE("a gain table is straight in dB over the angle off the axis, level beyond its ends, and against the axis") {
  LobeRadarSpec spec = lobe(120.0, 120.0, 4, 4, "table");
  spec.gain_table_db = {{5.0, 6.0}, {15.0, 4.0}, {15.0, -3.0}, {35.0, -13.0}};
  const Antenna antenna(spec);
  const auto db = [&](double azimuth_deg, double elevation_deg) { return 10.0 * std::log10(antenna.gain(radians(azimuth_deg), radians(elevation_deg))); };
  CHECK(db(0.0, 0.0) == doctest::Approx(0.0));
  CHECK(db(0.0, 4.0) == doctest::Approx(0.0));
  CHECK(db(10.0, 0.0) == doctest::Approx(-1.0));
  CHECK(db(0.0, -10.0) == doctest::Approx(-1.0));
  CHECK(db(14.999999, 0.0) == doctest::Approx(-2.0).epsilon(1e-6));
  CHECK(db(15.000001, 0.0) == doctest::Approx(-9.0).epsilon(1e-6));
  CHECK(db(-25.0, 0.0) == doctest::Approx(-14.0));
  CHECK(db(50.0, 0.0) == doctest::Approx(-19.0));
  // Off the axis both ways: by the angle between the directions, acos(cos 20 cos 20) = 27.99 deg.
  CHECK(db(20.0, 20.0) == doctest::Approx(-9.0 - 0.5 * (degrees(std::acos(std::pow(std::cos(radians(20.0)), 2))) - 15.0)));
}

TEST_CASE("there is no gain outside the opening") {
  for (const char* gain : {"flat", "gaussian"}) {
    const Antenna square(lobe(60.0, 40.0, 4, 4, gain));
    CHECK(square.gain(radians(29.99), radians(19.99)) > 0.0);
    CHECK(square.gain(radians(30.01), 0.0) == 0.0);
    CHECK(square.gain(0.0, radians(-20.01)) == 0.0);
    CHECK(square.gain(pi, 0.0) == 0.0);
    const Antenna ellipse(lobe(60.0, 40.0, 4, 4, gain, "elliptic"));
    CHECK(ellipse.gain(radians(30.0), 0.0) > 0.0);
    CHECK(ellipse.gain(radians(0.7 * 30.0), radians(0.7 * 20.0)) > 0.0);
    CHECK(ellipse.gain(radians(0.71 * 30.0), radians(0.71 * 20.0)) == 0.0);
  }
  ScanningRadarSpec spec;
  spec.elevation_opening_deg = 10.0;
  spec.elevation_rays = 2;
  CHECK(Antenna(spec).gain(radians(0.49), radians(4.99)) == 1.0);
  CHECK(Antenna(spec).gain(radians(0.51), 0.0) == 0.0);
  CHECK(Antenna(spec).gain(0.0, radians(5.01)) == 0.0);
  CHECK(Antenna(ScanningRadarSpec{}).gain(0.0, radians(0.51)) == 0.0);
}

TEST_CASE("gain towards a direction") {
  const Antenna antenna(lobe(100.0, 80.0, 4, 4, "gaussian"));
  Dice dice(7);
  for (int i = 0; i < 200; ++i) {
    const double azimuth = dice.between(-0.8, 0.8), elevation = dice.between(-0.65, 0.65), length = dice.between(0.1, 20.0);
    const glm::dvec3 towards(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    REQUIRE(antenna.gain(length * towards) == doctest::Approx(antenna.gain(azimuth, elevation)).epsilon(1e-12));
  }
  CHECK(antenna.gain(glm::dvec3(-1.0, 0.0, 0.0)) == 0.0);
  CHECK(antenna.gain(glm::dvec3(0.0, 0.0, -1.0)) == 0.0);
}

TEST_CASE("cells of a lobe are a regular grid, rays in their middles") {
  const Antenna antenna(lobe(60.0, 30.0, 6, 3));
  REQUIRE(antenna.rays().size() == 18);
  CHECK(antenna.beam_azimuths() == std::vector<double>{0.0});
  CHECK(antenna.opening().x == radians(60.0));
  CHECK(antenna.opening().y == radians(30.0));
  for (std::size_t i = 0; i < 18; ++i) {
    const SubRay& ray = antenna.rays()[i];
    CHECK(ray.index == i);
    CHECK(ray.azimuth == doctest::Approx(radians(-25.0 + 10.0 * static_cast<double>(i % 6))));
    CHECK(ray.elevation == doctest::Approx(radians(-10.0 + 10.0 * static_cast<double>(i / 6))));
    CHECK(ray.azimuth_cell == doctest::Approx(radians(10.0)));
    CHECK(ray.elevation_cell == doctest::Approx(radians(10.0)));
  }
  // An elliptic one leaves out the corners, and has a share of 0 where it touches a cell but not its middle.
  const Antenna ellipse(lobe(60.0, 60.0, 20, 20, "flat", "elliptic"));
  std::size_t inside = 0;
  for (const SubRay& ray : ellipse.rays()) {
    const bool within = std::hypot(ray.azimuth, ray.elevation) <= radians(30.0);
    CHECK((ray.share > 0.0) == within);
    inside += within;
  }
  CHECK(inside == 316);  // of 400, middles of cells in a disc
  CHECK(ellipse.rays().size() > inside);
  CHECK(ellipse.rays().size() < 400);
}

TEST_CASE("shares of jittered rays sum to 1 on average") {
  std::uint64_t seed = 100;
  for (const Antenna& antenna : all_kinds()) {
    CAPTURE(seed);
    const Estimate shares = seen_by_jitter(antenna, 4000, seed++, true);
    CHECK(std::abs(shares.mean - 1.0) <= 4.0 * shares.error + 1e-9);
    CHECK(shares.error < 0.01);
  }
}

TEST_CASE("jittered rays see on average what there is") {
  constexpr double grid = 2e-5;  // of the sum over a grid that they are held against
  std::uint64_t seed = 200;
  for (const char* gain : {"flat", "gaussian", "table"})
    for (const char* section : {"square", "elliptic"}) {
      CAPTURE(seed);
      LobeRadarSpec spec = lobe(80.0, 50.0, 9, 6, gain, section);
      spec.gain_table_db = {{0.0, 0.0}, {20.0, -1.0}, {50.0, -12.0}};
      const Antenna antenna(spec);
      const Estimate seen = seen_by_jitter(antenna, 4000, seed++);
      CHECK(std::abs(seen.mean - seen_by_gain(antenna, radians(80.0), radians(50.0))) <= 4.0 * seen.error + grid);
    }
  ScanningRadarSpec spec;
  spec.step_deg = 10.0;
  spec.elevation_opening_deg = 40.0;
  spec.elevation_rays = 5;
  const Antenna rows(spec);
  const Estimate of_rows = seen_by_jitter(rows, 4000, seed++);
  CHECK(std::abs(of_rows.mean - seen_by_gain(rows, radians(10.0), radians(40.0))) <= 4.0 * of_rows.error + grid);
  spec.divergence = "cone";
  spec.cone_opening_deg = 20.0;
  spec.elevation_opening_deg = 0.0;
  const Antenna cone(spec);
  const Estimate of_cone = seen_by_jitter(cone, 4000, seed++);
  // All rays of a cone count alike, a cos(elevation) less than `gain` would have them: 0.4 % of what differs in it.
  CHECK(std::abs(of_cone.mean - seen_by_gain(cone, radians(20.0), radians(20.0))) <= 4.0 * of_cone.error + 2e-4);
  // Cones above one another: the mean over the disc and over the height of its middle, by the cosine of the latter.
  spec.elevation_opening_deg = 40.0;
  const Antenna cones(spec);
  const Estimate of_cones = seen_by_jitter(cones, 4000, seed++);
  double sum = 0.0, weights = 0.0;
  constexpr int n = 150;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const double x = 2.0 * (i + 0.5) / n - 1.0, y = 2.0 * (j + 0.5) / n - 1.0, row = radians(40.0) * ((k + 0.5) / n - 0.5);
        if (x * x + y * y > 1.0) continue;
        sum += std::cos(row) * scenery(radians(10.0) * x, row + radians(10.0) * y);
        weights += std::cos(row);
      }
  CHECK(std::abs(of_cones.mean - sum / weights) <= 4.0 * of_cones.error + grid);
}

TEST_CASE("jittered rays stay in their cells") {
  const Random random(3, 0);
  for (const Antenna& antenna : all_kinds())
    for (const SubRay& ray : antenna.rays())
      for (std::uint64_t scan = 0; scan < 50; ++scan) {
        const auto u = random.uniform(scan, 0, RandomUse::sampling, ray.index);
        const SubRay moved = antenna.jittered(ray, {u[0], u[1]});
        REQUIRE(moved.side == ray.side);
        REQUIRE(moved.share >= 0.0);
        if (antenna.gain(moved.azimuth, moved.elevation) == 0.0) {
          // Only beside the section of an elliptic lobe, where it counts for nothing; side rays are beside their beam.
          REQUIRE((moved.share == 0.0 || moved.side != 0));
        }
        if (antenna.rays().size() % 7 == 0 && antenna.beam_azimuths().size() > 1) continue;  // a cone: its disc, as `gain` has said
        REQUIRE(std::abs(moved.azimuth - ray.azimuth) <= 0.5 * ray.azimuth_cell * (1.0 + 1e-12));
        REQUIRE(std::abs(moved.elevation - ray.elevation) <= 0.5 * ray.elevation_cell * (1.0 + 1e-12));
      }
}

TEST_CASE("a scanner that is one ray looks exactly along its axis") {
  for (const bool cone : {false, true}) {
    ScanningRadarSpec spec;
    if (cone) spec.divergence = "cone";
    spec.cone_rays = 1;
    spec.elevation_rays = 9;  // of no opening: one row
    const Antenna antenna(spec);
    REQUIRE(antenna.rays().size() == 1);
    const SubRay& ray = antenna.rays()[0];
    CHECK(ray.azimuth == 0.0);
    CHECK(ray.elevation == 0.0);
    CHECK(ray.lateral == 0.0);
    CHECK(ray.share == 1.0);
    CHECK(ray.side == 0);
    CHECK(antenna.beam_azimuths() == azimuths_of(spec));
    CHECK(antenna.opening() == (cone ? glm::dvec2(radians(2.0)) : glm::dvec2(0.0)));
    if (!cone) {
      CHECK(ray.azimuth_cell == radians(1.0));
      CHECK(ray.elevation_cell == radians(1.0));
      CHECK(antenna.jittered(ray, {0.1, 0.9}).elevation == 0.0);
    }
  }
}

TEST_CASE("rows, side rays and cones of a scanner") {
  ScanningRadarSpec spec;
  spec.elevation_opening_deg = 12.0;
  spec.elevation_rays = 4;
  spec.divergence = "side_rays";
  spec.side_offset_m = 0.5;
  {
    const Antenna antenna(spec);
    REQUIRE(antenna.rays().size() == 12);
    for (std::size_t i = 0; i < 12; ++i) {
      const SubRay& ray = antenna.rays()[i];
      CHECK(ray.side == std::array{0, 1, -1}[i % 3]);
      CHECK(ray.azimuth == doctest::Approx(ray.side * std::atan(0.5 / 30.0)));
      CHECK(ray.lateral == 0.0);
      CHECK(ray.elevation == doctest::Approx(radians(-4.5 + 3.0 * static_cast<double>(i / 3))));
      CHECK(ray.elevation_cell == doctest::Approx(radians(3.0)));
      CHECK(ray.share / antenna.rays()[0].share == doctest::Approx(std::cos(ray.elevation) / std::cos(radians(4.5))));
    }
    CHECK(antenna.opening() == glm::dvec2(0.0, radians(12.0)));
  }
  spec.side_geometry = "parallel";
  {
    const Antenna antenna(spec);
    for (const SubRay& ray : antenna.rays()) {
      CHECK(ray.azimuth == 0.0);
      CHECK(ray.lateral == ray.side * 0.5);
    }
  }
  spec.divergence = "cone";
  spec.elevation_opening_deg = 0.0;
  spec.cone_opening_deg = 3.0;
  spec.cone_rays = 100;
  {
    const Antenna antenna(spec);
    REQUIRE(antenna.rays().size() == 100);
    double nearest = 1.0;
    glm::dvec2 middle(0.0);
    std::size_t inner = 0;
    for (const SubRay& a : antenna.rays()) {
      CHECK(a.share == doctest::Approx(0.01));
      CHECK(a.azimuth_cell * a.elevation_cell == doctest::Approx(0.01 * pi * std::pow(radians(1.5), 2)));
      CHECK(std::hypot(a.azimuth, a.elevation) <= radians(1.5));
      middle += 0.01 * glm::dvec2(a.azimuth, a.elevation);
      inner += std::hypot(a.azimuth, a.elevation) < radians(0.75);
      for (const SubRay& b : antenna.rays())
        if (a.index != b.index) nearest = std::min(nearest, std::hypot(a.azimuth - b.azimuth, a.elevation - b.elevation));
    }
    CHECK(inner == 25);  // half the radius, a quarter of the area
    CHECK(glm::length(middle) < 0.02 * radians(1.5));
    CHECK(nearest > 0.5 * antenna.rays()[0].azimuth_cell);
    CHECK(antenna.opening() == glm::dvec2(radians(3.0)));
  }
}

TEST_CASE("rays for a spacing, eq. 4.4") {
  CHECK(rays_for_spacing(radians(65.0), 0.2, 10.0) == 58);  // 57.73 in the text
  CHECK(radians(65.0) / (2.0 * std::atan(0.01)) + 1.0 == doctest::Approx(57.73).epsilon(1e-4));
  CHECK(rays_for_spacing(radians(65.0), 0.4, 10.0) == 29);
  CHECK(rays_for_spacing(radians(1.0), 5.0, 10.0) == 2);
  CHECK(rays_for_spacing(radians(65.0), 1e-300, 10.0) == 1000000000);
  // So many are neighbours as far apart as was asked for (eq. 4.3), but for the rounding.
  CHECK(2.0 * 10.0 * std::tan(0.5 * radians(65.0) / 57.0) == doctest::Approx(0.2).epsilon(0.01));
  LobeRadarSpec spec = lobe(65.0, 30.0, 3, 3);
  spec.ray_spacing_m = 0.2;
  spec.range_max_m = 10.0;
  CHECK(Antenna(spec).rays().size() == static_cast<std::size_t>(58 * rays_for_spacing(radians(30.0), 0.2, 10.0)));
}

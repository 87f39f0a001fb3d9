// Whole scans: where beams point, how they diverge, noise, threads, and the lidar.
#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "../hand_made_world.hpp"
#include "one_beam.hpp"

using namespace thicket;

namespace {

/// A ring of foliage balls with walls behind, so that a scan has beams of every kind.
World clearing() {
  HandMadeWorld w;
  const auto wall = w.material("wall", 0.5, infinity), foliage = w.material("foliage", 0.05, 7.5),
             smoke = w.material("smoke", 1e-7, 0.05, true, false);
  Dice dice(41);
  for (int i = 0; i < 40; ++i)
    w.add(Sphere{dice.between(0.3, 1.5)}, {dice.between(4.0, 8.0) * direction(dice.between(-pi, pi)), 0.3}, 0.0, foliage);
  for (int i = 0; i < 5; ++i) w.add(Sphere{2.0}, {dice.between(3.0, 8.0) * direction(dice.between(-pi, pi)), 0.3}, 0.0, smoke);
  w.add(Wall{{{-10.0, -10.0}, {10.0, -10.0}, {10.0, 10.0}}, 0.2, 2.5}, {0.0, 0.0, 0.0}, 0.0, wall);
  return w.world;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(const Scan& a, const Scan& b) {
  const auto same_beam = [](const Beam& p, const Beam& q) {
    return same_bits(p.azimuth, q.azimuth) && same_bits(p.elevation, q.elevation) && same_bits(p.sensed_range, q.sensed_range) &&
           p.first_echo == q.first_echo && p.echo_count == q.echo_count && p.end == q.end && p.starts_inside == q.starts_inside &&
           p.side == q.side;
  };
  const auto same_echo = [](const Echo& p, const Echo& q) {
    return same_bits(p.range, q.range) && same_bits(p.amplitude, q.amplitude) && same_bits(p.incidence_cosine, q.incidence_cosine) &&
           p.edge == q.edge;
  };
  return a.sensor == b.sensor && a.number == b.number && same_bits(a.time, b.time) && a.rays == b.rays &&
         std::ranges::equal(a.beams, b.beams, same_beam) && std::ranges::equal(a.echoes, b.echoes, same_echo);
}

template <class Spec>
Spec flat_scan(double fov_deg, double step_deg, double range_max_m = 30.0) {
  Spec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.fov_deg = fov_deg;
  spec.step_deg = step_deg;
  spec.range_max_m = range_max_m;
  return spec;
}

std::vector<double> azimuths_in_degrees(double fov_deg, double step_deg) {
  std::vector<double> list;
  for (const Beam& beam : measured(flat_scan<ScanningRadarSpec>(fov_deg, step_deg), traced(World{})).beams)
    list.push_back(degrees(beam.azimuth));
  return list;
}
bool are(const std::vector<double>& found, const std::vector<double>& expected) {
  return std::ranges::equal(found, expected, [](double a, double b) { return std::abs(a - b) < 1e-12; });
}

}  // namespace

TEST_CASE("azimuths: a full circle begins behind and closes without a double, a sector is centred") {
  CHECK(are(azimuths_in_degrees(360.0, 90.0), {-180.0, -90.0, 0.0, 90.0}));
  CHECK(are(azimuths_in_degrees(180.0, 45.0), {-90.0, -45.0, 0.0, 45.0, 90.0}));
  CHECK(are(azimuths_in_degrees(100.0, 30.0), {-45.0, -15.0, 15.0, 45.0}));
  CHECK(are(azimuths_in_degrees(10.0, 30.0), {0.0}));
  CHECK(azimuths_in_degrees(360.0, 1.0).size() == 360);
  CHECK(azimuths_in_degrees(360.0, 0.1).size() == 3600);  // 360 / 0.1 is a little less than 3600 in binary
  CHECK(azimuths_in_degrees(270.0, 0.25).size() == 1081);
  // A step that does not divide the circle leaves a gap that is no smaller than itself.
  const auto sevens = azimuths_in_degrees(360.0, 7.0);
  CHECK(sevens.size() == 51);
  CHECK(sevens.back() == doctest::Approx(170.0).epsilon(1e-13));
}

TEST_CASE("a scan says what it is") {
  ScanningRadarSpec spec = flat_scan<ScanningRadarSpec>(180.0, 1.0, 12.0);
  spec.position_m = {0.1, 0.2, 0.3};
  spec.yaw_deg = 90.0;
  spec.range_min_m = 0.5;
  Scan scan;
  scan.beams.resize(7);
  scan.echoes.resize(9);
  make_sensor(spec, 3)->measure(traced(World{}), {}, 1.25, 42, Random(1, 3), scan);
  CHECK(scan.sensor == 3);
  CHECK(scan.number == 42);
  CHECK(scan.time == 1.25);
  CHECK(scan.range_min == 0.5);
  CHECK(scan.range_max == 12.0);
  CHECK(scan.rays == 181);
  CHECK(scan.beams.size() == 181);
  CHECK(scan.mount_position == glm::dvec3(0.1, 0.2, 0.3));
  const glm::dvec3 x_axis = scan.mount_orientation * glm::dvec3(1.0, 0.0, 0.0);
  CHECK(glm::distance(x_axis, glm::dvec3(0.0, 1.0, 0.0)) < 1e-15);
  CHECK(make_sensor(spec, 3)->spec().yaw_deg == 90.0);
}

TEST_CASE("beams that meet nothing are silent, open and as long as the range") {
  HandMadeWorld w;
  w.add(Sphere{1.0}, {-5.0, 0.0, 0.0});
  for (const SensorSpec& spec : {SensorSpec(flat_scan<ScanningRadarSpec>(360.0, 10.0)), SensorSpec(flat_scan<LidarSpec>(360.0, 10.0))}) {
    const Scan scan = measured(spec, traced(w));
    std::size_t silent = 0;
    for (const Beam& beam : scan.beams) {
      if (beam.echo_count > 0) continue;
      ++silent;
      CHECK(beam.end == BeamEnd::open);
      CHECK(beam.sensed_range == 30.0);
      CHECK(scan.echoes_of(beam).empty());
      CHECK_FALSE(beam.starts_inside);
    }
    CHECK(silent == 33);  // the ball takes the beams at 180 and +-170 degrees: its half angle is 11.5
    CHECK(scan.echoes.size() == 3);
  }
}

TEST_CASE("a scan is seen from where the sensor is: vehicle, mount and beam") {
  // A post straight ahead of the beam at azimuth 30 degrees, of a sensor turned by 20 and 1 m ahead, on a vehicle at (3, -2) turned by 40.
  const Pose vehicle = Pose::planar(3.0, -2.0, 0.5, radians(40.0));
  const glm::dvec2 sensor = glm::dvec2(3.0, -2.0) + direction(radians(40.0));
  const glm::dvec2 post = sensor + 7.0 * direction(radians(90.0));
  HandMadeWorld w;
  w.add(Cylinder{0.05, 0.2}, {post, 1.0});
  ScanningRadarSpec spec = flat_scan<ScanningRadarSpec>(360.0, 10.0);
  spec.position_m = {1.0, 0.0, 0.5};
  spec.yaw_deg = 20.0;
  const Scan scan = measured(spec, traced(w), vehicle);
  REQUIRE(scan.echoes.size() == 1);
  CHECK(scan.echoes[0].range == doctest::Approx(6.95).epsilon(1e-13));
  const auto beam = std::ranges::find_if(scan.beams, [](const Beam& b) { return b.echo_count == 1; });
  CHECK(degrees(beam->azimuth) == doctest::Approx(30.0).epsilon(1e-13));
  // 0.2 m lower it passes under.
  spec.position_m.z = 0.3;
  CHECK(measured(spec, traced(w), vehicle).echoes.empty());
}

TEST_CASE("a vehicle that tilts tilts its scan") {
  // Nose down by 30 degrees, 2 m above the floor: 4 m straight ahead, the sides level, behind the sky.
  HandMadeWorld w;
  w.add(Box{{100.0, 100.0, 1.0}}, {0.0, 0.0, -0.5});
  const Pose vehicle{{0.0, 0.0, 2.0}, glm::dquat(std::cos(pi / 12), 0.0, std::sin(pi / 12), 0.0)};
  const Scan scan = measured(flat_scan<LidarSpec>(360.0, 90.0), traced(w), vehicle);
  REQUIRE(scan.echoes.size() == 1);
  CHECK(scan.echoes[0].range == doctest::Approx(4.0).epsilon(1e-14));
  CHECK(scan.beams[2].echo_count == 1);
}

TEST_CASE("side rays: each of the three by equal chance") {
  ScanningRadarSpec spec = flat_scan<ScanningRadarSpec>(360.0, 0.1);
  spec.divergence = "side_rays";
  const Scene scene = traced(World{});
  std::size_t counts[3] = {0, 0, 0}, repeats = 0, total = 0;
  std::vector<int> last;
  for (std::uint64_t number = 0; number < 5; ++number) {
    std::vector<int> sides;
    for (const Beam& beam : measured(spec, scene, {}, number).beams) sides.push_back(beam.side);
    for (const int side : sides) {
      REQUIRE(std::abs(side) <= 1);
      ++counts[side + 1];
    }
    for (std::size_t i = 0; i < last.size(); ++i) repeats += sides[i] == last[i];
    total += sides.size();
    last = sides;
  }
  const auto fair = [](std::size_t count, std::size_t of) {
    const double n = static_cast<double>(of);
    return std::abs(static_cast<double>(count) - n / 3.0) < 4.0 * std::sqrt(n * 2.0 / 9.0);
  };
  CHECK(total == 18000);
  for (const std::size_t count : counts) CHECK(fair(count, total));
  CHECK(fair(repeats, total / 5 * 4));  // one scan tells nothing of the next
  // Without divergence there is the middle one alone.
  spec.divergence = "none";
  for (const Beam& beam : measured(spec, scene).beams) REQUIRE(beam.side == 0);
}

TEST_CASE("side rays: where they go") {
  // Thin posts in a beam's way and N beside it, near and far. A side ray meets those that lie on it and no others.
  constexpr double offset = 0.2, range_max = 20.0, radius = 0.005;
  const auto posts_met = [&](const char* geometry, double x, double y) {
    // A fan of posts would hide one another: one post a world, every side asked for by many scans.
    HandMadeWorld w;
    w.add(Cylinder{radius, 2.0}, {x, y, 0.0});
    ScanningRadarSpec spec = one_beam_radar();
    spec.range_max_m = range_max + 1.0;
    spec.divergence = "side_rays";
    spec.side_offset_m = offset * (range_max + 1.0) / range_max;  // so that the offset is N at 20 m
    if (std::string(geometry) == "parallel") spec.side_offset_m = offset;
    spec.side_geometry = geometry;
    const Scene scene = traced(w);
    std::set<int> met, seen;
    for (std::uint64_t number = 0; number < 40; ++number) {
      const Scan scan = measured(spec, scene, {}, number);
      seen.insert(scan.beams[0].side);
      if (scan.echoes.size() == 1) met.insert(scan.beams[0].side);
    }
    CHECK(seen == std::set<int>{-1, 0, 1});
    return met;
  };
  const std::set<int> none, left = {1}, middle = {0}, right = {-1}, all = {-1, 0, 1};
  SUBCASE("diverging: from one point, N off at the end of the range, half of it half way") {
    CHECK(posts_met("diverging", 20.0, 0.0) == middle);
    CHECK(posts_met("diverging", 20.0, offset) == left);
    CHECK(posts_met("diverging", 20.0, -offset) == right);
    CHECK(posts_met("diverging", 10.0, 0.5 * offset) == left);
    CHECK(posts_met("diverging", 10.0, -0.5 * offset) == right);
    CHECK(posts_met("diverging", 10.0, offset) == none);
    CHECK(posts_met("diverging", 0.1, 0.0) == all);
  }
  SUBCASE("parallel: N off everywhere") {
    for (const double x : {0.1, 10.0, 20.0}) {
      CAPTURE(x);
      CHECK(posts_met("parallel", x, 0.0) == middle);
      CHECK(posts_met("parallel", x, offset) == left);
      CHECK(posts_met("parallel", x, -offset) == right);
      CHECK(posts_met("parallel", x, 0.5 * offset) == none);
    }
  }
}

TEST_CASE("side rays: their ranges on a wall across the beam") {
  HandMadeWorld w;
  w.add(Box{{1.0, 50.0, 50.0}}, {10.5, 0.0, 0.0});
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.range_max_m = 20.0;
  spec.divergence = "side_rays";
  spec.side_offset_m = 2.0;
  for (const char* geometry : {"diverging", "parallel"}) {
    spec.side_geometry = geometry;
    for (std::uint64_t number = 0; number < 20; ++number) {
      const Scan scan = measured(spec, scene, {}, number);
      REQUIRE(scan.echoes.size() == 1);
      const bool slant = scan.beams[0].side != 0 && std::string(geometry) == "diverging";
      // 2 m off at 20 m: 1 m off at 10 m.
      REQUIRE(scan.echoes[0].range == doctest::Approx(slant ? std::hypot(10.0, 1.0) : 10.0).epsilon(1e-14));
    }
  }
}

TEST_CASE("range noise has the mean and the deviation that it was given, and shifts a beam's echoes together") {
  HandMadeWorld w;
  const auto wall = w.material("wall", 0.5, infinity), foliage = w.material("foliage", 0.05, 2.0);
  w.add(Cylinder{1.0, 5.0}, {0.0, 0.0, 0.0}, 0.0, wall);
  const Pose vehicle = Pose::planar(-11.0, 0.0, 0.0, 0.0);
  SUBCASE("one echo") {
    for (const SensorSpec& like : {SensorSpec(one_beam_radar()), SensorSpec(flat_scan<LidarSpec>(1.0, 180.0))}) {
      SensorSpec spec = like;
      std::visit([](auto& s) { s.range_noise_m = 0.05; }, spec);
      const Scene scene = traced(w);
      const auto sensor = make_sensor(spec, 0);
      const Random random(5, 0);
      Scan scan;
      constexpr int count = 20000;
      double sum = 0.0, squares = 0.0;
      for (int i = 0; i < count; ++i) {
        sensor->measure(scene, vehicle, 0.0, static_cast<std::uint64_t>(i), random, scan);
        REQUIRE(scan.echoes.size() == 1);
        REQUIRE(scan.beams[0].sensed_range == scan.echoes[0].range);
        const double off = scan.echoes[0].range - 10.0;
        sum += off;
        squares += off * off;
      }
      const double n = count;
      CHECK(std::abs(sum / n) < 4.0 * 0.05 / std::sqrt(n));
      CHECK(std::abs(std::sqrt(squares / n) / 0.05 - 1.0) < 4.0 / std::sqrt(2.0 * n));
    }
  }
  SUBCASE("several echoes, of beams that draw for themselves") {
    for (int i = 0; i < 36; ++i) w.add(Cylinder{0.2, 5.0}, {6.0 * direction(radians(10.0 * i)), 0.0}, 0.0, foliage);
    w.world.solids.erase(w.world.solids.begin());  // the foliage alone, seen from its middle
    ScanningRadarSpec spec = flat_scan<ScanningRadarSpec>(360.0, 10.0);
    const Scene scene = traced(w);
    const Scan exact = measured(spec, scene);
    spec.range_noise_m = 0.1;
    const Scan noisy = measured(spec, scene);
    REQUIRE(noisy.echoes.size() == 72);
    std::set<double> shifts;
    for (std::size_t b = 0; b < noisy.beams.size(); ++b) {
      const auto a = exact.echoes_of(exact.beams[b]), n = noisy.echoes_of(noisy.beams[b]);
      REQUIRE(n.size() == 2);
      CHECK(n[1].range - n[0].range == doctest::Approx(a[1].range - a[0].range).epsilon(1e-12));
      CHECK(same_bits(n[0].amplitude, a[0].amplitude));
      shifts.insert(n[0].range - a[0].range);
      CHECK(noisy.beams[b].sensed_range == 30.0);  // an open beam's end is no echo
    }
    CHECK(shifts.size() == 36);
  }
  SUBCASE("never a negative range") {
    ScanningRadarSpec spec = one_beam_radar();
    spec.range_noise_m = 1000.0;
    const Scene scene = traced(w);
    for (std::uint64_t number = 0; number < 50; ++number) {
      const Scan scan = measured(spec, scene, vehicle, number);
      REQUIRE(scan.echoes.at(0).range >= 0.0);
      REQUIRE(scan.beams[0].sensed_range >= 0.0);
    }
  }
}

TEST_CASE("the same seed gives the same scan to the last bit, another seed, scan or sensor another") {
  ScanningRadarSpec spec = flat_scan<ScanningRadarSpec>(360.0, 1.0);
  spec.range_noise_m = 0.02;
  spec.divergence = "side_rays";
  const Scene scene = traced(clearing());
  const Scan scan = measured(spec, scene, {}, 7, 1);
  CHECK(scan.echoes.size() > 100);
  CHECK(same_bits(scan, measured(spec, scene, {}, 7, 1)));
  CHECK(same_bits(scan, measured(spec, traced(clearing()), {}, 7, 1)));
  CHECK_FALSE(same_bits(scan, measured(spec, scene, {}, 7, 2)));
  Scan next = measured(spec, scene, {}, 8, 1);
  next.number = 7;
  CHECK_FALSE(same_bits(scan, next));
  Scan other;
  make_sensor(spec, 0)->measure(scene, {}, 0.0, 7, Random(1, 1), other);
  CHECK_FALSE(same_bits(scan, other));
  // A scan whose memory is used again holds nothing of the last one.
  Scan used = measured(flat_scan<ScanningRadarSpec>(360.0, 0.5), scene);
  make_sensor(spec, 0)->measure(scene, {}, 0.0, 7, Random(1, 0), used);
  CHECK(same_bits(scan, used));
}

TEST_CASE("a scan does not depend on the number of threads") {
  ScanningRadarSpec radar = flat_scan<ScanningRadarSpec>(360.0, 0.05);
  radar.range_noise_m = 0.02;
  radar.divergence = "side_rays";
  LidarSpec lidar = flat_scan<LidarSpec>(360.0, 0.05);
  lidar.range_noise_m = 0.02;
  const Scene scene = traced(clearing());
  for (const SensorSpec& spec : {SensorSpec(radar), SensorSpec(lidar)}) {
    const auto with_threads = [&](std::size_t threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return measured(spec, scene, Pose::planar(0.1, 0.2, 0.3, 0.4), 3);
    };
    const Scan one = with_threads(1);
    CHECK(one.beams.size() == 7200);
    CHECK(one.echoes.size() > 2000);
    for (int i = 0; i < 5; ++i) CHECK(same_bits(one, with_threads(2)));
    CHECK(same_bits(one, with_threads(7)));
  }
}

TEST_CASE("beams do not depend on how many there are") {
  // A beam of a scan that is shared out among tasks is the beam of a scan that is not.
  const Scene scene = traced(clearing());
  const Scan fine = measured(flat_scan<ScanningRadarSpec>(360.0, 0.125), scene),
             coarse = measured(flat_scan<ScanningRadarSpec>(360.0, 1.0), scene);
  REQUIRE(fine.beams.size() == 2880);
  for (std::size_t i = 0; i < coarse.beams.size(); ++i) {
    const auto a = coarse.echoes_of(coarse.beams[i]), b = fine.echoes_of(fine.beams[8 * i]);
    REQUIRE(same_bits(coarse.beams[i].sensed_range, fine.beams[8 * i].sensed_range));
    REQUIRE(std::ranges::equal(
        a, b, [](const Echo& p, const Echo& q) { return same_bits(p.range, q.range) && same_bits(p.amplitude, q.amplitude); }));
  }
}

TEST_CASE("a lidar stops at the first surface that stops light") {
  HandMadeWorld w;
  const auto wall = w.material("wall", 0.5, infinity), foliage = w.material("foliage", 0.05, 7.5),
             smoke = w.material("smoke", 1e-7, 0.05, true, false), glass = w.material("glass", 0.1, 34.0, false, true);
  const auto first_behind = [&](std::uint32_t material, double yaw = 0.0) {
    HandMadeWorld one;
    one.world.materials = w.world.materials;
    one.add(Box{{1.0, 50.0, 50.0}}, {20.5, 0.0, 0.0}, 0.0, wall);
    one.add(Box{{1.0 * std::cos(yaw), 10.0, 10.0}}, {5.5, 0.0, 0.0}, yaw, material);
    return looked(flat_scan<LidarSpec>(1.0, 180.0), traced(one));
  };
  for (const std::uint32_t material : {wall, foliage, smoke}) {
    CAPTURE(material);
    const OneBeam b = first_behind(material, pi / 3);
    REQUIRE(b.echoes.size() == 1);
    CHECK(b.echoes[0].range == doctest::Approx(5.0).epsilon(1e-14));
    CHECK(b.echoes[0].incidence_cosine == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(b.power(0) == as_power(0.5));
    CHECK(b.echoes[0].edge == Edge::front);
    CHECK(b.beam.end == BeamEnd::stopped);
    CHECK(b.beam.sensed_range == b.echoes[0].range);
  }
  CHECK(first_behind(glass).echoes.at(0).range == 20.0);
}

TEST_CASE("a lidar sees nothing nearer than range_min and nothing beyond range_max") {
  HandMadeWorld w;
  w.add(Box{{1.0, 10.0, 10.0}}, {5.5, 0.0, 0.0});
  const Scene scene = traced(w);
  LidarSpec spec = flat_scan<LidarSpec>(1.0, 180.0);
  spec.range_min_m = 5.5;
  const OneBeam near = looked(spec, scene);
  CHECK(near.echoes.empty());
  CHECK(near.beam.end == BeamEnd::stopped);
  CHECK(near.beam.sensed_range == 5.0);
  spec.range_min_m = 0.0;
  spec.range_max_m = 4.5;
  const OneBeam far = looked(spec, scene);
  CHECK(far.echoes.empty());
  CHECK(far.beam.end == BeamEnd::open);
  CHECK(far.beam.sensed_range == 4.5);
}

TEST_CASE("which matter a sensor detects at all") {
  const Material wall{"wall", 0.5, infinity, 1.0, true, true}, smoke{"smoke", 1e-7, 0.05, 1.0, true, false},
      glass{"glass", 0.1, 34.0, 1.0, false, true}, vacuum{"vacuum", 0.0, 0.0, 1.0, false, false};
  ScanningRadarSpec radar;
  radar.detection_floor_db = -60.0;
  CHECK(make_sensor(radar, 0)->detects(wall));
  CHECK(make_sensor(radar, 0)->detects(glass));
  CHECK_FALSE(make_sensor(radar, 0)->detects(smoke));
  radar.detection_floor_db = -71.0;
  CHECK(make_sensor(radar, 0)->detects(smoke));
  CHECK_FALSE(make_sensor(radar, 0)->detects(vacuum));
  CHECK(make_sensor(LidarSpec{}, 0)->detects(wall));
  CHECK(make_sensor(LidarSpec{}, 0)->detects(smoke));
  CHECK_FALSE(make_sensor(LidarSpec{}, 0)->detects(glass));
}

// Beams of several rays: side rays, cones, rows over an elevation opening, and what jitter does to directions.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "lobe.hpp"

using namespace thicket;

namespace {

/// One beam along x at three walls side by side, each where one of the three rays goes: left at 6 m, middle at 8 m, right at 10 m; the left one turned away by 60 degrees.
struct SideWorld : HandMadeWorld {
  SideWorld() {
    rough_metal(*this);
    Solid left{"left", 0, {6.0, 0.6, 0.0}, pi / 3, Box{{0.001, 0.6, 2.0}}};
    world.solids.push_back(left);
    add(Box{{1.0, 0.3, 2.0}}, {8.5, 0.0, 0.0});
    add(Box{{1.0, 1.0, 2.0}}, {10.5, -1.0, 0.0});
  }
};

ScanningRadarSpec with_sides(const char* choice) {
  ScanningRadarSpec spec = one_beam_radar();
  spec.range_max_m = 20.0;
  spec.divergence = "side_rays";
  spec.side_offset_m = 2.0;  // 0.6 m off at 6 m, 1 m off at 10 m
  spec.side_choice = choice;
  return spec;
}

/// How often each side gives the beam.
std::map<int, int> sides(const ScanningRadarSpec& spec, const Scene& scene, int scans) {
  std::map<int, int> counts;
  const auto sensor = make_sensor(spec, 0);
  Scan scan;
  for (int i = 0; i < scans; ++i) {
    sensor->measure(scene, Pose{}, 0.0, static_cast<std::uint64_t>(i), Random(1, 0), scan);
    REQUIRE(scan.beams.size() == 1);
    REQUIRE(scan.echoes.size() == 1);
    const int side = scan.beams[0].side;
    const double off = std::hypot(1.0, 0.1);  // a side ray is longer
    CHECK(scan.echoes[0].range == doctest::Approx(side > 0 ? 6.0 * off : side < 0 ? 10.0 * off : 8.0).epsilon(0.05));
    CHECK(std::pow(scan.echoes[0].amplitude, 2) > 0.3);  // it stands for the whole beam
    ++counts[side];
  }
  return counts;
}

}  // namespace

TEST_CASE("which of the side rays is the beam: by equal chance, by incidence, the strongest") {
  const Scene scene = traced(SideWorld());
  const int scans = 6000;
  const auto within = [&](int count, double share) { return std::abs(count - share * scans) < 3.5 * std::sqrt(scans * share * (1.0 - share)); };
  auto equal = sides(with_sides("equal"), scene, scans);
  for (const int side : {-1, 0, 1}) CHECK(within(equal[side], 1.0 / 3.0));
  // The left wall's normal is at 60 degrees to the beam, its ray comes along 5.7 degrees to the left of it.
  const double left = std::cos(pi / 3 - std::atan(0.1)), right = std::cos(std::atan(0.1)), sum = left + 1.0 + right;
  auto incidence = sides(with_sides("incidence"), scene, scans);
  CHECK(within(incidence[1], left / sum));
  CHECK(within(incidence[0], 1.0 / sum));
  CHECK(within(incidence[-1], right / sum));
  auto strongest = sides(with_sides("strongest"), scene, 50);
  CHECK(strongest[0] == 50);  // squarely
}

TEST_CASE("all side rays summed: three echoes of a third each, or one where the bins do not tell them apart") {
  const Scene scene = traced(SideWorld());
  ScanningRadarSpec spec = with_sides("sum");
  const Scan apart = measured(spec, scene);
  REQUIRE(apart.echoes.size() == 3);
  CHECK(apart.echoes[1].range == doctest::Approx(8.0).epsilon(1e-12));
  CHECK(std::pow(apart.echoes[1].amplitude, 2) == doctest::Approx(1.0 / 3.0).epsilon(1e-5));
  CHECK(std::ranges::is_sorted(apart.echoes, {}, &Echo::range));
  spec.bin_size_m = 5.0;
  const Scan together = measured(spec, scene);
  REQUIRE(together.echoes.size() == 1);
  double power = 0.0, range = 0.0;
  for (const Echo& e : apart.echoes) {
    power += std::pow(e.amplitude, 2);
    range += std::pow(e.amplitude, 2) * e.range;
  }
  CHECK(std::pow(together.echoes[0].amplitude, 2) == doctest::Approx(power).epsilon(1e-5));
  CHECK(together.echoes[0].range == doctest::Approx(range / power).epsilon(1e-6));
}

TEST_CASE("a cone sees a post beside its axis, with the share of the cone that the post fills") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{0.2, 0.2, 10.0}}, {5.1, 0.12, 0.0});  // from 0.02 to 0.22 m to the left
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  CHECK(measured(spec, scene).echoes.empty());
  spec.divergence = "cone";
  spec.cone_opening_deg = 4.0;  // radius 0.1746 m at 5 m
  spec.cone_rays = 4000;
  const Scan scan = measured(spec, scene);
  REQUIRE(scan.echoes.size() >= 1);  // (after that of its front, those of its side, which is seen obliquely)
  CHECK(scan.echoes[0].range == doctest::Approx(5.0).epsilon(1e-3));
  // Of a disc of radius R the part beyond a chord at x: (acos(x / R) - x / R sqrt(1 - x^2 / R^2)) / pi.
  const double x = 0.02 / (5.0 * std::tan(radians(2.0)));
  CHECK(std::pow(scan.echoes[0].amplitude, 2) == doctest::Approx((std::acos(x) - x * std::sqrt(1.0 - x * x)) / pi).epsilon(0.01));
  CHECK(scan.azimuth_opening == 0.0);  // as traced an echo is where the beam looks
}

TEST_CASE("rows over an elevation opening see what the plane misses, at its slant range and with its share") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{1.0, 50.0, 1.0}}, {5.5, 0.0, -1.0});  // from 1.5 to 0.5 m under the plane
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.step_deg = 1.0;
  spec.fov_deg = 0.5;
  CHECK(measured(spec, scene).echoes.empty());
  spec.elevation_opening_deg = 20.0;
  spec.elevation_rays = 401;
  spec.bin_size_m = 1.0;
  const Scan scan = measured(spec, scene);
  REQUIRE(scan.echoes.size() >= 1);
  double power = 0.0;
  for (const Echo& e : scan.echoes) power += std::pow(e.amplitude, 2);
  // Its front from elevation -10 (the opening's end) to atan(-0.1): cos(incidence) = cos(el), weighted by cos(el), over 2 sin(10 deg). (What the top returns to
  // a plane above it comes on top: rays that pass over the front edge.)
  const double low = -radians(10.0), high = -std::atan(0.1);
  const auto cos_squared = [](double a) { return 0.5 * a + 0.25 * std::sin(2.0 * a); };
  const double front = (cos_squared(high) - cos_squared(low)) / (2.0 * std::sin(radians(10.0)));
  const double from = std::atan(0.5 / 6.0);  // the top, 0.5 m under the plane, from 5 to 6 m: cos(incidence) = sin(el)
  const double top = 0.5 * (std::pow(std::sin(std::atan(0.1)), 2) - std::pow(std::sin(from), 2)) / (2.0 * std::sin(radians(10.0)));
  CHECK(power == doctest::Approx(front + top).epsilon(0.01));
}

TEST_CASE("a mount that is pitched and rolled looks where it points") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{100.0, 100.0, 1.0}}, {0.0, 0.0, -2.5});  // a floor 2 m under the vehicle's origin
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.position_m = {0.0, 0.0, 0.5};
  spec.pitch_deg = 30.0;  // nose down
  const OneBeam down = looked(spec, scene);
  REQUIRE(down.echoes.size() == 1);
  CHECK(down.echoes[0].range == doctest::Approx(2.5 / std::sin(radians(30.0))).epsilon(1e-12));
  // Rolled by 90 degrees the scanner's plane stands upright: beams to its left, which is now down... right side down, so the left is up.
  spec.pitch_deg = 0.0;
  spec.roll_deg = 90.0;
  spec.fov_deg = 360.0;
  spec.step_deg = 90.0;
  const Scan scan = measured(spec, scene);
  REQUIRE(scan.beams.size() == 4);
  for (const Beam& beam : scan.beams) {
    const bool right = std::abs(beam.azimuth + pi / 2) < 1e-9;
    CHECK(beam.echo_count == (right ? 1 : 0));
    if (right) CHECK(scan.echoes[beam.first_echo].range == doctest::Approx(2.5).epsilon(1e-9));
  }
}

TEST_CASE("jittered rays are unit vectors in their own cells, others in each scan") {
  LobeRadarSpec spec = bare_lobe(65.0, 10);
  spec.echoes = "traced";
  const Scene nothing = traced(World{});
  const Scan regular = measured(spec, nothing);
  spec.sampling = "jitter";
  const Scan first = measured(spec, nothing, Pose::planar(3.0, 4.0, 5.0, 1.0), 0), second = measured(spec, nothing, Pose::planar(3.0, 4.0, 5.0, 1.0), 1);
  REQUIRE(first.beams.size() == 100);
  const double cell = radians(6.5);
  int moved = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    CHECK(std::abs(glm::length(first.beams[i].direction) - 1.0) < 1e-14);
    CHECK(std::abs(first.beams[i].azimuth - regular.beams[i].azimuth) <= 0.5 * cell + 1e-12);
    CHECK(std::abs(first.beams[i].elevation - regular.beams[i].elevation) <= 0.5 * cell + 1e-12);
    moved += std::abs(first.beams[i].azimuth - second.beams[i].azimuth) > 1e-6;
  }
  CHECK(moved > 95);
  CHECK(measured(spec, nothing, Pose::planar(3.0, 4.0, 5.0, 1.0), 1).beams[7].azimuth == second.beams[7].azimuth);
}

TEST_CASE("a lobe by its receiver is one beam with an opening, traced it is its rays") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{1.0, 1.0, 1.0}}, {5.5, 0.0, 0.0});
  const Scene scene = traced(w);
  LobeRadarSpec spec = bare_lobe();
  spec.bandwidth_ghz = 1.5;
  spec.bin_size_m = 0.01;
  spec.threshold = 0.01;
  const Scan received = measured(spec, scene);
  REQUIRE(received.beams.size() == 1);
  CHECK(received.azimuth_opening == doctest::Approx(radians(65.0)));
  CHECK(received.profiles.bins == received.profiles.amplitude.size());
  REQUIRE(received.echoes.size() == 1);
  CHECK(received.echoes[0].range > 4.995);  // its corners are at 5.05 m
  CHECK(received.echoes[0].range < 5.035);
  CHECK(received.beams[0].end == BeamEnd::stopped);
  CHECK(received.beams[0].sensed_range == received.echoes[0].range);
  spec.echoes = "traced";
  const Scan rays = measured(spec, scene);
  CHECK(rays.beams.size() == 58 * 58);
  CHECK(rays.azimuth_opening == 0.0);
  CHECK(rays.profiles.bins == 0);
  CHECK(std::ranges::count_if(rays.beams, [](const Beam& b) { return b.echo_count > 0; }) == static_cast<long>(rays.echoes.size()));
  const auto nearest = std::ranges::min_element(rays.echoes, {}, &Echo::range);
  CHECK(nearest->range == doctest::Approx(5.0).epsilon(1e-3));
}

TEST_CASE("an elliptic lobe leaves out the corners of a square one") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{1.0, 100.0, 100.0}}, {4.5, 0.0, 0.0});
  const Scene scene = traced(w);
  LobeRadarSpec spec = bare_lobe(60.0, 40);
  spec.echoes = "traced";
  spec.section = "elliptic";
  const Scan scan = measured(spec, scene);
  CHECK(scan.beams.size() == doctest::Approx(0.25 * pi * 1600).epsilon(0.01));
  for (const Beam& beam : scan.beams) CHECK(std::hypot(beam.azimuth, beam.elevation) <= radians(30.0) + 1e-9);
  // A wall that fills it returns as much as one that fills the square: each against a reflector that fills it squarely.
  spec.echoes = "receiver";
  LobeRadarSpec square = spec;
  square.section = "square";
  spec.range_compensation = square.range_compensation = true;
  CHECK(received_power(spec, scene) > received_power(square, scene));  // less of it is oblique
  CHECK(received_power(spec, scene) < 1.0);
}

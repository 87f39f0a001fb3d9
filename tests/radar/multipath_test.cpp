// Mirrors and corners: ghosts at their ranges, two and three bounces, and what motion does to them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "lobe.hpp"

using namespace thicket;

namespace {

ScanningRadarSpec bouncing(int bounces) {
  ScanningRadarSpec spec = one_beam_radar();
  spec.scattering = "material";
  spec.step_deg = 1.0;
  spec.fov_deg = 0.5;
  spec.bounces_max = bounces;
  spec.detection_floor_db = -150.0;
  return spec;
}

/// A mirror at x = 4 whose normal is turned 45 degrees from the beam towards +y, and a rough wall 3 m along what it mirrors.
struct MirrorWorld : HandMadeWorld {
  MirrorWorld() {
    const auto glass = mirror(*this), rough = rough_metal(*this);
    Solid tilted{"mirror", glass, {4.0, 0.0, 0.0}, -pi / 4, Box{{0.02, 2.0, 2.0}}};
    tilted.position += 0.01 * glm::dvec3(std::cos(-pi / 4), std::sin(-pi / 4), 0.0);  // its face, turned to -x +y, passes through (4, 0)
    world.solids.push_back(tilted);
    add(Box{{4.0, 1.0, 4.0}}, {4.0, 3.5, 0.0}, 0.0, rough);
  }
};

std::vector<Echo> with_bounces(const OneBeam& beam, int bounces) {
  std::vector<Echo> list;
  std::ranges::copy_if(beam.echoes, std::back_inserter(list), [=](const Echo& e) { return e.bounces == bounces; });
  return list;
}

/// Two mirrors of 2 x 2 m that meet at right angles at x = 5, opening towards the sensor; `third`: a floor closes them to a trihedral.
World corner(bool third) {
  HandMadeWorld w;
  const auto glass = mirror(w);
  for (const double side : {1.0, -1.0}) {
    const double yaw = side * pi / 4;
    const glm::dvec3 along(-std::cos(yaw), side * std::sin(pi / 4), 0.0), off(std::sin(pi / 4), side * std::cos(pi / 4), 0.0);
    w.add(Box{{2.0, 0.02, 2.0}}, glm::dvec3(5.0, 0.0, 1.0) + along + 0.01 * off, -yaw, glass);
  }
  if (third) w.add(Box{{8.0, 8.0, 0.02}}, {5.0, 0.0, -0.01}, 0.0, glass);
  return w.world;
}

}  // namespace

TEST_CASE("a mirror shows what it mirrors at the mirror's range") {
  const Scene scene = traced(MirrorWorld());
  const OneBeam one = looked(bouncing(1), scene);
  CHECK(one.echoes.empty());  // the mirror itself sends nothing back
  CHECK(one.beam.sensed_range == doctest::Approx(4.0).epsilon(1e-9));

  const OneBeam two = looked(bouncing(2), scene);
  const auto ghosts = with_bounces(two, 2);
  REQUIRE(ghosts.size() == 1);
  CHECK(std::abs(ghosts[0].range - 7.0) < 1e-3);  // there and back by the mirror, 4 + 3 m
  CHECK(std::abs(ghosts[0].amplitude - 1.0) < 1e-5);  // a rough wall squarely, by a perfect mirror
}

namespace {

/// The echoes of the middle ray of a wide lobe.
std::vector<Echo> middle_of_lobe(const Scene& scene, double opening_deg) {
  LobeRadarSpec spec = bare_lobe(opening_deg, 3, 20.0);
  spec.echoes = "traced";
  spec.bounces_max = 2;
  const Scan scan = measured(spec, scene);
  const auto echoes = scan.echoes_of(scan.beams[4]);
  CHECK(std::ranges::is_sorted(echoes, {}, &Echo::range));
  return {echoes.begin(), echoes.end()};
}
bool near(const Echo& e, double range) { return std::abs(e.range - range) < 1e-3; }

}  // namespace

TEST_CASE("a straight way back from behind a mirror takes an antenna that looks there") {
  // The wall of the ghost is 37 degrees off the beam: a narrow lobe does not hear it directly, a wide one does; the mirrored way back both hear.
  const Scene scene = traced(MirrorWorld());
  for (const double opening : {10.0, 90.0}) {
    const auto echoes = middle_of_lobe(scene, opening);
    CHECK(std::ranges::count_if(echoes, [](const Echo& e) { return near(e, 7.0); }) == 1);
    // There by the mirror, straight back from (4, 3): (4 + 3 + 5) / 2. The wall sends 2 x 1 cos(53 deg), for the other way round comes too, over 5 m of way back.
    const auto straight = std::ranges::find_if(echoes, [](const Echo& e) { return near(e, 6.0); });
    REQUIRE((straight != echoes.end()) == (opening == 90.0));
    if (opening == 90.0) CHECK(std::pow(straight->amplitude, 2) == doctest::Approx(2.0 * 0.6 * std::pow(20.0 / 5.0, 2)).epsilon(1e-5));
  }
}

TEST_CASE("a dihedral answers with two bounces, a trihedral with three, from the range of its corner") {
  for (const int faces : {2, 3}) {
    CAPTURE(faces);
    const Scene scene = traced(corner(faces == 3));
    // Towards a point a few millimetres off the corner, from anywhere in front of it.
    Dice dice(31);
    for (int i = 0; i < 50; ++i) {
      const double height = faces == 3 ? dice.between(1.0, 3.0) : 1.0, side = dice.between(-1.5, 1.5);
      const glm::dvec3 from(0.0, side, height), corner_point(5.0, 0.0, faces == 3 ? 0.0 : 1.0);
      const glm::dvec3 aim = corner_point + glm::dvec3(0.0, 0.002, faces == 3 ? 0.003 : 0.0) - from;
      const double yaw = std::atan2(aim.y, aim.x), pitch = -std::asin(aim.z / glm::length(aim));
      const Pose pose{from, Pose::planar(0, 0, 0, yaw).orientation * glm::dquat(std::cos(0.5 * pitch), 0.0, std::sin(0.5 * pitch), 0.0)};
      ScanningRadarSpec spec = bouncing(5);
      const OneBeam beam = looked(spec, scene, pose);
      const auto strongest = std::ranges::max_element(beam.echoes, {}, &Echo::amplitude);
      REQUIRE(strongest != beam.echoes.end());
      CHECK(static_cast<int>(strongest->bounces) == faces);
      CHECK(std::abs(strongest->range - glm::distance(from, corner_point)) < 1e-3);
      CHECK(std::ranges::none_of(beam.echoes, [&](const Echo& e) { return e.bounces > faces; }));  // then the wave is gone
    }
  }
}

TEST_CASE("a lobe before a corner sees it where it is, brighter than what its faces send back by themselves") {
  LobeRadarSpec spec = bare_lobe(40.0, 58, 10.0);
  spec.bandwidth_ghz = 1.5;
  spec.bin_size_m = 0.02;
  const Scene scene = traced(corner(false));
  const auto top = [&](int bounces) {
    spec.bounces_max = bounces;
    const Scan scan = measured(spec, scene, Pose::planar(0.0, 0.0, 1.0, 0.0));
    const auto profile = scan.profiles.amplitude_of(0);
    const auto at = std::ranges::max_element(profile);
    return std::pair(scan.profiles.range(static_cast<std::uint32_t>(at - profile.begin())), static_cast<double>(*at));
  };
  const auto [range, amplitude] = top(2);
  CHECK(std::abs(range - 5.0) <= 0.02);
  CHECK(amplitude > 10.0 * top(1).second);
}

TEST_CASE("a wall hides what lies behind it from a wave that bounces, matter weakens it") {
  MirrorWorld open;
  MirrorWorld closed = open;
  closed.add(Box{{0.5, 0.5, 2.0}}, {2.0, 1.5, 0.0}, 0.0, 1);  // on the straight way from the ghost's wall to the sensor
  const auto straight = [](const HandMadeWorld& w) {
    double amplitude = 0.0;
    for (const Echo& e : middle_of_lobe(traced(w), 90.0))
      if (near(e, 6.0)) amplitude = e.amplitude;
    return amplitude;
  };
  CHECK(straight(open) > 0.0);
  CHECK(straight(closed) == 0.0);
  MirrorWorld hazy = open;
  const auto haze = hazy.material("haze", 0.0, 2.0);
  hazy.add(Box{{0.5, 0.5, 2.0}}, {2.0, 1.5, 0.0}, 0.0, haze);
  // The way back, along (-4, -3) / 5, is 0.625 m inside the box: 1.25 dB, one way.
  CHECK(20.0 * std::log10(straight(open) / straight(hazy)) == doctest::Approx(1.25).epsilon(1e-4));
}

TEST_CASE("bounces are found alike at 1e6 m") {
  const double far = 1048576.0;
  MirrorWorld here, there;
  for (Solid& solid : there.world.solids) solid.position += glm::dvec3(far, -far, 0.0);
  const OneBeam a = looked(bouncing(3), traced(here)), b = looked(bouncing(3), traced(there), Pose::planar(far, -far, 0.0, 0.0));
  REQUIRE(a.echoes.size() == b.echoes.size());
  for (std::size_t i = 0; i < a.echoes.size(); ++i) {
    CHECK(std::abs(a.echoes[i].range - b.echoes[i].range) < 3e-5);
    CHECK(a.echoes[i].bounces == b.echoes[i].bounces);
  }
}

TEST_CASE("multipath that is left out costs nothing, that is there ends below the floor") {
  const Scene scene = traced(MirrorWorld());
  CHECK(measured(bouncing(1), scene).rays == 1);
  ScanningRadarSpec deaf = bouncing(16);
  // Two mirrors face to face would bounce for ever: it ends by the range.
  HandMadeWorld hall;
  const auto glass = mirror(hall);
  hall.add(Box{{1.0, 50.0, 50.0}}, {5.5, 0.0, 0.0}, 0.0, glass);
  hall.add(Box{{1.0, 50.0, 50.0}}, {-5.5, 0.0, 0.0}, 0.0, glass);
  deaf.range_max_m = 48.0;
  const Scan scan = measured(deaf, traced(hall));
  CHECK(std::ranges::all_of(scan.echoes, [](const Echo& e) { return e.range <= 48.0; }));
  CHECK(std::ranges::any_of(scan.echoes, [](const Echo& e) { return std::abs(e.range - 45.0) < 1e-6 && e.bounces == 5; }));
  CHECK(std::ranges::none_of(scan.echoes, [](const Echo& e) { return e.bounces > 5; }));
}

TEST_CASE("between panes a ray splits into a thousand ways at most, those of the fewest bounces") {
  HandMadeWorld w;
  const auto presets = material_presets();
  REQUIRE(presets);
  w.world.materials = *presets;
  const auto glass = static_cast<std::uint32_t>(std::ranges::find(*presets, "glass", &Material::name) - presets->begin());
  for (int i = 0; i < 10; ++i) w.add(Box{{0.006, 50.0, 50.0}}, {1.0 + 0.5 * i, 0.0, 0.0}, 0.0, glass);
  const Scene scene = traced(w);
  ScanningRadarSpec spec = bouncing(3);
  spec.slab_max_m = 0.1;
  const Scan few = measured(spec, scene);
  CHECK(few.rays > 100);
  CHECK(few.rays < 1000);
  spec.bounces_max = 16;  // some 10^9 ways
  const Scan many = measured(spec, scene);
  CHECK(many.rays > 1000);
  CHECK(many.rays <= 1 + 1000 + 1000 * 10);  // the ray, its ways, and what each of them sees of ten panes
  const auto up_to_3 = [](const Scan& scan) { return std::ranges::count_if(scan.echoes, [](const Echo& e) { return e.bounces <= 3; }); };
  CHECK(up_to_3(many) == up_to_3(few));
}

TEST_CASE("a corner of mirrors returns what its image does") {
  // The image of a sensor in two mirrors at right angles is behind their edge, as far as the sensor before it: as a mirror at the edge would, pi R^2 in all.
  for (const auto& [height, away] : {std::pair{2.0, 3.0}, {1.0, 2.0}, {1.5, 1.0}}) {
    CAPTURE(height);
    HandMadeWorld w;
    const auto glass = mirror(w);
    w.add(Box{{100.0, 100.0, 1.0}}, {0.0, 0.0, -height - 0.5}, 0.0, glass);
    w.add(Box{{1.0, 100.0, 100.0}}, {away + 0.5, 0.0, 0.0}, 0.0, glass);
    const Scene scene = traced(w);
    const double pitch = std::atan2(height, away), edge = std::hypot(height, away);
    const Pose towards_edge{{0.0, 0.0, 0.0}, glm::dquat(std::cos(0.5 * pitch), 0.0, std::sin(0.5 * pitch), 0.0)};
    LobeRadarSpec spec = bare_lobe(40.0, 58);
    spec.bounces_max = 2;
    const auto of_corner = [&](const Scan& scan) {
      // What the two mirrors return by themselves, one bounce, is not in a lobe of 40 degrees; what is at the edge's range is the corner.
      double sum = 0.0;
      const auto profile = scan.profiles.amplitude_of(0);
      for (std::uint32_t bin = 0; bin < profile.size(); ++bin)
        if (std::abs(scan.profiles.range(bin) - edge) < 0.3) sum += static_cast<double>(profile[bin]) * static_cast<double>(profile[bin]);
      return sum;
    };
    const double expected = power_of(pi * edge * edge, edge, spec);
    for (const int rays : {50, 58, 64}) {  // (even: the middle row of an odd grid would meet the very edge)
      CAPTURE(rays);
      spec.azimuth_rays = spec.elevation_rays = rays;
      CHECK(std::abs(10.0 * std::log10(of_corner(measured(spec, scene, towards_edge)) / expected)) < 0.5);
    }
    spec.sampling = "jitter";
    const auto sensor = make_sensor(spec, 0);
    Scan scan;
    const Estimate mean = estimate(40, [&](std::uint64_t number) {
      sensor->measure(scene, towards_edge, 0.0, number, Random(1, 0), scan);
      return of_corner(scan);
    });
    CHECK(std::abs(10.0 * std::log10(mean.mean / expected)) < 0.5);
  }
}

TEST_CASE("on the way back the penetration budget counts too, and what is opaque behind it still stops the wave") {
  MirrorWorld world;
  const auto fog = world.material("fog", 0.0, 20.0);
  world.add(Box{{0.6, 0.6, 2.0}}, {2.4, 1.8, 0.0}, std::atan2(3.0, 4.0), fog);   // 0.6 m, 12 dB, on the straight way back
  HandMadeWorld and_metal = world;
  and_metal.add(Box{{0.3, 0.3, 2.0}}, {0.8, 0.6, 0.0}, 0.0, 1);
  const auto straight = [](const HandMadeWorld& w, double budget) {
    LobeRadarSpec spec = bare_lobe(90.0, 3, 20.0);
    spec.echoes = "traced";
    spec.bounces_max = 2;
    spec.penetration_budget_db = budget;
    const Scan scan = measured(spec, traced(w));
    double amplitude = 0.0;
    for (const Echo& e : scan.echoes_of(scan.beams[4]))
      if (near(e, 6.0)) amplitude = e.amplitude;
    return amplitude;
  };
  CHECK(straight(world, 20.0) > 0.0);
  CHECK(straight(world, 10.0) == 0.0);
  CHECK(straight(and_metal, 20.0) == 0.0);
  CHECK(straight(and_metal, 10.0) == 0.0);
}

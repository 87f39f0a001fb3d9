// The parts of the radar model that a mission may leave out: slower waves, random leaves, motion, sampling, the printed law.
#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "lobe.hpp"

using namespace thicket;

TEST_CASE("what lies behind a dielectric seems farther by (n - 1) times its thickness") {
  HandMadeWorld w;
  rough_metal(w);
  Material glass;
  glass.name = "glass";
  glass.dielectric = Dielectric{4.0, 0.0, 0.0, 0.0};  // index 2
  w.world.materials.push_back(glass);
  w.add(Box{{1.0, 50.0, 50.0}}, {8.0, 0.0, 0.0});
  w.add(Box{{0.3, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
  for (const double slab_max : {0.0, 1.0}) {
    ScanningRadarSpec spec = one_beam_radar();
    spec.slab_max_m = slab_max;
    const OneBeam plain = looked(spec, traced(w));
    spec.excess_range = true;
    const OneBeam slow = looked(spec, traced(w));
    REQUIRE(slow.echoes.size() == plain.echoes.size());
    CHECK(slow.echoes.front().range == doctest::Approx(3.85).epsilon(1e-12));
    CHECK(slow.echoes.back().range == doctest::Approx(7.5 + 0.3).epsilon(1e-12));
    CHECK(plain.echoes.back().range == doctest::Approx(7.5).epsilon(1e-12));
    if (slab_max == 0.0) CHECK(slow.echoes[1].range == doctest::Approx(4.15 + 0.3).epsilon(1e-12));
  }
}

TEST_CASE("leaves at random places: on average as many and as dense as even matter") {
  const double per_m = 3.0, db_per_m = 2.0, depth = 2.0;
  HandMadeWorld w;
  rough_metal(w);
  Material crown;
  crown.name = "crown";
  crown.reflectivity = 0.01;
  crown.attenuation_db_per_m = db_per_m;
  crown.leaves_per_m = per_m;
  w.world.materials.push_back(crown);
  w.add(Box{{1.0, 50.0, 50.0}}, {8.5, 0.0, 0.0});
  w.add(Box{{depth, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.statistical_foliage = true;
  const auto sensor = make_sensor(spec, 0);
  Scan scan;
  const int scans = 40000;
  double leaves = 0.0, one_way = 0.0, squares = 0.0, first = 0.0, with_leaves = 0.0, inside = 0.0;
  for (int i = 0; i < scans; ++i) {
    sensor->measure(scene, Pose{}, 0.0, static_cast<std::uint64_t>(i), Random(1, 0), scan);
    REQUIRE(scan.echoes.size() >= 1);
    const Echo& wall = scan.echoes.back();
    CHECK(wall.range == doctest::Approx(8.0).epsilon(1e-12));
    CHECK(wall.edge == Edge::front);
    leaves += static_cast<double>(scan.echoes.size() - 1);
    one_way += wall.amplitude;  // the root of what passes twice
    squares += std::pow(wall.amplitude, 2);
    if (scan.echoes.size() > 1) {
      with_leaves += 1.0;
      first += scan.echoes[0].range - 3.0;
      CHECK(scan.echoes[0].edge == Edge::thin);
      inside += scan.echoes[0].range >= 3.0 && scan.echoes[0].range <= 5.0;
      CHECK(std::pow(scan.echoes[0].amplitude, 2) <= 0.01 * (1.0 + 1e-6));
    }
  }
  const double mean_leaves = leaves / scans;
  CHECK(std::abs(mean_leaves - per_m * depth) < 3.0 * std::sqrt(per_m * depth / scans));
  const double mean = one_way / scans, error = std::sqrt((squares / scans - mean * mean) / scans);
  CHECK(std::abs(mean - std::pow(10.0, -0.1 * db_per_m * depth)) < 3.0 * error);
  CHECK(inside == with_leaves);
  // The free path is exponential, cut off at the far side.
  const double cut = per_m * depth, expected = 1.0 / per_m - depth * std::exp(-cut) / (1.0 - std::exp(-cut));
  CHECK(first / with_leaves == doctest::Approx(expected).epsilon(0.02));
  // Left out, the crown is even matter with a front and a back.
  spec.statistical_foliage = false;
  CHECK(looked(spec, scene).echoes.size() == 3);
}

TEST_CASE("dense leaves that take more than all stop the ray") {
  HandMadeWorld w;
  Material crown;
  crown.reflectivity = 0.1;
  crown.attenuation_db_per_m = 50.0;
  crown.leaves_per_m = 2.0;
  w.world.materials.push_back(crown);
  w.add(Box{{4.0, 50.0, 50.0}}, {4.0, 0.0, 0.0});
  ScanningRadarSpec spec = one_beam_radar();
  spec.statistical_foliage = true;
  const OneBeam beam = looked(spec, traced(w));
  CHECK(beam.echoes.size() == 1);
  CHECK(beam.beam.end == BeamEnd::stopped);
  CHECK(beam.beam.sensed_range == beam.echoes[0].range);
}

TEST_CASE("echoes tell how fast their range changes") {
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{1.0, 50.0, 50.0}}, {10.5, 0.0, 0.0});
  Motion motion;
  motion.points = {{5.0, 3.0, 0.0}, {5.0, 13.0, 0.0}};
  motion.speed = 2.0;
  motion.spin = 0.5;
  const auto ball = w.add(Sphere{0.5}, {5.0, 3.0, 0.0});
  w.world.solids[ball].motion = std::make_shared<const Motion>(motion);
  Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.radial_velocity = true;
  const auto velocity = [&](const Platform& platform, double yaw) {
    Scan scan;
    Platform turned = platform;
    turned.pose = Pose::planar(0.0, 0.0, 0.0, yaw);
    scene.set_time(1.0);
    make_sensor(spec, 0)->measure(scene, turned, 1.0, 0, Random(1, 0), scan);
    REQUIRE(scan.echoes.size() == 1);
    return static_cast<double>(scan.echoes[0].radial_velocity);
  };
  // Towards a wall at 1.5 m/s, at 30 degrees to it: by the cosine along the beam.
  CHECK(velocity({{}, {1.5, 0.0, 0.0}, {}}, 0.0) == doctest::Approx(-1.5).epsilon(1e-6));
  CHECK(velocity({{}, {0.0, 4.0, 0.0}, {}}, 0.0) == doctest::Approx(0.0).scale(1.0));
  CHECK(velocity({{}, {1.5, 0.0, 0.0}, {}}, radians(30.0)) == doctest::Approx(-1.5 * std::cos(radians(30.0))).epsilon(1e-6));
  // At time 1 the ball is at (5, 5) and goes along +y: at 45 degrees its range grows by 2 sin 45. Its spin does not show in its middle.
  CHECK(velocity({}, radians(45.0)) == doctest::Approx(2.0 * std::sin(radians(45.0))).epsilon(1e-6));
  // A sensor 1 m ahead of the middle of a turning vehicle moves sideways.
  spec.position_m = {1.0, 0.0, 0.0};
  spec.yaw_deg = 90.0;
  HandMadeWorld side;
  rough_metal(side);
  side.add(Box{{50.0, 1.0, 50.0}}, {0.0, 10.5, 0.0});
  scene = traced(side);
  CHECK(velocity({{}, {}, {0.0, 0.0, 0.3}}, 0.0) == doctest::Approx(-0.3).epsilon(1e-6));
  // Left out, it is not told.
  spec.radial_velocity = false;
  CHECK(velocity({{}, {}, {0.0, 0.0, 0.3}}, 0.0) == 0.0);
}

TEST_CASE("the velocity of a ghost is the rate of its whole way") {
  // A mirror at x = 4 turned by 45 degrees; a rough wall at y = 3 beyond it. The rate is measured against two scans a moment apart.
  HandMadeWorld w;
  const auto glass = mirror(w), rough = rough_metal(w);
  Solid tilted{"mirror", glass, {4.0, 0.0, 0.0}, -pi / 4, Box{{0.02, 2.0, 2.0}}};
  tilted.position += 0.01 * glm::dvec3(std::cos(-pi / 4), std::sin(-pi / 4), 0.0);
  Motion motion;
  motion.points = {tilted.position, tilted.position + glm::dvec3(1.0, 0.5, 0.0)};
  motion.speed = 0.7;
  tilted.motion = std::make_shared<const Motion>(motion);
  w.world.solids.push_back(tilted);
  w.add(Box{{8.0, 1.0, 4.0}}, {4.0, 3.5, 0.0}, 0.0, rough);
  Scene scene = traced(w);
  LobeRadarSpec spec = bare_lobe(90.0, 3, 20.0);
  spec.echoes = "traced";
  spec.bounces_max = 2;
  spec.radial_velocity = true;
  const glm::dvec3 velocity(0.4, -0.3, 0.0);
  const auto look = [&](double time) {
    Scan scan;
    scene.set_time(time);
    make_sensor(spec, 0)->measure(scene, Platform({velocity * time, glm::dquat(1, 0, 0, 0)}, velocity, {}), time, 0, Random(1, 0), scan);
    const auto echoes = scan.echoes_of(scan.beams[4]);
    return std::vector<Echo>(echoes.begin(), echoes.end());
  };
  const double moment = 1e-4;
  const auto before = look(0.5 - moment), now = look(0.5), after = look(0.5 + moment);
  for (const auto* echoes : {&before, &now, &after}) {
    REQUIRE(echoes->size() >= 2);
    CHECK(echoes->back().bounces == 2);
  }
  // (The straight way back comes from where the ray happens to meet the wall, whose motion along the wall is no Doppler: it is not looked at here.)
  CHECK(static_cast<double>(now.back().radial_velocity) == doctest::Approx((after.back().range - before.back().range) / (2.0 * moment)).epsilon(1e-4));
}

TEST_CASE("eq. 4.2 as printed: a full lobe of metal at the end of the range is 1 in all, and an isolated target is as strong at any range") {
  LobeRadarSpec spec = bare_lobe(65.0, 58, 10.0);
  spec.law = "printed";
  spec.range_max_m = 12.0;  // so that the corners of the plate are inside it; I_m goes with range_max
  HandMadeWorld w;
  rough_metal(w);
  w.add(Box{{1.0, 100.0, 100.0}}, {6.5, 0.0, 0.0});
  const auto sum_of = [&](const Scene& scene, const Pose& pose = {}) {
    const Scan scan = measured(spec, scene, pose);
    double sum = 0.0;
    for (const float a : scan.profiles.amplitude_of(0)) sum += static_cast<double>(a);
    return sum;
  };
  // At half the range a quarter: every ray has (r / R_max)^2.
  CHECK(sum_of(traced(w)) == doctest::Approx(0.25).epsilon(1e-4));
  HandMadeWorld ball;
  rough_metal(ball);
  ball.add(Sphere{1.0}, {0.0, 0.0, 0.0});
  const Scene alone = traced(ball);
  CHECK(sum_of(alone, Pose::planar(-5.0, 0.0, 0.0, 0.0)) == doctest::Approx(sum_of(alone, Pose::planar(-10.0, 0.0, 0.0, 0.0))).epsilon(0.1));
}

TEST_CASE("nothing returns more than was sent: random worlds") {
  CHECK(rc::check("lobes", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    HandMadeWorld w;
    for (int m = 0; m < 4; ++m) {
      const auto index = w.material("m", dice.between(0.0, 1.0), dice.chance(0.5) ? infinity : dice.between(0.0, 30.0));
      w.world.materials[index].roughness = dice.between(0.0, 1.0);
    }
    for (int i = 0; i < 12; ++i) {
      const glm::dvec3 at = dice.between(1.0, 8.0) * dice.direction();
      if (dice.chance(0.5)) w.add(Sphere{dice.between(0.1, 0.6)}, at, 0.0, dice.pick(4));
      else w.add(Box{dice.point(glm::dvec3(0.01), glm::dvec3(0.8))}, at, dice.between(-pi, pi), dice.pick(4));
    }
    LobeRadarSpec spec = bare_lobe(dice.between(10.0, 120.0), 20, 10.0);
    spec.elevation_opening_deg = dice.between(10.0, 100.0);
    spec.bounces_max = 1 + dice.pick(4);
    spec.sampling = dice.chance(0.5) ? "jitter" : "regular";
    const Scan scan = measured(spec, traced(w), Pose{}, dice.pick(1000), 3);
    // Against what is sent: a perfect diffuse reflector that fills the lobe at range_max returns lambda^2 4 Omega_2 G^2 / ((4 pi)^3 R^2) of it, G = 4 pi / Omega for a flat lobe without loss.
    const double omega = solid_angle(spec.azimuth_opening_deg, spec.elevation_opening_deg), lambda = 0.299792458 / spec.frequency_ghz;
    const double unit = lambda * lambda * 4.0 / (4.0 * pi * omega * std::pow(spec.range_max_m, 2));
    RC_ASSERT(received_power(scan) * unit <= 1.0);
    for (const float a : scan.profiles.amplitude_of(0)) RC_ASSERT(std::isfinite(a) && a >= 0.0f);
    // Along one ray, compensated and diffuse, no more comes back than went out.
    spec.echoes = "traced";
    spec.scattering = "lambert";
    spec.range_compensation = true;
    spec.bounces_max = 1;
    const Scan rays = measured(spec, traced(w), Pose{}, 0, 3);
    for (const Beam& beam : rays.beams) {
      double sum = 0.0;
      for (const Echo& e : rays.echoes_of(beam)) sum += static_cast<double>(e.amplitude) * static_cast<double>(e.amplitude);
      RC_ASSERT(sum <= 1.0 + 1e-6);
    }
  }));
}

TEST_CASE("the way there is the way back: two radars at the ends of a row of walls") {
  CHECK(rc::check("reciprocal", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    HandMadeWorld w;
    rough_metal(w);
    w.add(Box{{0.2, 9.0, 9.0}}, {0.0, 0.0, 0.0});
    w.add(Box{{0.2, 9.0, 9.0}}, {20.0, 0.0, 0.0});
    for (int i = 0; i < 4; ++i) {
      Material material;
      material.dielectric = Dielectric{dice.between(1.0, 8.0), 0.0, dice.between(0.0, 0.02), 0.0};
      material.roughness = dice.between(0.0, 1.0);
      const Material there = at_frequency(material, 24.0);
      material.reflectivity = there.reflectivity;
      material.attenuation_db_per_m = there.attenuation_db_per_m;
      w.world.materials.push_back(material);
      Solid wall{"wall", static_cast<std::uint32_t>(i + 1), {dice.between(3.0, 17.0), 0.0, 0.0}, dice.between(-1.0, 1.0), Box{{dice.between(0.01, 0.5), 60.0, 60.0}}};
      w.world.solids.push_back(wall);
    }
    ScanningRadarSpec spec = one_beam_radar();
    spec.scattering = "material";
    spec.fresnel = true;
    spec.slab_max_m = 0.2;
    // From 1 m off the left plate to the right one, and from 1 m off the right one to the left; without what is between they would be alike.
    const Scene scene = traced(w);
    const OneBeam there = looked(spec, scene, Pose::planar(1.0, 0.0, 0.0, 0.0)), back = looked(spec, scene, Pose::planar(19.0, 0.0, 0.0, pi));
    RC_ASSERT(!there.echoes.empty() && !back.echoes.empty());
    RC_ASSERT(std::abs(there.echoes.back().range - back.echoes.back().range) < 1e-9);
    RC_ASSERT(std::abs(there.power(there.echoes.size() - 1) / back.power(back.echoes.size() - 1) - 1.0) < 1e-5);
  }));
}

TEST_CASE("the number of threads does not change one bit of a lobe") {
  HandMadeWorld w;
  const auto metal = mirror(w, 0.2), crown = w.material("crown", 0.05, 4.0), rough = rough_metal(w);
  w.world.materials[crown].leaves_per_m = 2.0;
  Dice dice(9);
  for (int i = 0; i < 60; ++i) w.add(Sphere{dice.between(0.1, 0.7)}, {dice.between(2.0, 9.0), dice.between(-4.0, 4.0), dice.between(-3.0, 3.0)}, 0.0, i % 3 ? crown : metal);
  w.add(Box{{40.0, 40.0, 1.0}}, {0.0, 0.0, -4.0}, 0.0, metal);
  w.add(Box{{1.0, 40.0, 40.0}}, {9.5, 0.0, 0.0}, 0.0, rough);
  const Scene scene = traced(w);
  for (const bool receiver : {false, true}) {
    LobeRadarSpec spec = bare_lobe();
    spec.echoes = receiver ? "receiver" : "traced";
    spec.noise = 0.01;
    spec.bounces_max = 4;
    spec.sampling = "jitter";
    spec.statistical_foliage = spec.excess_range = spec.radial_velocity = true;
    spec.detection_floor_db = -80.0;
    const auto scan_with = [&](std::size_t threads) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      return measured(spec, scene, Pose{}, 5);
    };
    const Scan one = scan_with(1), two = scan_with(2);
    REQUIRE(one.echoes.size() == two.echoes.size());
    REQUIRE(one.rays == two.rays);
    CHECK(one.rays > 58 * 58 + 500);  // the multipath is there
    for (std::size_t i = 0; i < one.echoes.size(); ++i) {
      CHECK(std::bit_cast<std::uint64_t>(one.echoes[i].range) == std::bit_cast<std::uint64_t>(two.echoes[i].range));
      CHECK(std::bit_cast<std::uint32_t>(one.echoes[i].amplitude) == std::bit_cast<std::uint32_t>(two.echoes[i].amplitude));
      CHECK(std::bit_cast<std::uint32_t>(one.echoes[i].radial_velocity) == std::bit_cast<std::uint32_t>(two.echoes[i].radial_velocity));
    }
    REQUIRE(one.profiles.amplitude.size() == two.profiles.amplitude.size());
    for (std::size_t i = 0; i < one.profiles.amplitude.size(); ++i)
      CHECK(std::bit_cast<std::uint32_t>(one.profiles.amplitude[i]) == std::bit_cast<std::uint32_t>(two.profiles.amplitude[i]));
  }
}

TEST_CASE("where nothing lets a wave through, the short way to the echoes gives those of the long one") {
  CHECK(rc::check("opaque worlds", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    HandMadeWorld w;
    for (int m = 0; m < 3; ++m) {
      const auto index = w.material("m", dice.between(0.0, 1.0), infinity);
      w.world.materials[index].roughness = dice.between(0.0, 1.0);
    }
    for (int i = 0; i < 25; ++i) {
      const glm::dvec3 at = dice.between(1.0, 8.0) * dice.direction();
      // Boxes on a grid, so that faces lie in faces.
      if (dice.chance(0.3)) w.add(Sphere{dice.between(0.1, 0.6)}, at, 0.0, dice.pick(3));
      else if (const glm::dvec3 middle = glm::round(at) + glm::dvec3(0.5, 0.5, 0.0); glm::length(middle) > 1.0) w.add(Box{{1.0, 1.0, 1.0}}, middle, 0.0, dice.pick(3));  // not about the sensor
    }
    HandMadeWorld with_foil = w;  // far away: now surfaces are looked for behind surfaces
    with_foil.add(Box{{1.0, 1.0, 1.0}}, {5000.0, 0.0, 0.0}, 0.0, with_foil.material("foil", 0.1, 1.0));
    LobeRadarSpec spec = bare_lobe(100.0, 20);
    spec.echoes = "traced";
    spec.bounces_max = 1 + dice.pick(3);
    const Scan shorter = measured(spec, traced(w)), longer = measured(spec, traced(with_foil));
    RC_ASSERT(shorter.echoes.size() == longer.echoes.size());
    for (std::size_t i = 0; i < shorter.echoes.size(); ++i) {
      RC_ASSERT(std::abs(shorter.echoes[i].range - longer.echoes[i].range) < 1e-9);
      RC_ASSERT(std::abs(shorter.echoes[i].amplitude - longer.echoes[i].amplitude) <= 1e-4f * longer.echoes[i].amplitude + 1e-9f);
      RC_ASSERT(shorter.echoes[i].bounces == longer.echoes[i].bounces);
    }
    for (std::size_t i = 0; i < shorter.beams.size(); ++i) {
      RC_ASSERT(shorter.beams[i].end == longer.beams[i].end);
      RC_ASSERT(std::abs(shorter.beams[i].sensed_range - longer.beams[i].sensed_range) < 1e-9);
    }
  }));
}

TEST_CASE("a pane in smoke that no radar sees is a pane in the open") {
  const auto beam_through = [](bool smoke) {
    HandMadeWorld w;
    rough_metal(w);
    Material glass;
    glass.dielectric = Dielectric{6.31, 0.0, 0.0036, 1.3394};
    glass.roughness = 0.0;
    w.world.materials.push_back(glass);
    w.add(Box{{1.0, 50.0, 50.0}}, {8.5, 0.0, 0.0});
    w.add(Box{{0.006, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
    if (smoke) w.add(Box{{20.0, 20.0, 20.0}}, {0.0, 0.0, 0.0}, 0.0, w.material("smoke", 0.0, 1e-6, true, false));
    ScanningRadarSpec spec = one_beam_radar();
    spec.scattering = "material";
    spec.fresnel = true;
    spec.slab_max_m = 0.1;
    spec.detection_floor_db = -150.0;
    return looked(spec, traced(w));
  };
  const OneBeam open = beam_through(false), smoky = beam_through(true);
  REQUIRE(open.echoes.size() == 2);
  REQUIRE(smoky.echoes.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(smoky.echoes[i].edge == open.echoes[i].edge);
    CHECK(smoky.power(i) == doctest::Approx(open.power(i)).epsilon(1e-4));
  }
}

TEST_CASE("leaves in rain, leaves that would take more than all, leaves that move") {
  HandMadeWorld w;
  rough_metal(w);
  Material crown;
  crown.reflectivity = 0.05;
  crown.attenuation_db_per_m = 20.0;
  crown.leaves_per_m = 1.0;  // each would have to take 4.6 of all there is
  w.world.materials.push_back(crown);
  const auto rain = w.material("rain", 0.0, 0.2);
  const auto bush = w.add(Box{{0.2, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
  w.add(Box{{200.0, 50.0, 60.0}}, {0.0, 0.0, 0.0}, 0.0, rain);
  w.add(Box{{1.0, 50.0, 50.0}}, {50.5, 0.0, 0.0});
  Motion motion;
  motion.points = {{4.0, 0.0, 0.0}, {14.0, 0.0, 0.0}};
  motion.speed = 2.0;
  w.world.solids[bush].motion = std::make_shared<const Motion>(motion);
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.statistical_foliage = spec.radial_velocity = true;
  spec.penetration_budget_db = 10.0;  // 50 m of rain but for the bush: 9.96 dB
  const auto sensor = make_sensor(spec, 0);
  Scan scan;
  const int scans = 4000;
  int through = 0, leaves = 0;
  for (int i = 0; i < scans; ++i) {
    sensor->measure(scene, Pose{}, 0.0, static_cast<std::uint64_t>(i), Random(1, 0), scan);
    for (const Echo& e : scan.echoes) {
      through += e.range > 49.0;
      leaves += e.range < 5.0;
      if (e.range < 5.0) CHECK(e.radial_velocity == doctest::Approx(2.0f));
    }
  }
  // On average as much gets through as through even matter of 4 dB: here a leaf stops all, so it is the share of the rays that meet none.
  const double share = std::pow(10.0, -0.4);
  CHECK(std::abs(through - share * scans) < 3.5 * std::sqrt(scans * share * (1.0 - share)));
  CHECK(through + leaves == scans);
}

TEST_CASE("the ways back are longer in matter too, and a beam ends where its last echo seems to be") {
  HandMadeWorld w;
  rough_metal(w);
  Material glass;
  glass.dielectric = Dielectric{4.0, 0.0, 0.0, 0.0};  // index 2
  w.world.materials.push_back(glass);
  w.add(Box{{1.0, 50.0, 50.0}}, {8.0, 0.0, 0.0});
  w.add(Box{{0.3, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
  ScanningRadarSpec spec = one_beam_radar();
  spec.excess_range = true;
  const OneBeam beam = looked(spec, traced(w));
  CHECK(beam.beam.end == BeamEnd::stopped);
  CHECK(beam.beam.sensed_range == doctest::Approx(7.8).epsilon(1e-12));
  CHECK(beam.beam.sensed_range == beam.echoes.back().range);
}

TEST_CASE("traced rays of a lobe count by its gain, and none is outside its section") {
  HandMadeWorld w;
  rough_metal(w);
  for (const glm::dvec3& side : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})  // a hollow cube around it
    for (const double sign : {1.0, -1.0}) w.add(Box{glm::dvec3(9.0) - 8.0 * side}, sign * 4.5 * side);
  const Scene scene = traced(w);
  LobeRadarSpec spec = bare_lobe(60.0, 21);
  spec.echoes = "traced";
  spec.scattering = "lambert";
  const Scan flat = measured(spec, scene);
  spec.gain = "gaussian";
  const Scan formed = measured(spec, scene);
  const std::size_t axis = 10 * 21 + 10, edge = 10 * 21;
  REQUIRE(formed.echoes.size() == 441);
  CHECK(formed.echoes[axis].amplitude == flat.echoes[axis].amplitude);
  // Two-way -6 dB at half the width; the outermost ray is half a cell inside of that.
  const double off = (30.0 - 30.0 / 21.0) / 30.0;
  CHECK(20.0 * std::log10(formed.echoes[edge].amplitude / flat.echoes[edge].amplitude) == doctest::Approx(-20.0 * std::log10(2.0) * off * off).epsilon(1e-4));
  spec.section = "elliptic";
  spec.sampling = "jitter";
  const Scan round = measured(spec, scene);
  for (const Beam& beam : round.beams)
    if (beam.echo_count > 0) CHECK(std::hypot(beam.azimuth, beam.elevation) <= radians(30.0) + 1e-9);
}

// What sensors see of materials: radar at a frequency, light through smoke.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../hand_made_world.hpp"
#include "one_beam.hpp"

using namespace thicket;

namespace {

double in_db(double power) {
  return 10.0 * std::log10(power);
}

/// Slabs across the x axis, of shipped materials or of media.
struct SlabWorld : HandMadeWorld {
  std::uint32_t shipped(const std::string& name) {
    const auto presets = material_presets();
    REQUIRE(static_cast<bool>(presets));
    world.materials.push_back(*std::ranges::find(*presets, name, &Material::name));
    return static_cast<std::uint32_t>(world.materials.size() - 1);
  }
  std::uint32_t medium(double extinction) {
    const auto index = material("medium", 0.0, 0.0, true, false);
    world.materials[index].light_extinction_per_m = extinction;
    return index;
  }
  SlabWorld& put(double from, double to, std::uint32_t of) {
    add(Box{{to - from, 50.0, 50.0}}, {0.5 * (from + to), 0.0, 0.0}, 0.0, of);
    return *this;
  }
};

LidarSpec one_beam_lidar(double optical_depth_max = 1.0) {
  LidarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.fov_deg = 1.0;
  spec.step_deg = 180.0;
  spec.range_max_m = 100.0;
  spec.optical_depth_max = optical_depth_max;
  return spec;
}
/// The one echo of a beam that has one.
double range_of(const OneBeam& b) {
  REQUIRE(b.echoes.size() == 1);
  CHECK(b.beam.end == BeamEnd::stopped);
  CHECK(b.beam.sensed_range == b.echoes[0].range);
  return b.echoes[0].range;
}
doctest::Approx about(double x) {
  return doctest::Approx(x).epsilon(1e-12);
}

}  // namespace

TEST_CASE("a radar of 7.29 GHz sees through plasterboard that exhausts one of 24 GHz") {
  SlabWorld w;
  const auto board = w.shipped("plasterboard"), metal = w.shipped("metal");
  w.put(5.0, 5.1, board).put(10.0, 11.0, metal);
  const Scene scene = traced(w);
  ScanningRadarSpec radar = one_beam_radar();
  radar.penetration_budget_db = 10.0;

  // By hand at 7.29 GHz: 54.394 dB/m take 5.4394 dB, the faces reflect 0.060777; metal reflects 0.99943. Both ways.
  radar.frequency_ghz = 7.29;
  const OneBeam low = looked(radar, scene);
  REQUIRE(low.echoes.size() == 3);
  CHECK(low.beam.end == BeamEnd::stopped);
  CHECK(low.beam.sensed_range == about(10.0));
  CHECK(in_db(low.power(0)) == doctest::Approx(-12.1626).epsilon(1e-5));
  CHECK(in_db(low.power(1)) == doctest::Approx(-23.5861).epsilon(1e-5));
  CHECK(in_db(low.power(2)) == doctest::Approx(-11.9705).epsilon(1e-5));

  // At 24 GHz 166.627 dB/m use up the 10 dB after 6.0 cm.
  radar.frequency_ghz = 24.0;
  const OneBeam high = looked(radar, scene);
  REQUIRE(high.echoes.size() == 1);
  CHECK(high.beam.end == BeamEnd::exhausted);
  CHECK(high.beam.sensed_range == doctest::Approx(5.0600143).epsilon(1e-8));
  CHECK(in_db(high.power(0)) == doctest::Approx(-12.1655).epsilon(1e-5));
  CHECK(ScanningRadarSpec{}.frequency_ghz == 24.0);
}

TEST_CASE("the list of what a ray crosses reaches as far as the frequency lets it") {
  // Read at 1 GHz both slabs together leave much of the budget, at 24 GHz the first alone uses it up: behind it nothing is listed.
  SlabWorld w;
  const auto board = w.shipped("plasterboard");
  w.put(5.0, 6.0, board).put(8.0, 8.1, board);
  const Scene scene = traced(w);
  const Ray ray{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 100.0};
  CrossingLists lists;
  std::vector<double> losses;
  for (const Material& m : at_frequency(scene.world().materials, 24.0)) losses.push_back(m.attenuation_db_per_m);
  CHECK(scene.crossings({&ray, 1}, 20.0, lists) == 0);
  CHECK(lists[0].size() == 2);
  CHECK(scene.crossings({&ray, 1}, losses, 20.0, lists) == 0);
  CHECK(lists[0].size() == 1);
  CHECK(scene.crossings({&ray, 1}, losses, 20.0, lists, true) == 0);
  CHECK(lists[0].size() == 2);
}

TEST_CASE("what a radar detects is asked at its frequency") {
  // Of a permittivity that falls with the frequency, the reflectivity falls too.
  Material ground;
  ground.dielectric = Dielectric{15.0, -0.5, 0.0, 0.0};
  ScanningRadarSpec radar;
  radar.detection_floor_db = in_db(at_frequency(ground, 10.0).reflectivity);
  radar.frequency_ghz = 5.0;
  CHECK(make_sensor(radar, 0)->detects(ground));
  radar.frequency_ghz = 20.0;
  CHECK_FALSE(make_sensor(radar, 0)->detects(ground));
}

TEST_CASE("light that smoke scatters ends one mean free path inside, and that is an echo") {
  for (const double extinction : {0.5, 2.0, 10.0}) {
    CAPTURE(extinction);
    SlabWorld w;
    const auto wall = w.material("wall", 0.5, infinity), smoke = w.medium(extinction);
    w.put(5.0, 9.0, smoke).put(20.0, 21.0, wall);
    const OneBeam b = looked(one_beam_lidar(), traced(w));
    CHECK(range_of(b) == about(5.0 + 1.0 / extinction));
    CHECK(b.power(0) == as_power(std::exp(-2.0)));
    CHECK(b.echoes[0].incidence_cosine == doctest::Approx(1.0));
    CHECK(b.echoes[0].edge == Edge::front);
    CHECK(range_of(looked(one_beam_lidar(1.5), traced(w))) == about(5.0 + 1.5 / extinction));
    // From inside the smoke it is the same.
    CHECK(range_of(looked(one_beam_lidar(), traced(w), Pose::planar(6.0, 0.0, 0.0, 0.0))) == about(1.0 / extinction));
  }
}

TEST_CASE("through haze light comes to the wall, weaker by what the haze takes there and back") {
  SlabWorld w;
  const auto wall = w.material("wall", 0.5, infinity), haze = w.medium(0.1);
  w.put(5.0, 9.0, haze).put(20.0, 21.0, wall);
  const OneBeam b = looked(one_beam_lidar(), traced(w));
  CHECK(range_of(b) == about(20.0));
  CHECK(b.power(0) == as_power(std::exp(-2.0 * 0.4)));
  // Less depth, and it ends in the haze; any depth, and no smoke ends it.
  CHECK(range_of(looked(one_beam_lidar(0.2), traced(w))) == about(7.0));
  SlabWorld thick;
  thick.material("wall", 0.5, infinity);
  thick.put(5.0, 9.0, thick.medium(50.0)).put(20.0, 21.0, 0);
  CHECK(range_of(looked(one_beam_lidar(infinity), traced(thick))) == about(20.0));
  // With nothing behind, the haze is not seen.
  SlabWorld open;
  open.put(5.0, 9.0, open.medium(0.1));
  const OneBeam silent = looked(one_beam_lidar(), traced(open));
  CHECK(silent.echoes.empty());
  CHECK(silent.beam.end == BeamEnd::open);
  CHECK(silent.beam.sensed_range == 100.0);
}

TEST_CASE("optical depth adds up from medium to medium, and where they overlap the thickest counts") {
  SlabWorld w;
  const auto wall = w.material("wall", 0.5, infinity), thin = w.medium(0.1), thick = w.medium(0.4);
  // 5 to 7: 0.2, 7 to 8: 0.4, 8 to 9: 0.1, gap, from 10 on 0.1 a metre: the last 0.3 are used up at 13.
  w.put(5.0, 9.0, thin).put(7.0, 8.0, thick).put(10.0, 15.0, thin).put(20.0, 21.0, wall);
  CHECK(range_of(looked(one_beam_lidar(), traced(w))) == about(13.0));
  CHECK(range_of(looked(one_beam_lidar(0.5), traced(w))) == about(7.75));
  // A surface inside a medium is met before the medium ends.
  w.put(12.0, 12.5, wall);
  const OneBeam b = looked(one_beam_lidar(), traced(w));
  CHECK(range_of(b) == about(12.0));
  CHECK(b.power(0) == as_power(std::exp(-2.0 * 0.9)));
}

TEST_CASE("in a world with smoke, surfaces, glass, ranges and starts are as in one without") {
  SlabWorld w;
  const auto wall = w.material("wall", 0.5, infinity), glass = w.shipped("glass");
  w.medium(0.1);
  w.put(3.0, 3.1, glass).put(8.0, 9.0, wall);
  const Scene scene = traced(w);
  CHECK(range_of(looked(one_beam_lidar(), scene)) == about(8.0));
  const OneBeam tilted = looked(one_beam_lidar(), scene, Pose::planar(0.0, 0.0, 0.0, pi / 3));
  CHECK(range_of(tilted) == about(16.0));
  CHECK(tilted.power(0) == as_power(0.5));
  const OneBeam inside = looked(one_beam_lidar(), scene, Pose::planar(8.5, 0.0, 0.0, 0.0));
  CHECK(range_of(inside) == 0.0);
  CHECK(inside.echoes[0].incidence_cosine == 1.0f);
  LidarSpec spec = one_beam_lidar();
  spec.range_min_m = 8.5;
  const OneBeam near = looked(spec, scene);
  CHECK(near.echoes.empty());
  CHECK(near.beam.end == BeamEnd::stopped);
  spec = one_beam_lidar();
  spec.range_max_m = 7.0;
  const OneBeam far = looked(spec, scene);
  CHECK(far.echoes.empty());
  CHECK(far.beam.end == BeamEnd::open);
  CHECK(far.beam.sensed_range == 7.0);
}

TEST_CASE("where smoke hides a wall from light, a radar sees the wall and nothing else") {
  SlabWorld w;
  const auto brick = w.shipped("brick"), smoke = w.shipped("smoke");
  w.put(5.0, 15.0, smoke).put(20.0, 21.0, brick);
  const Scene scene = traced(w);
  CHECK(range_of(looked(one_beam_lidar(), scene)) == about(5.5));
  ScanningRadarSpec radar = one_beam_radar();
  radar.penetration_budget_db = 10.0;
  radar.detection_floor_db = -60.0;
  const OneBeam b = looked(radar, scene);
  REQUIRE(b.echoes.size() >= 1);
  CHECK(b.echoes[0].range == about(20.0));
  CHECK(in_db(b.power(0)) == doctest::Approx(in_db(0.107767) - 0.02).epsilon(1e-5));  // 10 m of 0.001 dB/m, both ways
}

TEST_CASE("what light does is a matter of the keys: smoke without a finite extinction is a wall, and what passes light has no depth") {
  SlabWorld w;
  const auto wall = w.material("wall", 0.5, infinity), closed = w.material("closed smoke", 1e-7, 0.05, true, false);
  w.put(5.0, 9.0, closed).put(20.0, 21.0, wall);
  CHECK(range_of(looked(one_beam_lidar(), traced(w))) == about(5.0));
  w.world.materials[closed].stops_light = false;
  w.world.materials[closed].light_extinction_per_m = 10.0;
  CHECK(range_of(looked(one_beam_lidar(), traced(w))) == about(20.0));
}

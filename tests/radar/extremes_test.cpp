// Whatever the keys say: scans that are finite, in order and in range, and the same every time. Values are drawn from the ends of what the keys allow.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "lobe.hpp"
#include "thicket/base/files.hpp"

using namespace thicket;

namespace {

struct Choices {
  const char* key;
  std::vector<const char*> values;
};

const std::vector<Choices> of_both = {
    {"range_min_m", {"0", "0.5", "4"}},
    {"range_max_m", {"0.001", "5", "10", "30", "1000", "1e5"}},
    {"range_noise_m", {"0", "0.1", "1e6"}},
    {"frequency_ghz", {"0.3", "7.29", "300"}},
    {"law", {"'radar_equation'", "'printed'"}},
    {"range_compensation", {"true", "false"}},
    {"penetration_budget_db", {"0", "1", "20", "inf"}},
    {"detection_floor_db", {"-300", "-60", "0"}},
    {"scattering", {"'material'", "'lambert'"}},
    {"fresnel", {"true", "false"}},
    {"slab_max_m", {"0", "0.1", "1e300"}},
    {"excess_range", {"true", "false"}},
    {"statistical_foliage", {"true", "false"}},
    {"bounces_max", {"1", "2", "3", "16", "64"}},
    {"radial_velocity", {"true", "false"}},
    {"sampling", {"'regular'", "'jitter'"}},
    {"echoes", {"'traced'", "'receiver'"}},
    {"bin_count", {"0", "1", "2", "188", "1536"}},
    {"bin_size_m", {"1e-300", "1e-6", "0.0064256", "0.05", "1000"}},
    {"bin_offset_m", {"-1000", "-0.2", "0", "5", "1e5"}},
    {"bandwidth_ghz", {"0", "1e-300", "0.01", "1.5", "100"}},
    {"signal", {"'amplitude'", "'iq'"}},
    {"noise", {"0", "0.01", "1e6"}},
    {"noise_walk", {"0", "0.01", "1e6"}},
    {"smoothing_bins", {"1", "2", "7", "10000"}},
    {"clutter_floor", {"0", "0.1", "1e6"}},
    {"saturation", {"inf", "1e-30", "1"}},
    {"detector", {"'threshold'", "'ca_cfar'"}},
    {"threshold", {"1e-300", "1e-30", "0.038", "1e6"}},
    {"false_alarm_rate", {"1e-15", "1e-6", "0.4"}},
    {"cfar_training_bins", {"1", "16", "10000"}},
    {"cfar_guard_bins", {"0", "4", "10000"}},
    {"detection", {"'first'", "'strongest'", "'all'"}},
    {"floor_gate", {"true", "false"}},
};
const std::vector<Choices> of_lobes = {
    {"azimuth_opening_deg", {"180", "65", "0.001"}},
    {"elevation_opening_deg", {"170", "65", "0.001"}},
    {"azimuth_rays", {"1", "2", "31"}},
    {"elevation_rays", {"1", "2", "31"}},
    {"section", {"'square'", "'elliptic'"}},
    {"gain", {"'flat'", "'gaussian'"}},
    {"gain_width_deg", {"[1e-300, 1e-300]", "[1e-3, 1e-3]", "[0.1, 65.0]", "[360.0, 360.0]"}},
};
const std::vector<Choices> of_scanners = {
    {"fov_deg", {"360", "90", "1e-300"}},
    {"step_deg", {"3", "7", "180"}},
    {"elevation_opening_deg", {"0", "20", "170"}},
    {"elevation_rays", {"1", "2", "5"}},
    {"divergence", {"'none'", "'side_rays'", "'cone'"}},
    {"side_offset_m", {"0", "0.2", "1000"}},
    {"side_geometry", {"'diverging'", "'parallel'"}},
    {"side_choice", {"'equal'", "'incidence'", "'strongest'", "'sum'"}},
    {"cone_opening_deg", {"0.001", "2", "90"}},
    {"cone_rays", {"1", "2", "7"}},
    {"first_echo_only", {"true", "false"}},
};

const std::vector<Choices> of_lidars = {
    {"range_min_m", {"0", "0.5", "4"}},
    {"range_max_m", {"0.001", "5", "30", "1e5"}},
    {"range_noise_m", {"0", "0.1", "1e6"}},
    {"fov_deg", {"360", "90", "1e-300"}},
    {"step_deg", {"3", "7", "180"}},
    {"optical_depth_max", {"1e-300", "0.1", "1", "1e300", "inf"}},
    {"range_noise_table_m", {"[[0, 0]]", "[[0, 1e6], [0, 0], [1e6, 1e6]]", "[[1, 0.01], [10, 0.03]]"}},
};

/// An entry that sets some of the keys, and a few that are always there to keep this quick.
std::string drawn_entry(Dice& dice) {
  const double kind = dice.between(0.0, 1.0);
  std::string text = kind < 0.45 ? "type = 'lobe_radar'\n" : kind < 0.9 ? "type = 'scanning_radar'\n" : "type = 'lidar'\n";
  const double density = dice.between(0.1, 0.8);
  const std::vector<const std::vector<Choices>*> lists =
      kind < 0.45 ? std::vector{&of_both, &of_lobes} : kind < 0.9 ? std::vector{&of_both, &of_scanners} : std::vector{&of_lidars};
  for (const auto* list : lists)
    for (const Choices& choices : *list)
      if (dice.chance(density) || std::strstr("azimuth_rays elevation_rays step_deg", choices.key))
        text += fmt::format("{} = {}\n", choices.key, choices.values[dice.pick(static_cast<std::uint32_t>(choices.values.size()))]);
  return text;
}

/// Smoke, a crown, a pane, a mirror, a mesh's worth of boxes that share faces; one thing moves. With or without a floor.
World everything(bool with_floor) {
  HandMadeWorld w;
  const auto presets = material_presets();
  REQUIRE(presets);
  w.world.materials = *presets;
  const auto of = [&](const char* name) {
    const auto found = std::ranges::find(w.world.materials, name, &Material::name);
    REQUIRE(found != w.world.materials.end());
    return static_cast<std::uint32_t>(found - w.world.materials.begin());
  };
  w.add(Sphere{3.0}, {0.0, 0.0, 0.0}, 0.0, of("smoke"));
  w.add(Sphere{1.5}, {3.0, 0.0, 0.5}, 0.0, of("foliage_p833"));
  w.world.materials[of("foliage_p833")].leaves_per_m = 30.0;
  w.add(Box{{0.006, 3.0, 3.0}}, {5.0, 0.0, 0.0}, 0.0, of("glass"));
  w.add(Box{{1.0, 1.0, 1.0}}, {2.0, 2.0, 0.0}, 0.0, of("wood"));
  w.add(Box{{1.0, 1.0, 1.0}}, {3.0, 2.0, 0.0}, 0.0, of("brick"));
  w.add(Box{{0.2, 8.0, 6.0}}, {8.0, 0.0, 0.0}, 0.0, of("mirror"));
  w.add(Box{{8.0, 0.2, 6.0}}, {0.0, 4.1, 0.0}, 0.0, of("mirror"));
  w.add(Box{{8.0, 0.2, 6.0}}, {0.0, -4.1, 0.0}, 0.0, of("metal"));
  w.add(Cylinder{0.002, 2.0}, {1.0, 0.5, 0.0}, 0.0, of("metal"));
  Motion motion;
  motion.points = {{-2.0, -2.0, 0.0}, {-2.0, 2.0, 0.0}};
  motion.speed = 1.5;
  motion.spin = 1.0;
  const auto walker = w.add(Box{{0.5, 0.3, 1.8}}, {-2.0, -2.0, 0.0}, 0.0, of("concrete"));
  w.world.solids[walker].motion = std::make_shared<const Motion>(motion);
  if (with_floor) w.add(Box{{30.0, 30.0, 0.2}}, {0.0, 0.0, -1.1}, 0.0, of("concrete"));
  return w.world;
}

/// What is wrong with a scan; nothing if it is as it should be.
std::string fault_of(const Scan& scan, const SensorSpec& spec) {
  const MountedSpec& common = mounted(spec);
  const auto* lidar = std::get_if<LidarSpec>(&spec);
  const bool shifted = common.range_noise_m > 0.0 || (lidar && !lidar->range_noise_table_m.empty());
  for (const Beam& beam : scan.beams) {
    if (!(beam.sensed_range >= 0.0 && beam.sensed_range <= common.range_max_m)) return fmt::format("a beam sensed as far as {}", beam.sensed_range);
    if (!(std::abs(glm::length(beam.direction) - 1.0) < 1e-9)) return "a beam's direction is not of length 1";
    double before = -1.0;
    for (const Echo& echo : scan.echoes_of(beam)) {
      if (!(echo.range >= (shifted ? 0.0 : common.range_min_m) - 1e-9 && echo.range <= common.range_max_m * (1.0 + 1e-9))) return fmt::format("an echo at {}", echo.range);
      if (!(echo.range >= before)) return fmt::format("an echo at {} after one at {}", echo.range, before);
      before = echo.range;
      if (!(std::isfinite(echo.amplitude) && echo.amplitude >= 0.0f)) return fmt::format("an amplitude of {}", echo.amplitude);
      if (!(echo.incidence_cosine >= 0.0f && echo.incidence_cosine <= 1.0f)) return fmt::format("a cosine of {}", echo.incidence_cosine);
      if (!(std::abs(echo.radial_velocity) < 20.0f)) return fmt::format("a velocity of {}", echo.radial_velocity);
    }
  }
  for (const float amplitude : scan.profiles.amplitude)
    if (!std::isfinite(amplitude)) return fmt::format("an amplitude of {} in a profile", amplitude);
  for (const auto& iq : scan.profiles.iq)
    if (!std::isfinite(iq.real()) || !std::isfinite(iq.imag())) return "an I/Q that is not finite";
  for (const float threshold : scan.profiles.threshold)
    if (std::isnan(threshold) || threshold < 0.0f) return fmt::format("a threshold of {}", threshold);
  return "";
}

bool same(const Scan& a, const Scan& b) {
  return a.rays == b.rays && a.profiles.amplitude == b.profiles.amplitude && a.profiles.threshold == b.profiles.threshold &&
         std::ranges::equal(a.echoes, b.echoes, [](const Echo& x, const Echo& y) { return x.range == y.range && x.amplitude == y.amplitude && x.radial_velocity == y.radial_velocity; });
}

}  // namespace

TEST_CASE("any keys, any place: scans are finite, in order, in range and the same again") {
  const char* asked = std::getenv("THICKET_EXTREMES");  // how many, for a longer hunt
  const int count = asked ? std::atoi(asked) : 100;
  const Scene with_floor = traced(everything(true)), without = traced(everything(false)), empty = traced(World{});
  World far_off = everything(true);
  const glm::dvec3 far(1048576.0, -1048576.0, 0.0);
  for (Solid& solid : far_off.solids) solid.position += far;
  const Scene far_scene = traced(far_off);
  // In smoke; in the crown; on the pane; in the wood; in the mirror; on its surface; on the floor; where two boxes meet; far up.
  const std::vector<glm::dvec3> places = {{0, 0, 0},          {3, 0, 0.5},       {4.997, 0.0, 0.0},    {2, 2, 0},           {8, 0, 0},
                                          {7.9, 0.5, 0.5},    {0.0, 0.0, -1.0},  {2.5, 2.0, 0.0},      {0, 0, 90}};
  int read = 0;
  for (int i = 0; i < count; ++i) {
    Dice dice(static_cast<std::uint64_t>(i) + 1);
    const std::string text = "position_m = [0, 0, 0]\n" + drawn_entry(dice);
    Faults faults;
    const auto entry = parse_document(text, "drawn");
    REQUIRE(entry);
    const SensorSpec spec = read_sensor(*entry, faults);
    if (!faults.none()) continue;  // a nearer range_max_m than range_min_m, and the like
    ++read;
    const std::uint32_t where = dice.pick(4);
    Scene scene = where == 0 ? empty : where == 1 ? without : where == 2 ? far_scene : with_floor;
    scene.set_time(dice.between(0.0, 5.0));
    Pose pose = Pose::planar(0.0, 0.0, 0.0, dice.between(-pi, pi));
    pose.position = places[dice.pick(static_cast<std::uint32_t>(places.size()))] + (where == 2 ? far : glm::dvec3(0.0));
    pose.orientation = pose.orientation * glm::angleAxis(dice.chance(0.5) ? 0.0 : dice.between(-0.5 * pi, 0.5 * pi), glm::dvec3(0.0, 1.0, 0.0));
    const Platform platform(pose, {1.0, -2.0, 0.5}, {0.0, 0.0, 1.0});
    const auto sensor = make_sensor(spec, 0);
    Scan first, second;
    sensor->measure(scene, platform, 0.0, 7, Random(1, 0), first);
    const std::string fault = fault_of(first, spec);
    CHECK_MESSAGE(fault.empty(), i, ", ", fault, ", scene ", where, ", at ", pose.position.x, ", ", pose.position.y, ", ", pose.position.z, ":\n", text);
    sensor->measure(scene, platform, 0.0, 7, Random(1, 0), second);
    CHECK_MESSAGE(same(first, second), i, ", not the same again:\n", text);
  }
  CHECK(read > count / 4);
}

TEST_CASE("an antenna whose gain is nothing along all its rays receives nothing") {
  const Scene scene = traced(everything(true));
  for (const char* law : {"radar_equation", "printed"}) {
    for (const char* sampling : {"regular", "jitter"}) {
      for (const char* echoes : {"traced", "receiver"}) {
        LobeRadarSpec spec = bare_lobe();
        spec.gain = "gaussian";
        spec.gain_width_deg = glm::dvec2(1e-3, 1e-3);
        spec.law = law;
        spec.sampling = sampling;
        spec.echoes = echoes;
        spec.bounces_max = 3;
        const Scan scan = measured(spec, scene);
        CHECK(fault_of(scan, spec) == "");
        for (const float amplitude : scan.profiles.amplitude) CHECK(amplitude == 0.0f);
      }
    }
  }
}

TEST_CASE("extremes: sensors: a lobe of 1 ray has the wall at its range, one of 10^6 has its power to 0.05 dB of the closed form") {
  // A rough plate that is small against the lobe, seen squarely: 4 A cos^2 = 4 A.
  HandMadeWorld w;
  const auto rough = rough_metal(w);
  w.add(Box{{1.0, 1.0, 1.0}}, {8.5, 0.0, 0.0}, 0.0, rough);
  const Scene scene = traced(w);
  const Scan one = measured(bare_lobe(65.0, 1), scene);
  CHECK(one.rays == 1);
  const auto profile = one.profiles.amplitude_of(0);
  const auto top = static_cast<std::uint32_t>(std::ranges::max_element(profile) - profile.begin());
  CHECK(profile[top] > 0.0f);
  CHECK(std::abs(one.profiles.range(top) - 8.0) <= 0.05);
  const LobeRadarSpec fine = bare_lobe(65.0, 1000);
  const Scan many = measured(fine, scene);
  CHECK(many.rays == 1000000);
  CHECK(fault_of(many, fine) == "");
  CHECK(std::abs(10.0 * std::log10(received_power(many) / power_of(4.0, 8.0, fine))) < 0.05);
}

TEST_CASE("extremes: sensors: ranges of 1 mm and of 10 km are met to 1e-9 of themselves") {
  for (const double range_max : {0.001, 10000.0}) {
    CAPTURE(range_max);
    HandMadeWorld w;
    const auto rough = rough_metal(w);
    w.add(Box{{0.1 * range_max, 4.0 * range_max, 4.0 * range_max}}, {0.85 * range_max, 0.0, 0.0}, 0.0, rough);
    const Scene scene = traced(w);
    ScanningRadarSpec spec = one_beam_radar();
    spec.range_min_m = 0.0;
    spec.range_max_m = range_max;
    const OneBeam one = looked(spec, scene);
    REQUIRE(one.echoes.size() >= 1);
    CHECK(std::abs(one.echoes[0].range - 0.8 * range_max) <= 1e-9 * range_max);
    CHECK(std::isfinite(one.echoes[0].amplitude));
    CHECK(one.echoes[0].amplitude > 0.0f);
  }
}

TEST_CASE("extremes: sensors: in 1 bin is all the power, in 10^5 bins the echo is in its own") {
  HandMadeWorld w;
  const auto rough = rough_metal(w);
  w.add(Box{{1.0, 40.0, 40.0}}, {8.5, 0.0, 0.0}, 0.0, rough);
  const Scene scene = traced(w);
  LobeRadarSpec spec = bare_lobe(1.0, 3);
  const double all = received_power(spec, scene);
  spec.bin_count = 1;
  spec.bin_size_m = 100.0;
  spec.bin_offset_m = 8.0;
  CHECK(received_power(spec, scene) == doctest::Approx(all).epsilon(0.01));
  spec.bin_count = 100000;
  spec.bin_size_m = 0.0001;
  spec.bin_offset_m = 0.0;
  const Scan scan = measured(spec, scene);
  CHECK(fault_of(scan, spec) == "");
  const auto profile = scan.profiles.amplitude_of(0);
  REQUIRE(profile.size() == 100000);
  CHECK(received_power(scan) == doctest::Approx(all).epsilon(0.01));
  for (std::uint32_t bin = 0; bin < profile.size(); ++bin)
    if (profile[bin] > 0.0f) CHECK((scan.profiles.range(bin) > 7.9998 && scan.profiles.range(bin) < 8.0015));  // 8 m, and 8 m over the cosine of 1.0 / 2 x sqrt(2) degrees at most
}

TEST_CASE("extremes: sensors: noise of 0 is none, noise of 10^6 has its deviation to 2 %, and a threshold of 0 is refused") {
  const Scene scene = traced(World{});
  LobeRadarSpec spec = bare_lobe(65.0, 3);
  for (const float amplitude : measured(spec, scene).profiles.amplitude) CHECK(amplitude == 0.0f);
  spec.noise = 1e6;
  spec.bin_count = 100000;
  spec.bin_size_m = 0.0001;
  const Scan loud = measured(spec, scene);
  CHECK(fault_of(loud, spec) == "");
  double squares = 0.0;
  for (const float amplitude : loud.profiles.amplitude) squares += static_cast<double>(amplitude) * static_cast<double>(amplitude);
  CHECK(std::sqrt(squares / 1e5) == doctest::Approx(1e6).epsilon(0.02));
  Faults faults;
  const auto entry = parse_document("type = 'lobe_radar'\nthreshold = 0", "f");
  REQUIRE(entry);
  read_sensor(*entry, faults);
  REQUIRE_FALSE(faults.none());
  CHECK(faults.error().message.find("f:2:13: 'threshold' is 0, expected") == 0);
}

TEST_CASE("extremes: sensors: with a penetration budget of 0 the first face is all, with an infinite one all faces are there") {
  HandMadeWorld w;
  const auto leaves = w.material("leaves", 0.05, 0.01);
  for (int i = 0; i < 50; ++i) w.add(Box{{0.2, 20.0, 20.0}}, {1.0 + i, 0.0, 0.0}, 0.0, leaves);
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.penetration_budget_db = 0.0;
  const OneBeam none = looked(spec, scene);
  REQUIRE(none.echoes.size() == 1);
  CHECK(none.echoes[0].range == doctest::Approx(0.9));
  CHECK(none.beam.end == BeamEnd::exhausted);
  spec.penetration_budget_db = infinity;
  const OneBeam all = looked(spec, scene);
  CHECK(all.echoes.size() == 100);
  CHECK(all.beam.end == BeamEnd::open);
}

TEST_CASE("extremes: sensors: between two mirrors a wave comes back after 64 bounces, from the range that its image has, to 1e-6 m") {
  // A beam goes up a corridor of mirrors 1 m wide, at 45 degrees: each bounce takes it a metre on, sqrt(2) m of way. The last surface is a rough wall across its way at x = 63.
  HandMadeWorld w;
  const auto glass = mirror(w), rough = rough_metal(w);
  w.add(Box{{200.0, 1.0, 200.0}}, {0.0, 1.0, 0.0}, 0.0, glass);   // from y = 0.5
  w.add(Box{{200.0, 1.0, 200.0}}, {0.0, -1.0, 0.0}, 0.0, glass);  // to y = -0.5
  w.add(Box{{1.0, 1.0, 4.0}}, {63.5, 0.0, 0.0}, 0.0, rough);
  const Scene scene = traced(w);
  ScanningRadarSpec spec = one_beam_radar();
  spec.scattering = "material";
  spec.fov_deg = 0.5;
  spec.step_deg = 1.0;
  spec.yaw_deg = 45.0;
  spec.range_max_m = 200.0;
  for (const int most : {63, 64}) {
    spec.bounces_max = most;
    const OneBeam one = looked(spec, scene);
    std::size_t of_64 = 0;
    double worst = 0.0;
    for (const Echo& echo : one.echoes) {
      CHECK(std::isfinite(echo.amplitude));
      CHECK(echo.bounces <= most);
      if (echo.bounces != 64) continue;
      ++of_64;
      // Its image stands 63 m off in x; the beam that goes there at 45 degrees is 63 sqrt(2) long, and comes back the same way or straight.
      const double there = 63.0 * std::sqrt(2.0);
      worst = std::max(worst, std::min(std::abs(echo.range - there), std::abs(echo.range - 0.5 * (there + 63.0))));
    }
    CHECK((of_64 > 0) == (most == 64));
    CHECK(worst <= 1e-6);
  }
}

// Sensors as files describe them.
#include "thicket/radar/sensor_spec.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/radar/sensor.hpp"

using namespace thicket;

namespace {

struct Reading {
  SensorSpec spec;
  std::string faults;
};
Reading read(const std::string& text) {
  const auto document = parse_document(text, "s.toml");
  REQUIRE_MESSAGE(static_cast<bool>(document), (document ? "" : document.error().message));
  Faults faults;
  Reading reading{read_sensor(*document, faults), ""};
  if (!faults.none()) reading.faults = faults.error().message;
  return reading;
}
std::string faults_of(const std::string& text) {
  return read(text).faults;
}
std::size_t lines_in(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace

TEST_CASE("the presets that are shipped load, each as its own type") {
  CHECK(sensor_presets() == std::vector<std::string>{"bumpers", "k2pi", "navtech", "urg04lx", "usarsim2012", "utm30lx", "x4m05"});
  for (const std::string& name : sensor_presets()) {
    CAPTURE(name);
    const Reading reading = read("preset = \"" + name + "\"");
    CHECK(reading.faults == "");
    const bool lidar = name == "urg04lx" || name == "utm30lx";
    CHECK(std::string(sensor_type(reading.spec)) == (lidar ? "lidar" : name == "x4m05" ? "lobe_radar" : "scanning_radar"));
  }
  const Reading urg = read("preset = \"urg04lx\"");
  CHECK(scanner(urg.spec)->fov_deg == 240.0);
  CHECK(scanner(urg.spec)->step_deg == 0.3515625);
  CHECK(mounted(urg.spec).range_max_m == 4.0);
  const Reading utm = read("preset = \"utm30lx\"");
  CHECK(mounted(utm.spec).rate_hz == 40.0);
  CHECK(mounted(utm.spec).range_max_m == 30.0);
  // An accuracy of +-30 mm, of +-50 mm beyond 10 m, is three standard deviations.
  CHECK(std::get<LidarSpec>(utm.spec).range_noise_table_m == std::vector<glm::dvec2>{{0.1, 0.01}, {10.0, 0.01}, {10.0, 0.016667}, {30.0, 0.016667}});
  const Reading lobe = read("preset = \"x4m05\"");
  CHECK(std::get<LobeRadarSpec>(lobe.spec).bin_count == 1536);
  CHECK(mounted(lobe.spec).range_max_m == doctest::Approx(1536 * 0.0064256).epsilon(1e-4));
  CHECK(360.0 / scanner(read("preset = \"navtech\"").spec)->step_deg == doctest::Approx(400.0));
  const Reading radar = read("preset = \"usarsim2012\"");
  CHECK(std::get<ScanningRadarSpec>(radar.spec).penetration_budget_db == 10.0);
  CHECK(std::get<ScanningRadarSpec>(radar.spec).divergence == "none");
}

TEST_CASE("keys come on top of a preset, or of a type's defaults") {
  const Reading reading =
      read("preset = \"usarsim2012\"\nname = \"front\"\nrange_max_m = 50\ndivergence = \"side_rays\"\nposition_m = [0.1, 0, 0.5]\n");
  CHECK(reading.faults == "");
  const auto& spec = std::get<ScanningRadarSpec>(reading.spec);
  CHECK(spec.name == "front");
  CHECK(spec.range_max_m == 50.0);
  CHECK(spec.divergence == "side_rays");
  CHECK(spec.position_m == glm::dvec3(0.1, 0.0, 0.5));
  CHECK(spec.penetration_budget_db == 10.0);
  CHECK(read("type = \"scanning_radar\"\npreset = \"usarsim2012\"").faults == "");

  const Reading radar = read("type = \"scanning_radar\"\npenetration_budget_db = inf\n");
  CHECK(radar.faults == "");
  CHECK(std::get<ScanningRadarSpec>(radar.spec).penetration_budget_db == std::numeric_limits<double>::infinity());
  CHECK(std::get<ScanningRadarSpec>(radar.spec).range_max_m == ScanningRadarSpec{}.range_max_m);
  const Reading lidar = read("type = \"lidar\"\n");
  CHECK(lidar.faults == "");
  CHECK(std::holds_alternative<LidarSpec>(lidar.spec));
}

TEST_CASE("a preset may be a file of one's own") {
  const TemporaryFolder folder;
  const auto file = folder.write("mine.toml", "type = \"lidar\"\nrange_max_m = 7.0\n");
  const Reading reading = read("preset = \"" + file.string() + "\"\nname = \"mine\"\n");
  CHECK(reading.faults == "");
  CHECK(std::get<LidarSpec>(reading.spec).range_max_m == 7.0);

  // Its faults are told with its own places.
  const auto broken = folder.write("broken.toml", "type = \"lidar\"\nrange_max = 7.0\n");
  CHECK(faults_of("preset = \"" + broken.string() + "\"") ==
        broken.string() + ":2:1: unknown key 'range_max' in [[sensor]] of type \"lidar\" (did you mean 'range_max_m'?)");
  // A preset that names itself is told, not followed for ever.
  const auto loop = folder.path() / "loop.toml";
  folder.write("loop.toml", "preset = \"" + loop.string() + "\"\n");
  CHECK(faults_of("preset = \"" + loop.string() + "\"").find(loop.string() + ":1:10: ") == 0);
}

TEST_CASE("presets and types that are wrong, missing, or do not fit") {
  CHECK(faults_of("preset = \"usarsim2021\"") ==
        "s.toml:1:10: there is no sensor preset 'usarsim2021', expected one of 'bumpers', 'k2pi', 'navtech', 'urg04lx', 'usarsim2012', 'utm30lx', 'x4m05' or a file (did you mean "
        "'usarsim2012'?)");
  CHECK(faults_of("preset = 5") == "s.toml:1:10: 'preset' is an integer, expected a text in quotes");
  CHECK(faults_of("preset = \"utm30lx\"\ntype = \"scanning_radar\"") ==
        "s.toml:2:8: 'type' is 'scanning_radar', but the preset is of type 'lidar': leave one of them out");
  CHECK(faults_of("type = \"lidra\"") ==
        "s.toml:1:8: 'type' is 'lidra', expected one of 'scanning_radar', 'lobe_radar', 'lidar' (did you mean 'lidar'?)");
  CHECK(faults_of("type = true") == "s.toml:1:8: 'type' is true or false, expected one of 'scanning_radar', 'lobe_radar', 'lidar'");
  CHECK(faults_of("name = \"x\"") ==
        "s.toml:1:1: [[sensor]] lacks 'type' or 'preset', expected a type of 'scanning_radar', 'lobe_radar', 'lidar', or a preset of 'bumpers', 'k2pi', "
        "'navtech', 'urg04lx', 'usarsim2012', 'utm30lx', 'x4m05'");
}

TEST_CASE("what is wrong with the name of a preset is told once, and not of the keys that it would have had") {
  const std::string unknown = faults_of("preset = \"utm30\"\ntype = \"lidar\"\nrange_max_m = 5.0\n");
  CAPTURE(unknown);
  CHECK(unknown.find("s.toml:1:10: there is no sensor preset 'utm30'") == 0);
  CHECK(lines_in(unknown) == 1);
}

TEST_CASE("bad values of a sensor, with their places") {
  const std::string head = "type = \"scanning_radar\"\n";
  CHECK(faults_of(head + "fov_deg = 400\n") == "s.toml:2:11: 'fov_deg' is 400, expected a number in deg, above 0 and at most 360");
  CHECK(faults_of(head + "fov_deg = 0\n") == "s.toml:2:11: 'fov_deg' is 0, expected a number in deg, above 0 and at most 360");
  CHECK(faults_of(head + "step_deg = 0\n") == "s.toml:2:12: 'step_deg' is 0, expected a number in deg, at least 0.001 and at most 180");
  CHECK(faults_of(head + "rate_hz = nan\n") == "s.toml:2:11: 'rate_hz' is nan, expected a number in Hz, above 0 and at most 10000");
  CHECK(faults_of(head + "range_max_m = inf\n")
            .find("s.toml:2:15: 'range_max_m' is inf, expected a number in m, above 0 and at most 100000") == 0);
  CHECK(faults_of(head + "range_noise_m = -0.1\n").find("s.toml:2:17: 'range_noise_m' is -0.1, expected") == 0);
  CHECK(faults_of(head + "detection_floor_db = 10\n") ==
        "s.toml:2:22: 'detection_floor_db' is 10, expected a number in dB, at least -300 and at most 0");
  CHECK(faults_of(head + "penetration_budget_db = -1\n") ==
        "s.toml:2:25: 'penetration_budget_db' is -1, expected a number in dB, at least 0");
  CHECK(faults_of(head + "divergence = \"sides\"\n") == "s.toml:2:14: 'divergence' is 'sides', expected one of 'none', 'side_rays', 'cone'");
  CHECK(faults_of(head + "side_geometry = \"paralel\"\n") ==
        "s.toml:2:17: 'side_geometry' is 'paralel', expected one of 'diverging', 'parallel' (did you mean 'parallel'?)");
  CHECK(faults_of("type = \"lobe_radar\"\nechoes = \"receiver\"\nrange_noise_m = 0.1\n") ==
        "s.toml:3:17: 'range_noise_m' is for traced echoes, expected the 'noise' of the receiver");
  CHECK(faults_of(head + "law = \"printed\"\nsignal = \"iq\"\n") ==
        "s.toml:3:10: 'signal' is 'iq', but the printed law has no phases, expected 'amplitude', or law = 'radar_equation'");
  CHECK(faults_of(head + "first_echo_only = 1\n") == "s.toml:2:19: 'first_echo_only' is an integer, expected true or false");
  CHECK(faults_of(head + "position_m = [0, 0]\n").find("s.toml:2:14: 'position_m' has an array of length 2") == 0);
  CHECK(faults_of(head + "range_min_m = 40\n").find("'range_min_m' is 40, expected less than range_max_m, 30") != std::string::npos);
  CHECK(faults_of(head + "range_min_m = 30\n").find("'range_min_m' is 30, expected less than range_max_m, 30") != std::string::npos);
  CHECK(faults_of("type = \"lidar\"\ndivergence = \"none\"\n") == "s.toml:2:1: unknown key 'divergence' in [[sensor]] of type \"lidar\"");
  // All of them.
  CHECK(lines_in(faults_of(head + "fov_deg = 400\nstep_deg = 0\nrang_max_m = 3\n")) == 3);
}

TEST_CASE("a sensor that is written out reads back the same") {
  std::vector<SensorSpec> specs;
  for (const std::string& type : sensor_types()) specs.push_back(default_sensor(type));
  for (const std::string& preset : sensor_presets()) specs.push_back(read("preset = \"" + preset + "\"").spec);
  for (const SensorSpec& spec : specs) {
    const std::string text = write_section(sensor_section(spec), sensor_object(spec));
    const Reading back = read("type = \"" + std::string(sensor_type(spec)) + "\"\n" + text);
    CHECK(back.faults == "");
    CHECK(back.spec.index() == spec.index());
    CHECK(write_section(sensor_section(back.spec), sensor_object(back.spec)) == text);
  }
}

TEST_CASE("a range noise on top of a preset takes the place of its table") {
  const auto lidar = [](const std::string& text) { return std::get<LidarSpec>(read("preset = \"urg04lx\"\n" + text).spec); };
  CHECK(lidar("").range_noise_table_m.size() == 3);
  CHECK(lidar("range_noise_m = 0.02\n").range_noise_table_m.empty());
  CHECK(lidar("range_noise_m = 0.02\nrange_noise_table_m = [[1.0, 0.01]]\n").range_noise_table_m.size() == 1);
}

TEST_CASE("a ray spacing that takes too many rays is told with their number") {
  const std::string head = "type = \"lobe_radar\"\nrange_max_m = 10\n";
  CHECK(faults_of(head + "ray_spacing_m = 0.2\n") == "");
  CHECK(faults_of(head + "ray_spacing_m = 0.001\n") == "s.toml:3:17: 'ray_spacing_m' takes 11346 rays over 65 deg at range_max_m, expected at most 2000");
}

TEST_CASE("a scan that would not fit into memory is told before it is tried") {
  const std::string head = "type = \"scanning_radar\"\nrange_max_m = 10\n";
  CHECK(faults_of(head + "step_deg = 0.001\n") == "");
  CHECK(faults_of(head + "step_deg = 0.001\ndivergence = \"cone\"\ncone_rays = 10000\n") == "s.toml:1:1: 360000 beams of 10000 rays are more than a scan may have, expected at most 4e+06 rays in all");
  CHECK(faults_of(head + "step_deg = 0.001\nelevation_opening_deg = 20\nelevation_rays = 12\n").find("360000 beams of 12 rays") != std::string::npos);
  CHECK(faults_of("type = \"lobe_radar\"\nazimuth_rays = 2000\nelevation_rays = 2000\n") == "");
  const std::string receiver = head + "step_deg = 0.1\nechoes = \"receiver\"\n";
  CHECK(faults_of(receiver + "bin_size_m = 0.05\n") == "");
  CHECK(faults_of(receiver + "bin_count = 1000000\n") == "s.toml:5:13: 3600 beams of 1e+06 bins are more than a scan may have, expected at most 1e+08 bins in all");
  CHECK(faults_of(receiver + "bin_size_m = 0.0001\n").find("3600 beams of 100001 bins") != std::string::npos);
}

TEST_CASE("keys that would leave nothing to see, or do nothing, are told") {
  const std::string head = "type = \"scanning_radar\"\nrange_max_m = 10\nechoes = \"receiver\"\n";
  CHECK(faults_of(head + "bin_offset_m = 11\n") == "s.toml:4:16: 'bin_offset_m' is 11, so that all bins are beyond range_max_m, 10, expected less");
  CHECK(faults_of(head + "bin_offset_m = 10\n") == "");
  CHECK(faults_of(head + "bin_count = 5\nrange_min_m = 1\n") == "s.toml:4:13: the last bin is at 0.2 m, nearer than range_min_m, 1, expected more or larger bins");
  CHECK(faults_of(head + "first_echo_only = true\n") == "s.toml:4:19: 'first_echo_only' is for traced echoes, expected detection = 'first' with a receiver");
  CHECK(faults_of(head + "elevation_rays = 4\n") ==
        "s.toml:4:18: 'elevation_rays' is 4, but there is no opening to spread them over, expected an 'elevation_opening_deg' above 0");
  CHECK(faults_of(head + "elevation_rays = 4\nelevation_opening_deg = 10\n") == "");
  CHECK(faults_of("type = \"lobe_radar\"\ngain_table_db = [[0, 0], [30, -3]]\n") == "s.toml:2:17: 'gain_table_db' has points, but 'gain' is 'flat', expected gain = 'table'");
  CHECK(faults_of("type = \"lobe_radar\"\ngain = \"table\"\ngain_table_db = [[0, 0], [30, -3]]\n") == "");
  // Single precision ends at 1e38, and the angles of a lobe's cells are squared.
  CHECK(faults_of(head + "threshold = 1e300\n") == "s.toml:4:13: 'threshold' is 1e+300, expected a number, above 0 and at most 1000000");
  CHECK(faults_of("type = \"lobe_radar\"\nazimuth_opening_deg = 1e-200\n").find("'azimuth_opening_deg' is 1e-200, expected a number in deg, at least 0.001 and at most 180") != std::string::npos);
}

TEST_CASE("defaults by type") {
  CHECK(sensor_types() == std::vector<std::string>{"scanning_radar", "lobe_radar", "lidar"});
  for (const std::string& type : sensor_types()) CHECK(std::string(sensor_type(default_sensor(type))) == type);
}

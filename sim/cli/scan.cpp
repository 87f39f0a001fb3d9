// `thicket scan`: what a sensor sees from a pose, or along a way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/scan_report.hpp"

namespace thicket::cli {
namespace {

constexpr const char* example = "thicket scan solids/wall --pose 0,-0.8,0.5,90 --sensor usarsim2012";
constexpr int most_steps = 10000;

/// What is missing, all of it at once.
std::optional<Error> lacking(const ScanArguments& a) {
  std::vector<std::string> lacks;
  if (a.world.empty()) lacks.emplace_back("a world");
  if (a.pose.empty() && a.poses.empty()) lacks.emplace_back("--pose X,Y,Z,YAW_DEG (or --poses FILE.csv)");
  if (a.sensors.empty()) lacks.emplace_back("--sensor NAME (`thicket sensors` lists them)");
  if (!lacks.empty()) return Error{fmt::format("scan lacks {}, for example: {}", fmt::join(lacks, " and "), example)};
  if (!a.poses.empty() && !(a.pose.empty() && a.to.empty() && !a.steps)) return Error{"--poses has all poses in its file: leave --pose, --to and --steps out"};
  if (!a.to.empty() && !a.steps) return Error{fmt::format("--to lacks --steps N, how many scans there are on the way, for example: {} --to 0,1.5,0.5,90 --steps 100", example)};
  if (a.to.empty() && a.steps) return Error{fmt::format("--steps lacks --to X,Y,Z,YAW_DEG, where the way leads, for example: {} --to 0,1.5,0.5,90 --steps 100", example)};
  if (a.steps && (*a.steps < 2 || *a.steps > most_steps)) return Error{fmt::format("--steps is {}, expected 2 to {}", *a.steps, most_steps)};
  if (!a.x_label.empty() && a.poses.empty()) return Error{"--x-label names the column 'label' of a file of poses: give --poses FILE.csv"};
  return std::nullopt;
}

Result<ScanPose> pose_of(const char* flag, const std::string& text) {
  const auto four = numbers<4>(text);
  const auto five = numbers<5>(text);
  ScanPose pose;
  if (four) pose = {{(*four)[0], (*four)[1], (*four)[2]}, (*four)[3], 0.0, {}};
  if (five) pose = {{(*five)[0], (*five)[1], (*five)[2]}, (*five)[3], (*five)[4], {}};
  if (!four && !five) return Error{fmt::format("{} is '{}', expected X,Y,Z,YAW_DEG or X,Y,Z,YAW_DEG,PITCH_DEG in metres and degrees, for example 0,-0.8,0.5,90", flag, text)};
  for (const double value : {pose.position.x, pose.position.y, pose.position.z, pose.yaw_deg, pose.pitch_deg})
    if (std::abs(value) > 1e9) return Error{fmt::format("{} is '{}', expected numbers of at most 1e9", flag, text)};
  return pose;
}

Result<std::vector<ScanPose>> poses_of(const ScanArguments& a) {
  if (!a.poses.empty()) {
    const auto text = read_text_file(a.poses);
    if (!text) return text.error();
    auto poses = read_scan_poses(*text, a.poses);
    if (poses && !a.x_label.empty() && std::any_of(poses->begin(), poses->end(), [](const ScanPose& pose) { return !pose.label; }))
      return Error{fmt::format("{}: there is no column 'label', which --x-label is to name", a.poses)};
    return poses;
  }
  const auto from = pose_of("--pose", a.pose);
  if (!from) return from.error();
  if (a.to.empty()) return std::vector<ScanPose>{*from};
  const auto to = pose_of("--to", a.to);
  if (!to) return to.error();
  return straight_way(*from, *to, *a.steps);
}

/// `--set KEY=VALUE` of all sensors, or `--set SENSOR.KEY=VALUE` of one, by the name that it was given under.
struct Setting {
  std::string sensor;  ///< empty: all of --sensor
  Override change;
};

Result<std::vector<Setting>> settings_of(const ScanArguments& a) {
  std::vector<std::string> names = a.sensors;
  names.insert(names.end(), a.compared.begin(), a.compared.end());
  std::vector<Setting> settings;
  for (const std::string& set : a.sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0) return Error{fmt::format("--set is '{}', expected KEY=VALUE, for example range_max_m=20", set)};
    const std::string key = set.substr(0, equals);
    const auto dot = key.rfind('.');
    Setting setting{dot == std::string::npos ? "" : key.substr(0, dot), {dot == std::string::npos ? key : key.substr(dot + 1), set.substr(equals + 1), "--set " + key}};
    if (!setting.sensor.empty() && std::find(names.begin(), names.end(), setting.sensor) == names.end())
      return Error{fmt::format("--set {}: there is no sensor '{}' on the command line, expected one of '{}'{}", key, setting.sensor, fmt::join(names, "', '"), did_you_mean(setting.sensor, names))};
    settings.push_back(std::move(setting));
  }
  return settings;
}

Result<std::vector<SensorScans>> sensors_of(const ScanArguments& a) {
  const auto settings = settings_of(a);
  if (!settings) return settings.error();
  std::vector<SensorScans> sensors;
  const auto add = [&](const std::string& name, const char* flag, bool for_all) -> std::optional<Error> {
    std::vector<Override> changes;
    std::vector<std::string> words;
    for (const Setting& setting : *settings) {
      if (setting.sensor.empty() ? !for_all : setting.sensor != name) continue;
      changes.push_back(setting.change);
      words.push_back(setting.change.key + "=" + setting.change.value);
    }
    auto spec = find_sensor(name, flag, changes);
    if (!spec) return spec.error();
    if (!a.velocity.empty())  // which is asked for to see what it does
      std::visit([](auto& s) { if constexpr (std::is_base_of_v<RadarSpec, std::decay_t<decltype(s)>>) s.radial_velocity = true; }, *spec);
    const std::string plain = name.ends_with(".toml") ? std::filesystem::path(name).stem().string() : name;
    sensors.push_back({words.empty() ? plain : fmt::format("{} with {}", plain, fmt::join(words, ", ")), std::move(*spec), {}});
    return std::nullopt;
  };
  for (const std::string& name : a.sensors)
    if (auto fault = add(name, "--sensor", true)) return *fault;
  for (const std::string& name : a.compared)
    if (auto fault = add(name, "--compare", false)) return *fault;
  return sensors;
}

/// Files that are read must not be written, and two outputs not into one file.
std::optional<Error> check_outputs(const ScanArguments& a, const std::filesystem::path& world) {
  if (!a.png.empty() && std::filesystem::path(a.png).extension() != ".png") return Error{fmt::format("--png is '{}', expected a name ending in .png", a.png)};
  std::vector<std::string> files;
  for (const std::string& file : {a.csv, a.json, a.profile_csv, a.png}) {
    if (file.empty()) continue;
    if (std::find(files.begin(), files.end(), file) != files.end()) return Error{fmt::format("two outputs go to '{}', expected different ones", file)};
    std::error_code none;
    for (const std::filesystem::path& read : {world, std::filesystem::path(a.poses)})
      if (!read.empty() && std::filesystem::equivalent(file, read, none)) return Error{fmt::format("{}: would be overwritten while it is read, expected another name to write to", file)};
    files.push_back(file);
  }
  return std::nullopt;
}

int write_outputs(const ScanArguments& a, const ScanReport& report) {
  const bool asked = !(a.csv.empty() && a.json.empty() && a.profile_csv.empty() && a.png.empty());
  if (!asked) fmt::print("{}", scan_table(report));
  const bool to_terminal = a.csv == "-" || a.json == "-" || a.profile_csv == "-";
  const auto put = [&](const std::string& file, const auto& text_of) -> Result<Done> {
    if (file.empty()) return Done{};
    const std::string text = text_of(report);
    if (file == "-") {
      fmt::print("{}", text);
      return Done{};
    }
    return write_file(file, text);
  };
  const auto has_bins = [](const SensorScans& one) { return one.scans[0].profiles.bins > 0; };
  if (!a.profile_csv.empty() && std::none_of(report.sensors.begin(), report.sensors.end(), has_bins)) return complain({"--profile-csv: no sensor has a receiver with range bins; a radar gets one by --set 'echoes=\"receiver\"'"});
  for (const auto& written : {put(a.csv, scan_csv), put(a.profile_csv, profile_csv), put(a.json, scan_json), a.png.empty() ? Result<Done>(Done{}) : draw_scans(report, a.png)})
    if (!written) return complain(written.error());
  if (!to_terminal)
    for (const std::string& file : {a.csv, a.profile_csv, a.json, a.png})
      if (!file.empty()) fmt::print("written    {}\n", file);
  return done;
}

}  // namespace

int measure_scans(const ScanArguments& a) {
  if (const auto fault = lacking(a)) return complain(*fault);
  if (!std::isfinite(a.time)) return complain({fmt::format("--time is {}, expected seconds", a.time)});
  if (a.number < 0 || a.number >= (std::int64_t{1} << 40)) return complain({fmt::format("--number is {}, expected 0 to 2^40", a.number)});
  if (a.seed < 0) return complain({fmt::format("--seed is {}, expected at least 0", a.seed)});
  const auto file = find_world(a.world);
  if (!file) return complain(file.error());
  if (const auto fault = check_outputs(a, *file)) return complain(*fault);
  auto poses = poses_of(a);
  if (!poses) return complain(poses.error());
  auto sensors = sensors_of(a);
  if (!sensors) return complain(sensors.error());
  ScanReport report{a.world, std::move(*poses), std::move(*sensors), a.x_label, static_cast<std::uint64_t>(a.number), a.time, a.seed, {}};
  if (!a.velocity.empty()) {
    const auto v = numbers<3>(a.velocity);
    if (!v) return complain({fmt::format("--velocity is '{}', expected VX,VY,VZ in metres per second, for example 1,0,0", a.velocity)});
    report.velocity = {(*v)[0], (*v)[1], (*v)[2]};
  }
  MapOptions options;
  options.image = a.map_image;
  options.cell_size = a.cell_size;
  auto world = read_world(*file, options);
  if (!world) return complain(world.error());
  const auto scene = Scene::build(std::move(*world));
  if (!scene) return complain(scene.error());
  measure(*scene, report);
  return write_outputs(a, report);
}

}  // namespace thicket::cli

#include "thicket/sim/scan_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <type_traits>

#include <glm/geometric.hpp>

#include "overrides.hpp"
#include "scan_figures.hpp"
#include "thicket/base/text.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket {
namespace {

/// The column names of a file of poses, the needed ones first.
const std::vector<std::string> pose_columns = {"x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "label"};
constexpr std::size_t needed_columns = 4, most_poses = 10000;

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, comma);
    while (!field.empty() && (field.front() == ' ' || field.front() == '\t')) field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\t' || field.back() == '\r')) field.remove_suffix(1);
    fields.push_back(field);
    if (comma == line.size()) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || stop != text.data() + text.size() || !(std::abs(value) <= 1e9)) return std::nullopt;
  return value;
}

void place(ScanPose& pose, std::size_t column, double value) {
  switch (column) {
    case 0: pose.position.x = value; break;
    case 1: pose.position.y = value; break;
    case 2: pose.position.z = value; break;
    case 3: pose.yaw_deg = value; break;
    case 4: pose.pitch_deg = value; break;
    default: pose.label = value; break;
  }
}

/// Which of `pose_columns` each field of the header is.
Result<std::vector<std::size_t>> read_head(const std::vector<std::string_view>& fields, const std::string& where) {
  std::vector<std::size_t> order;
  for (const std::string_view field : fields) {
    const auto found = std::find(pose_columns.begin(), pose_columns.end(), field);
    if (found == pose_columns.end())
      return Error{fmt::format("{}: there is no column '{}', expected a header of '{}'{}", where, field, fmt::join(pose_columns, "', '"), did_you_mean(field, pose_columns))};
    const auto column = static_cast<std::size_t>(found - pose_columns.begin());
    if (std::find(order.begin(), order.end(), column) != order.end()) return Error{fmt::format("{}: the column '{}' is there twice", where, field)};
    order.push_back(column);
  }
  for (std::size_t i = 0; i < needed_columns; ++i)
    if (std::find(order.begin(), order.end(), i) == order.end()) return Error{fmt::format("{}: the header lacks '{}', expected x_m,y_m,z_m,yaw_deg[,pitch_deg][,label]", where, pose_columns[i])};
  return order;
}

}  // namespace

Result<SensorSpec> find_sensor(const std::string& name, const std::string& flag, const std::vector<Override>& changes) {
  Node entry;
  entry.content = Node::Table{{"preset", text_node(name, flag)}};
  entry.place = entry.key_place = {flag, 0, 0};
  for (const Override& change : changes) member(entry, change.key) = override_value(change);
  Faults faults;
  SensorSpec spec = read_sensor(entry, faults);
  if (!faults.none()) return faults.error();
  return spec;
}

Pose ScanPose::pose() const {
  const double yaw = 0.5 * radians(yaw_deg), pitch = 0.5 * radians(pitch_deg);
  return {position, glm::dquat(std::cos(yaw), 0.0, 0.0, std::sin(yaw)) * glm::dquat(std::cos(pitch), 0.0, std::sin(pitch), 0.0)};
}

std::vector<ScanPose> straight_way(const ScanPose& from, const ScanPose& to, int count) {
  std::vector<ScanPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t = count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
    // What does not change stays the same to the last bit.
    poses.push_back({from.position + t * (to.position - from.position), from.yaw_deg + t * (to.yaw_deg - from.yaw_deg), from.pitch_deg + t * (to.pitch_deg - from.pitch_deg), {}});
  }
  return poses;
}

Result<std::vector<ScanPose>> read_scan_poses(std::string_view csv, const std::string& name) {
  std::vector<std::size_t> order;
  std::vector<ScanPose> poses;
  if (csv.starts_with("\xef\xbb\xbf")) csv.remove_prefix(3);  // spreadsheets write it
  for (int number = 1; !csv.empty(); ++number) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    const auto fields = fields_of(line);
    if ((fields.size() == 1 && fields[0].empty()) || line.starts_with('#')) continue;
    const std::string where = fmt::format("{}:{}", name, number);
    if (order.empty()) {
      auto head = read_head(fields, where);
      if (!head) return head.error();
      order = std::move(*head);
      continue;
    }
    if (fields.size() != order.size()) return Error{fmt::format("{}: the line has {} values, expected {} as in the header", where, fields.size(), order.size())};
    ScanPose pose;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto value = number_of(fields[i]);
      if (!value) return Error{fmt::format("{}: '{}' is '{}', expected a number of at most 1e9", where, pose_columns[order[i]], fields[i])};
      place(pose, order[i], *value);
    }
    poses.push_back(pose);
    if (poses.size() > most_poses) return Error{fmt::format("{}: more than {} poses, expected at most that", where, most_poses)};
  }
  if (order.empty()) return Error{fmt::format("{}: the file is empty, expected a header x_m,y_m,z_m,yaw_deg[,pitch_deg][,label] and a line for each pose", name)};
  if (poses.empty()) return Error{fmt::format("{}: no pose comes after the header, expected a line for each", name)};
  return poses;
}

void measure(const Scene& world, ScanReport& report) {
  Scene scene = world;  // shares all but the poses of what moves
  scene.set_time(report.time);
  for (SensorScans& one : report.sensors) {
    SensorSpec spec = one.spec;
    MountedSpec& mount = mounted(spec);
    mount.position_m = {0.0, 0.0, 0.0};
    mount.yaw_deg = mount.pitch_deg = mount.roll_deg = 0.0;
    const auto sensor = make_sensor(spec, 0);
    const Random random(static_cast<std::uint64_t>(report.seed), 0);
    one.scans.assign(report.poses.size(), Scan{});
    for (std::size_t i = 0; i < report.poses.size(); ++i)
      sensor->measure(scene, Platform(report.poses[i].pose(), report.velocity, {}), report.time, report.number + i, random, one.scans[i]);
  }
}

std::string describe_sensor(const SensorSpec& spec) {
  std::string text = sensor_type(spec);
  if (const auto* radar = std::get_if<ScanningRadarSpec>(&spec)) text += fmt::format(", {:g} GHz", radar->frequency_ghz);
  if (const auto* lobe = std::get_if<LobeRadarSpec>(&spec))
    text += fmt::format(", {:g} GHz, a lobe of {:g} x {:g} deg", lobe->frequency_ghz, lobe->azimuth_opening_deg, lobe->elevation_opening_deg);
  if (const ScannerSpec* scan = scanner(spec)) text += fmt::format(", {:g} deg in steps of {:g} deg", scan->fov_deg, scan->step_deg);
  const MountedSpec& common = mounted(spec);
  return text + fmt::format(", {:g} to {:g} m", common.range_min_m, common.range_max_m);
}

// --- figures

const char* to_string(Edge edge) {
  constexpr std::array words = {"front", "inner", "back", "thin"};
  return words[static_cast<std::size_t>(edge)];
}

const char* to_string(BeamEnd end) {
  constexpr std::array words = {"open", "stopped", "exhausted"};
  return words[static_cast<std::size_t>(end)];
}

bool measures_velocity(const SensorSpec& spec) {
  return std::visit([](const auto& s) {
    if constexpr (std::is_base_of_v<RadarSpec, std::decay_t<decltype(s)>>) return s.radial_velocity;
    return false;
  }, spec);
}

ScanFigures figures_of(const Scan& scan) {
  ScanFigures figures;
  figures.echoes = scan.echoes.size();
  for (const Echo& echo : scan.echoes) {
    if (!figures.first || echo.range < figures.first->range) figures.first = &echo;
    if (!figures.strongest || echo.amplitude > figures.strongest->amplitude) figures.strongest = &echo;
    figures.power += static_cast<double>(echo.amplitude) * echo.amplitude;
  }
  if (scan.profiles.bins > 0 && !scan.profiles.amplitude.empty()) {
    const auto top = std::max_element(scan.profiles.amplitude.begin(), scan.profiles.amplitude.end());
    figures.top_range = scan.profiles.range(static_cast<std::uint32_t>(static_cast<std::size_t>(top - scan.profiles.amplitude.begin()) % scan.profiles.bins));
    figures.top_amplitude = *top;
  }
  return figures;
}

std::vector<Top> strongest_tops(const Profiles& profiles, std::size_t beam, std::size_t most) {
  std::vector<Top> tops;
  const auto amplitude = profiles.amplitude_of(beam);
  for (std::size_t i = 0; i < amplitude.size(); ++i) {
    if (!(amplitude[i] > 0.0f) || (i > 0 && amplitude[i] <= amplitude[i - 1]) || (i + 1 < amplitude.size() && amplitude[i] < amplitude[i + 1])) continue;
    tops.push_back({profiles.range(static_cast<std::uint32_t>(i)), amplitude[i], profiles.threshold.empty() ? 0.0 : profiles.threshold_of(beam)[i]});
  }
  std::stable_sort(tops.begin(), tops.end(), [](const Top& a, const Top& b) { return a.amplitude > b.amplitude; });
  if (tops.size() > most) tops.resize(most);
  return tops;
}

std::vector<double> way_lengths(const std::vector<ScanPose>& poses) {
  std::vector<double> ways;
  for (std::size_t i = 0; i < poses.size(); ++i) ways.push_back(i == 0 ? 0.0 : ways.back() + glm::distance(poses[i - 1].position, poses[i].position));
  return ways;
}

WayAxis way_axis(const ScanReport& report) {
  const auto& poses = report.poses;
  WayAxis axis{report.label_name, {}};
  const auto differs = [&](auto value) { return std::any_of(poses.begin(), poses.end(), [&](const ScanPose& pose) { return value(pose) != value(poses.front()); }); };
  const auto yaw = [](const ScanPose& pose) { return pose.yaw_deg; };
  const auto pitch = [](const ScanPose& pose) { return pose.pitch_deg; };
  if (!report.label_name.empty()) {
    for (const ScanPose& pose : poses) axis.values.push_back(pose.label.value_or(0.0));
  } else if (auto ways = way_lengths(poses); ways.back() > 0.0) {
    axis = {"way, m", std::move(ways)};
  } else if (differs(yaw) != differs(pitch)) {
    axis.label = differs(yaw) ? "yaw, deg" : "pitch, deg";
    for (const ScanPose& pose : poses) axis.values.push_back(differs(yaw) ? pose.yaw_deg : pose.pitch_deg);
  } else {
    axis.label = "scan";
    for (std::size_t i = 0; i < poses.size(); ++i) axis.values.push_back(static_cast<double>(report.number + i));
  }
  return axis;
}

}  // namespace thicket

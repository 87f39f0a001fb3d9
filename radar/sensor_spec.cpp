#include "thicket/radar/sensor_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

template <class S>
SectionOf<S> scanner_section(const char* type, const char* help) {
  SectionOf<S> section(fmt::format("[[sensor]] of type \"{}\"", type), help);
  section.key("name", &S::name, "name of the sensor, for --set and for outputs")
      .key("rate_hz", &S::rate_hz, "Hz", above_up_to(0.0, 1e4), "scans per second")
      .key("position_m", &S::position_m, "m", between(-100.0, 100.0), "where it sits on the vehicle: forward, left, up from the ground")
      .key("yaw_deg", &S::yaw_deg, "deg", between(-360.0, 360.0), "where its x axis points on the vehicle, counter-clockwise from forward")
      .key("fov_deg", &S::fov_deg, "deg", above_up_to(0.0, 360.0), "sector that it scans, centred on its x axis")
      .key("step_deg", &S::step_deg, "deg", between(0.001, 180.0), "angle between beams")
      .key("range_min_m", &S::range_min_m, "m", between(0.0, 1e5), "nearer echoes are not seen")
      .key("range_max_m", &S::range_max_m, "m", above_up_to(0.0, 1e5), "farther echoes are not seen")
      .key("range_noise_m", &S::range_noise_m, "m", between(0.0, 1e6), "standard deviation of the range, one draw per beam and scan");
  return section;
}

SectionOf<ScanningRadarSpec> radar_section() {
  using S = ScanningRadarSpec;
  auto section = scanner_section<S>("scanning_radar", "the penetrating scanning radar of Rozeboom 2012");
  section.key("frequency_ghz", &S::frequency_ghz, "GHz", between(0.3, 300.0), "at which the numbers of materials are taken")
      .key("penetration_budget_db", &S::penetration_budget_db, "dB", or_infinite(at_least(0.0)), "loss inside matter, one way, after which a ray is exhausted")
      .key("detection_floor_db", &S::detection_floor_db, "dB", between(-300.0, 0.0), "power under which nothing is seen; 0 dB is a perfect reflector at normal incidence")
      .key("first_echo_only", &S::first_echo_only, "keep only the first echo of each beam, as if it could not see through anything")
      .choice("divergence", &S::divergence, {"none", "side_rays"}, "beam divergence; side_rays: each beam is its middle, left or right ray, by equal chance")
      .key("side_offset_m", &S::side_offset_m, "m", between(0.0, 1e3), "N of the 2012 text: how far a side ray is off the beam's middle")
      .choice("side_geometry", &S::side_geometry, {"diverging", "parallel"}, "side rays from the same origin, N off at range_max_m; or N off everywhere");
  return section;
}

SectionOf<LidarSpec> lidar_section() {
  auto section = scanner_section<LidarSpec>("lidar", "a laser scanner: it sees the first surface that stops light, or as deep into smoke as its light gets");
  section.key("optical_depth_max", &LidarSpec::optical_depth_max, "", or_infinite(above(0.0)),
              "optical depth (extinction x path, one way) at which a ray ends inside a medium; at 1, light is down by e^-2 there and back; inf sees through every medium");
  return section;
}

std::string preset_folder() { return (shipped_root() / "radar" / "presets").string(); }

/// Presets may build on one another; deeper than this they do so without end.
constexpr int deepest_preset = 8;

SensorSpec read_sensor_at(const Node& entry, Faults& faults, int depth);

/// Reads `preset` into a spec; the entry's own keys come on top of it. Nothing if there is no such preset.
std::optional<SensorSpec> read_preset(const Node& preset, Faults& faults, int depth) {
  const auto* name = std::get_if<std::string>(&preset.content);
  if (!name) {
    faults.add(preset.place, fmt::format("'preset' is {}, expected a text in quotes", preset.kind_in_words()));
    return std::nullopt;
  }
  if (depth > deepest_preset) {
    faults.add(preset.place, fmt::format("'preset' is '{}', which builds on itself, expected another one", *name));
    return std::nullopt;
  }
  std::filesystem::path file = std::filesystem::path(preset_folder()) / (*name + ".toml");
  if (!std::filesystem::exists(file)) file = *name;
  if (!std::filesystem::is_regular_file(file)) {
    const auto known = sensor_presets();
    faults.add(preset.place, fmt::format("there is no sensor preset '{}', expected one of '{}' or a file{}", *name, fmt::join(known, "', '"), did_you_mean(*name, known)));
    return std::nullopt;
  }
  const auto document = read_document(file);
  if (!document) {
    faults.take(document.error());
    return std::nullopt;
  }
  return read_sensor_at(*document, faults, depth + 1);
}

}  // namespace

const std::vector<std::string>& sensor_types() {
  static const std::vector<std::string> types = {"scanning_radar", "lidar"};
  return types;
}

const char* sensor_type(const SensorSpec& spec) { return sensor_types()[spec.index()].c_str(); }

SensorSpec default_sensor(const std::string& type) {
  if (type == "lidar") return LidarSpec{};
  return ScanningRadarSpec{};
}

const Section& sensor_section(const SensorSpec& spec) {
  static const Section radar = radar_section(), lidar = lidar_section();
  return std::holds_alternative<LidarSpec>(spec) ? lidar : radar;
}

namespace {

SensorSpec read_sensor_at(const Node& entry, Faults& faults, int depth) {
  SensorSpec spec = ScanningRadarSpec{};
  const Node* type = entry.find("type");
  const Node* preset = entry.find("preset");
  if (preset) {
    auto read = read_preset(*preset, faults, depth);
    if (!read) return spec;  // told already; which keys there are is not known
    spec = std::move(*read);
  }
  if (type) {
    const auto* word = std::get_if<std::string>(&type->content);
    const auto& known = sensor_types();
    if (!word || std::find(known.begin(), known.end(), *word) == known.end()) {
      faults.add(type->place, fmt::format("'type' is {}, expected one of '{}'{}", word ? "'" + *word + "'" : type->kind_in_words(), fmt::join(known, "', '"),
                                          word ? did_you_mean(*word, known) : ""));
    } else if (!preset) {
      spec = default_sensor(*word);
    } else if (*word != sensor_type(spec)) {
      faults.add(type->place, fmt::format("'type' is '{}', but the preset is of type '{}': leave one of them out", *word, sensor_type(spec)));
    }
  } else if (!preset) {
    faults.add(entry.place, fmt::format("[[sensor]] lacks 'type' or 'preset', expected a type of '{}', or a preset of '{}'", fmt::join(sensor_types(), "', '"),
                                        fmt::join(sensor_presets(), "', '")));
  }
  read_section(entry, sensor_section(spec), sensor_object(spec), faults, {"type", "preset"});
  const ScannerSpec& common = scanner(spec);
  if (common.range_min_m >= common.range_max_m)
    faults.add(entry.place, fmt::format("'range_min_m' is {}, expected less than range_max_m, {}", common.range_min_m, common.range_max_m));
  return spec;
}

}  // namespace

SensorSpec read_sensor(const Node& entry, Faults& faults) { return read_sensor_at(entry, faults, 0); }

std::vector<std::string> sensor_presets() { return shipped_names("radar/presets"); }

}  // namespace thicket

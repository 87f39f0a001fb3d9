// Scan reports as JSON, in a file of its own: the library takes long to compile.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "scan_figures.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: what is not finite is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json triple(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json keys_of(const SensorSpec& spec) {
  Json json = Json::object();
  for (const Key& key : sensor_section(spec).keys) {
    const Value value = key.get(sensor_object(spec));
    std::visit([&](const auto& content) {
      using Content = std::decay_t<decltype(content)>;
      if constexpr (std::is_same_v<Content, double>) {
        json[key.name] = number(content);
      } else if constexpr (!std::is_same_v<Content, std::monostate>) {
        json[key.name] = content;
      }
    }, value);
  }
  return json;
}

Json json_of(const Echo& echo, bool velocity) {
  Json json = {{"range_m", echo.range},
               {"amplitude", number(echo.amplitude)},
               {"power_db", number(to_db(echo.amplitude))},
               {"incidence_deg", degrees(std::acos(std::clamp(static_cast<double>(echo.incidence_cosine), 0.0, 1.0)))},
               {"edge", to_string(echo.edge)},
               {"bounces", echo.bounces}};
  if (velocity) json["radial_velocity_m_s"] = number(echo.radial_velocity);
  return json;
}

Json json_of(const Scan& scan, std::size_t beam, bool velocity) {
  const Beam& b = scan.beams[beam];
  Json json = {{"azimuth_deg", degrees(b.azimuth)}, {"elevation_deg", degrees(b.elevation)}, {"end", to_string(b.end)}, {"sensed_range_m", number(b.sensed_range)}, {"starts_inside", b.starts_inside}};
  json["echoes"] = Json::array();
  for (const Echo& echo : scan.echoes_of(b)) json["echoes"].push_back(json_of(echo, velocity));
  const Profiles& p = scan.profiles;
  if (p.bins == 0) return json;
  const auto part = [&](const auto& list, auto value_of) {
    Json values = Json::array();
    for (std::size_t i = beam * p.bins; i < (beam + 1) * p.bins; ++i) values.push_back(number(value_of(list[i])));
    return values;
  };
  const auto same = [](float value) { return value; };
  json["amplitude"] = part(p.amplitude, same);
  if (!p.threshold.empty()) json["threshold"] = part(p.threshold, same);
  if (!p.iq.empty()) {
    json["i"] = part(p.iq, [](const std::complex<float>& value) { return value.real(); });
    json["q"] = part(p.iq, [](const std::complex<float>& value) { return value.imag(); });
  }
  return json;
}

Json json_of(const Scan& scan, const ScanPose& pose, bool velocity) {
  Json json;
  json["number"] = scan.number;
  json["pose"] = {{"position_m", triple(pose.position)}, {"yaw_deg", pose.yaw_deg}, {"pitch_deg", pose.pitch_deg}};
  if (pose.label) json["pose"]["label"] = *pose.label;
  json["rays"] = scan.rays;
  if (scan.profiles.bins > 0) json["bins"] = {{"count", scan.profiles.bins}, {"first_range_m", scan.profiles.first_range}, {"size_m", scan.profiles.bin_size}};
  json["beams"] = Json::array();
  for (std::size_t b = 0; b < scan.beams.size(); ++b) json["beams"].push_back(json_of(scan, b, velocity));
  return json;
}

}  // namespace

std::string scan_json(const ScanReport& report) {
  Json json;
  json["world"] = report.world;
  json["time_s"] = report.time;
  json["velocity_m_s"] = triple(report.velocity);
  json["sensors"] = Json::array();
  for (const SensorScans& one : report.sensors) {
    Json sensor = {{"sensor", one.name}, {"type", sensor_type(one.spec)}, {"keys", keys_of(one.spec)}};
    sensor["scans"] = Json::array();
    for (std::size_t i = 0; i < one.scans.size(); ++i) sensor["scans"].push_back(json_of(one.scans[i], report.poses[i], measures_velocity(one.spec)));
    json["sensors"].push_back(std::move(sensor));
  }
  json["seed"] = report.seed;
  json["version"] = version();
  return json.dump(1) + "\n";
}

}  // namespace thicket

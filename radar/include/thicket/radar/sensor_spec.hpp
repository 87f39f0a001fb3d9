// A sensor as a mission file describes it: plain data in the file's units, and the schema of its keys.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <glm/vec3.hpp>

#include "thicket/base/document.hpp"
#include "thicket/base/schema.hpp"

namespace thicket {

/// What every scanning sensor has. Its beams lie in the plane of its frame.
struct ScannerSpec {
  std::string name = "sensor";
  double rate_hz = 10.0;
  glm::dvec3 position_m{0.0, 0.0, 0.3};  ///< in the vehicle's frame
  double yaw_deg = 0.0;
  double fov_deg = 360.0;   ///< sector, centred on the sensor's x axis
  double step_deg = 1.0;    ///< between beams
  double range_min_m = 0.0;
  double range_max_m = 30.0;
  double range_noise_m = 0.0;  ///< standard deviation
};

/// The penetrating scanning radar of Rozeboom 2012.
struct ScanningRadarSpec : ScannerSpec {
  double frequency_ghz = 24.0;  ///< at which materials are evaluated; the 2012 text names radars of 24 and 94 GHz
  double penetration_budget_db = 10.0;  ///< loss inside matter, one way, after which a ray is exhausted
  double detection_floor_db = -60.0;    ///< power under which the receiver sees nothing, against a perfect reflector at normal incidence
  bool first_echo_only = false;
  std::string divergence = "none";       ///< "none" | "side_rays"
  double side_offset_m = 0.2;            ///< N of the 2012 text
  std::string side_geometry = "diverging";  ///< "diverging": common origin, offset N at range_max | "parallel": offset N at the sensor
};

/// A laser scanner: the first surface that stops light, or as deep in a medium as light gets.
struct LidarSpec : ScannerSpec {
  double optical_depth_max = 1.0;  ///< one way, at which a ray ends inside media; on its way there and back light then is down by e^(-2 optical_depth_max)
};

using SensorSpec = std::variant<ScanningRadarSpec, LidarSpec>;

inline const ScannerSpec& scanner(const SensorSpec& spec) {
  return std::visit([](const auto& s) -> const ScannerSpec& { return s; }, spec);
}

/// "scanning_radar", "lidar": the values of the key `type`.
const std::vector<std::string>& sensor_types();
const char* sensor_type(const SensorSpec& spec);
SensorSpec default_sensor(const std::string& type);

/// The keys of a sensor of the type of `spec`.
const Section& sensor_section(const SensorSpec& spec);
inline const void* sensor_object(const SensorSpec& spec) {
  return std::visit([](const auto& s) -> const void* { return &s; }, spec);
}
inline void* sensor_object(SensorSpec& spec) {
  return std::visit([](auto& s) -> void* { return &s; }, spec);
}

/// Reads a [[sensor]] entry: `type` or `preset` (the name of a file in radar/presets, or a path), then the keys of that type.
SensorSpec read_sensor(const Node& entry, Faults& faults);

/// Names of the presets that are shipped.
std::vector<std::string> sensor_presets();

}  // namespace thicket

// Single measurements: sensors at poses, and what they saw as a table, as CSV, as JSON and as a picture. `thicket scan` is made of this.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/result.hpp"
#include "thicket/radar/sensor_spec.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// A sensor by its name (a shipped preset) or file, with changes to its keys. Faults of a sensor that there is none of name `flag`.
Result<SensorSpec> find_sensor(const std::string& name, const std::string& flag, const std::vector<Override>& changes = {});

/// Where a sensor stands: its own frame in the world.
struct ScanPose {
  glm::dvec3 position{0.0};  ///< m
  double yaw_deg = 0.0;
  double pitch_deg = 0.0;       ///< nose down (REP 103)
  std::optional<double> label;  ///< a number of the caller's own, to draw over

  Pose pose() const;
};

/// `count` poses on the straight way from one to another, both included; angles turn evenly.
std::vector<ScanPose> straight_way(const ScanPose& from, const ScanPose& to, int count);

/// Reads CSV with a header of x_m, y_m, z_m, yaw_deg, and perhaps pitch_deg and label, in any order. `name` stands in messages.
Result<std::vector<ScanPose>> read_scan_poses(std::string_view csv, const std::string& name);

/// One sensor and what it measured, a scan for each pose.
struct SensorScans {
  std::string name;  ///< as it is to be called in titles and legends
  SensorSpec spec;
  std::vector<Scan> scans;
};

struct ScanReport {
  std::string world;
  std::vector<ScanPose> poses;
  std::vector<SensorScans> sensors;
  std::string label_name;     ///< of the poses' labels, with unit, if these are to be drawn over: "tilt, deg"
  std::uint64_t number = 0;   ///< of the first scan; it goes up by one with each pose
  double time = 0.0;          ///< s; moving solids stand still at it
  std::int64_t seed = 1;
  glm::dvec3 velocity{0.0};   ///< of the sensor, m/s in the world
};

/// Measures with every sensor at every pose. Each measures as if it were the only sensor of a mission; where specs place it on a vehicle is left out.
void measure(const Scene& scene, ScanReport& report);

/// For a person: what each beam saw; on a way, a line for each pose.
std::string scan_table(const ScanReport& report);

/// A row for each echo; on a way, a row for each pose. With several sensors, the first column names the sensor.
std::string scan_csv(const ScanReport& report);

/// A row for each range bin of each beam. Empty if no sensor has a receiver.
std::string profile_csv(const ScanReport& report);

/// All of it: poses, the sensors' keys, beams, echoes and profiles.
std::string scan_json(const ScanReport& report);

/// PNG. One pose: a polar plot of a scanning sensor, amplitude over range for few beams; a way: range over way, and the strongest echo over way.
Result<Done> draw_scans(const ScanReport& report, const std::filesystem::path& file);

/// What a sensor is, in a few words with units: "scanning_radar, 24 GHz, 360 deg in steps of 1 deg, 0 to 30 m".
std::string describe_sensor(const SensorSpec& spec);

}  // namespace thicket

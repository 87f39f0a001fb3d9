// Missions: everything that a run depends on, as a file describes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "thicket/base/document.hpp"
#include "thicket/base/result.hpp"
#include "thicket/nav/bumper.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "thicket/nav/planner.hpp"
#include "thicket/radar/sar.hpp"
#include "thicket/radar/sensor_spec.hpp"
#include "thicket/sim/odometry.hpp"
#include "thicket/sim/vehicle.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

struct StartSpec {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_deg = 0.0;
};

struct LimitSpec {
  double time_s = 3600.0;
  std::optional<double> distance_m;
  double stuck_s = 30.0;
};

struct OutputSpec {
  bool trajectory = true;
  bool map = true;
  bool picture = true;
  bool path_picture = true;
  std::string map_formats;  ///< besides map.pgm and map.yaml: names of `map_format_names`, separated by commas
  bool score = false;
  std::optional<glm::dvec4> observed_region_m;
};

/// A mission; every member has its place in the schema.
struct Mission {
  std::string name = "mission";
  std::string description;
  std::string world;             ///< as written
  std::optional<double> world_cell_size_m;  ///< for a MovingAI world
  std::string world_image;       ///< for a map_server world: an image instead of the one that it names
  double world_height_m = 2.5;   ///< for a map_server world
  bool world_unknown_is_matter = true;
  std::int64_t seed = 1;
  double step_s = 0.05;
  std::string fidelity = "auto";  ///< how much of the physics: see fidelity.hpp

  VehicleSpec vehicle;
  StartSpec start;
  std::vector<SensorSpec> sensors;
  BumperSpec bumpers;
  PlannerSpec planner;
  OdometrySpec odometry;
  MapSpec map;
  SarSpec sar;
  LimitSpec limits;
  OutputSpec output;

  std::filesystem::path world_file;   ///< where `world` was found
  std::filesystem::path image_file;   ///< where `world_image` was found, or empty
  std::filesystem::path initial_map_file;  ///< where `map.initial` was found, or empty
};

/// One change to a mission's file before it is read: `--set key=value`, or a flag that stands for it.
struct Override {
  std::string key;     ///< "planner.clearance_m", "seed", "sensor.range_max_m" (all sensors), "sensor.NAME.range_max_m"
  std::string value;   ///< TOML; what is not valid TOML is taken as a text
  std::string origin;  ///< for messages: "--set planner.clearance_m"
};

/// Reads a mission file (found as `find_input` does), with changes on top. An empty path starts from the defaults. A mission without a [[sensor]] gets the preset
/// `usarsim2012`. Paths are relative to the mission file, then to what is shipped; in an override, to the working directory.
Result<Mission> read_mission(const std::filesystem::path& file, const std::vector<Override>& overrides);

/// A TOML file that names a world, a planner or a sensor is a mission; others are worlds. A file that cannot be parsed is none.
bool is_mission(const std::filesystem::path& file);

/// A mission as a file with every key, that reads back to the same mission from anywhere.
std::string write_mission(const Mission& mission);

/// All sections, keys, units, ranges, defaults: `thicket help mission`.
std::string describe_mission_file();

/// Which sensors drive the bumpers, as places in `sensors`, in order: those that `bumpers.sensors` names; without names the first, and if that is a lobe radar all lobe radars. Never empty. Names
/// that no sensor has are passed over; `read_mission` complains of them.
std::vector<std::size_t> bumper_sensors(const Mission& mission);

/// The formats that `output.map_formats` may name: scale, raw, npy, ot, bt, picture.
const std::vector<std::string>& map_format_names();

/// Those that it does name, in the order of `map_format_names`, each once.
std::vector<std::string> map_formats(const OutputSpec& output);

/// Reads the world that a mission names.
Result<World> read_mission_world(const Mission& mission);

/// Names of the vehicle presets that are shipped.
std::vector<std::string> vehicle_presets();

}  // namespace thicket

// A sensor as a mission file describes it: plain data in the file's units, and the schema of its keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/document.hpp"
#include "thicket/base/schema.hpp"

namespace thicket {

/// What every sensor has: a name, a rate, a place on the vehicle, and how far it sees.
struct MountedSpec {
  std::string name = "sensor";
  double rate_hz = 10.0;
  glm::dvec3 position_m{0.0, 0.0, 0.3};  ///< in the vehicle's frame
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;  ///< turned by roll first, then pitch (nose down), then yaw (REP 103)
  double range_min_m = 0.0;
  double range_max_m = 30.0;
  double range_noise_m = 0.0;  ///< standard deviation
};

/// What every scanning sensor has. Its beams lie in the x-y plane of its frame.
struct ScannerSpec : MountedSpec {
  double fov_deg = 360.0;   ///< sector, centred on the sensor's x axis
  double step_deg = 1.0;    ///< between beams
};

/// How a radar's wave goes out, meets matter and comes back.
struct RadarSpec {
  double frequency_ghz = 24.0;  ///< at which materials are evaluated; the 2012 text names radars of 24 and 94 GHz
  std::string law = "radar_equation";  ///< | "printed": eq. 4.2 of Billdal 2018
  bool range_compensation = true;      ///< the receiver's gain makes up for the 1/R^2 of a wall (sensitivity-time control)
  double penetration_budget_db = 10.0;  ///< loss inside matter, one way, after which a ray is exhausted
  double detection_floor_db = -60.0;    ///< power under which a ray is not followed, against a perfect diffuse reflector that fills the beam squarely (at range_max_m, without compensation)
  std::string scattering = "material";  ///< "material": by its roughness | "lambert": everything is diffuse
  bool fresnel = true;          ///< what a dielectric reflects depends on the angle
  double slab_max_m = 0.1;      ///< thickness up to which a solid in the open is one slab (ITU-R P.2040)
  bool excess_range = false;    ///< the wave is slower in matter, and what is behind seems farther
  bool statistical_foliage = false;  ///< crowns (materials with leaves_per_m) are leaves at random places
  std::string surfaces = "auto";     ///< "auto": of each ray only what the world can show | "all": every surface and mirror is looked for, whether there is one or not
  std::int64_t bounces_max = 1;      ///< surfaces that a wave may meet on its way out; 1: no multipath
  bool radial_velocity = false;
  std::string sampling = "regular";  ///< | "jitter": rays at random places in their cells, others in each scan
};

/// From returns to range bins to detections.
struct ReceiverSpec {
  std::string echoes = "traced";  ///< "traced": what the rays met, without a receiver | "receiver": what it detects
  std::int64_t bin_count = 0;     ///< 0: as many as range_max_m takes
  double bin_size_m = 0.05;
  double bin_offset_m = 0.0;      ///< range of the middle of the first bin
  double bandwidth_ghz = 0.0;     ///< at -10 dB, of a Gaussian pulse; 0: a pulse no longer than a bin
  std::string signal = "amplitude";  ///< | "iq"
  std::optional<double> noise;    ///< standard deviation per bin (per component of I/Q); without it, what gives false_alarm_rate at the threshold
  double noise_walk = 0.0;        ///< of a random walk from bin to bin: standard deviation of a step
  std::int64_t smoothing_bins = 1;   ///< moving average
  double clutter_floor = 0.0;     ///< amplitude in every bin, its power is added
  double saturation = std::numeric_limits<double>::infinity();  ///< amplitude
  std::string detector = "threshold";  ///< | "ca_cfar"
  double threshold = 0.038;       ///< amplitude
  double false_alarm_rate = 1e-6; ///< per bin
  std::int64_t cfar_training_bins = 16, cfar_guard_bins = 4;  ///< on either side
  std::string detection = "first";     ///< "first" top above the threshold | "strongest" | "all"
  bool floor_gate = false;        ///< raise the threshold to what the ground would return
};

/// A scanning radar; that of Rozeboom 2012 with everything left out.
struct ScanningRadarSpec : ScannerSpec, RadarSpec, ReceiverSpec {
  double elevation_opening_deg = 0.0;   ///< 0: the plane alone
  std::int64_t elevation_rays = 1;      ///< rows of rays over the opening
  bool first_echo_only = false;
  std::string divergence = "none";       ///< "none" | "side_rays" | "cone"
  double side_offset_m = 0.2;            ///< N of the 2012 text
  std::string side_geometry = "diverging";  ///< "diverging": common origin, offset N at range_max | "parallel": offset N at the sensor
  std::string side_choice = "equal";     ///< "equal" chances | "incidence": chances by its cosine | "strongest" | "sum"
  double cone_opening_deg = 2.0;         ///< full width of the cone
  std::int64_t cone_rays = 7;
};

/// A fixed antenna with a wide opening, as the X4M05 of Billdal 2018. Its lobe looks along the x axis of its frame.
struct LobeRadarSpec : MountedSpec, RadarSpec, ReceiverSpec {
  double azimuth_opening_deg = 65.0, elevation_opening_deg = 65.0;  ///< full
  std::int64_t azimuth_rays = 58, elevation_rays = 58;
  std::string rows = "auto";              ///< "auto": one row of rays stands for all where the world is the same at every height | "one": jittered rows too | "all": each is traced
  std::optional<double> ray_spacing_m;   ///< at range_max_m, instead of the numbers of rays: Billdal 2018, eq. 4.4
  std::string section = "square";        ///< | "elliptic"
  std::string gain = "flat";             ///< | "gaussian" | "table"
  std::optional<glm::dvec2> gain_width_deg;   ///< azimuth, elevation: one-way -3 dB width of a Gaussian; without it the opening
  std::vector<glm::dvec2> gain_table_db;      ///< (angle off the axis in degrees, one-way gain in dB), by angle

  LobeRadarSpec() { range_compensation = false; }
};

/// A laser scanner: the first surface that stops light, or as deep in a medium as light gets.
struct LidarSpec : ScannerSpec {
  double optical_depth_max = 1.0;  ///< one way, at which a ray ends inside media; on its way there and back light then is down by e^(-2 optical_depth_max)
  std::vector<glm::dvec2> range_noise_table_m;  ///< (range, standard deviation) by range, straight between; if given, instead of range_noise_m
};

using SensorSpec = std::variant<ScanningRadarSpec, LobeRadarSpec, LidarSpec>;

inline const MountedSpec& mounted(const SensorSpec& spec) {
  return std::visit([](const auto& s) -> const MountedSpec& { return s; }, spec);
}
inline MountedSpec& mounted(SensorSpec& spec) {
  return std::visit([](auto& s) -> MountedSpec& { return s; }, spec);
}
/// What a scanning sensor has; nothing of a lobe.
inline const ScannerSpec* scanner(const SensorSpec& spec) {
  if (const auto* radar = std::get_if<ScanningRadarSpec>(&spec)) return radar;
  return std::get_if<LidarSpec>(&spec);
}

/// "scanning_radar", "lobe_radar", "lidar": the values of the key `type`.
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

#include "thicket/sim/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "thicket/nav/altitude.hpp"
#include "thicket/sim/travel.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

/// Solids by what is wrong with them: "3 solids ('a', 'b', ...)".
std::string name_some(const std::vector<std::string>& names) {
  std::string text = fmt::format("{} solid{} (", names.size(), names.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < names.size() && i < 3; ++i) text += fmt::format("{}'{}'", i ? ", " : "", names[i]);
  return text + (names.size() > 3 ? ", ...)" : ")");
}

/// The sensor whose scans the planner decides on; the first of those that drive the bumpers.
const Sensor& deciding_sensor(const Simulation& simulation) { return *simulation.stage().sensors[simulation.stage().bumper_sensors.front()]; }
const SensorSpec& deciding_spec(const Simulation& simulation) { return simulation.mission().sensors[simulation.stage().bumper_sensors.front()]; }

/// Of all directions, how many degrees the sensors that drive the bumpers see together.
double seen_degrees(const Simulation& simulation) {
  Coverage coverage;
  coverage.begin();
  for (const std::size_t i : simulation.stage().bumper_sensors) {
    const SensorSpec& spec = simulation.mission().sensors[i];
    const double opening = scanner(spec) ? scanner(spec)->fov_deg : std::get<LobeRadarSpec>(spec).azimuth_opening_deg;
    for (double off = 0.25 - 0.5 * opening; off < 0.5 * opening; off += 0.5) coverage.note(wrap_angle(radians(mounted(spec).yaw_deg + off)));
  }
  coverage.finish();
  double seen = 360.0;
  for (const Coverage::Gap& gap : coverage.gaps()) seen -= degrees(gap.width) - 0.5;  // a gap is told from the middle of one half degree to that of another
  return std::round(seen);
}

void warn_of_stealth(const Simulation& simulation, std::vector<std::string>& warnings) {
  const Mission& mission = simulation.mission();
  const World& world = simulation.stage().scene.world();
  const Sensor& sensor = deciding_sensor(simulation);
  const Hull hull = mission.vehicle.hull();
  const auto grounds = travel_heights(mission);
  const auto* radar = std::get_if<ScanningRadarSpec>(&deciding_spec(simulation));
  const bool looks_along_plane = scanner(deciding_spec(simulation)) && (!radar || radar->elevation_opening_deg == 0.0);
  std::map<std::string, std::vector<std::string>> undetected;  // material -> solids
  std::map<double, std::vector<std::string>> off_plane;         // height of the plane -> solids
  for (const Solid& solid : world.solids) {
    const Material& material = world.materials[solid.material];
    bool met = false;
    std::optional<double> missed;  // the height of a plane that has not, or much less, of it
    for (const double ground : grounds) {
      const double meets_hull = half_width_between(solid, ground + hull.z_low, ground + hull.z_high), plane = ground + sensor.spec().position_m.z;
      // What only carries the hull, a floor, is not in its way.
      if (!material.stops_motion || meets_hull <= 0.0 || extent(solid).high.z <= ground + hull.z_low) continue;
      met = true;
      if (!missed && meets_hull - half_width_between(solid, plane, plane) > 0.5 * mission.planner.clearance_m) missed = plane;
    }
    if (met && !sensor.detects(material)) undetected[material.name].push_back(solid.name);
    else if (met && looks_along_plane && missed) off_plane[*missed].push_back(solid.name);
  }
  for (const auto& [material, solids] : undetected)
    warnings.push_back(fmt::format("{} of material '{}' stop motion but would not be detected by sensor '{}': {}",
                                   name_some(solids), material, sensor.spec().name,
                                   std::holds_alternative<LidarSpec>(deciding_spec(simulation)) ? "set the material's stops_light, or use a radar"
                                                                                               : "raise the material's reflectivity or lower the sensor's detection_floor_db"));
  for (const auto& [plane, solids] : off_plane)
    warnings.push_back(fmt::format("{} reach into the hull's heights but not, or much less, into the plane of sensor '{}' at z = {:.2f} m: they would not be seen in time; change "
                                   "the sensor's position_m",
                                   name_some(solids), sensor.spec().name, plane));
}

/// What the sensor that drives the bumpers cannot see in time, whatever it is made of.
void warn_of_blindness(const Simulation& simulation, std::vector<std::string>& warnings) {
  const Mission& mission = simulation.mission();
  const MountedSpec& sensor = deciding_sensor(simulation).spec();
  const ScannerSpec* scanning = scanner(deciding_spec(simulation));
  const double radius = mission.vehicle.radius_m, press = simulation.bumpers().press_distance();
  const double speed = std::min(mission.vehicle.speed_max_m_s, mission.planner.speed_m_s.value_or(mission.vehicle.speed_max_m_s));
  const double rate = std::min(sensor.rate_hz, 1.0 / mission.step_s);
  for (const SensorSpec& spec : mission.sensors)
    if (mounted(spec).rate_hz * mission.step_s > 1.0 + 1e-9)
      warnings.push_back(fmt::format("sensor '{}' is to scan at {} Hz, but there is one scan a step at most, {:g} Hz: make step_s smaller", mounted(spec).name, mounted(spec).rate_hz, 1.0 / mission.step_s));
  if (sensor.range_max_m < radius + press)
    warnings.push_back(fmt::format("sensor '{}' sees {} m far, but a bumper must be pressed {:.2f} m from the robot's axis to keep the clearance: make range_max_m longer", sensor.name, sensor.range_max_m, radius + press));
  if (sensor.range_min_m > radius)
    warnings.push_back(fmt::format("sensor '{}' sees nothing nearer than {} m, which is outside the hull: make range_min_m shorter", sensor.name, sensor.range_min_m));
  const double seen_deg = seen_degrees(simulation);
  if (seen_deg < 360.0 && planner_needs(mission.planner.name) != PlannerNeeds::waypoints)
    warnings.push_back(fmt::format("what drives the bumpers (sensor '{}') sees {} of 360 degrees: the planner '{}' follows boundaries beside and behind it and may run into what it does not see", sensor.name, seen_deg, mission.planner.name));
  if (speed / rate > mission.planner.clearance_m)
    warnings.push_back(fmt::format("the robot drives {:.2f} m between two scans, more than the clearance of {} m", speed / rate, mission.planner.clearance_m));
  if (!scanning) return;
  const double spacing = radians(scanning->step_deg) * (radius + mission.planner.clearance_m);
  std::vector<std::string> thin;
  for (const Solid& solid : simulation.stage().scene.world().solids) {
    const auto* box = std::get_if<Box>(&solid.shape);
    const double width = box ? std::max(box->size.x, box->size.y) : 2.0 * half_width_between(solid, -infinity, infinity);
    if (width < spacing && simulation.stage().scene.world().materials[solid.material].stops_motion) thin.push_back(solid.name);
  }
  if (!thin.empty())
    warnings.push_back(fmt::format("{}: narrower than the {:.3f} m between the beams of sensor '{}' at the clearance, may be missed: make step_deg smaller", name_some(thin), spacing, sensor.name));
}

}  // namespace

std::vector<std::string> mission_warnings(const Simulation& simulation) {
  std::vector<std::string> warnings;
  const Mission& mission = simulation.mission();
  warn_of_stealth(simulation, warnings);
  warn_of_blindness(simulation, warnings);
  const double at_start = simulation.clearance().distance;
  if (at_start <= 0.0) warnings.push_back("the hull touches matter at the start: the run will end at once, collided");
  if (at_start < mission.planner.clearance_m && at_start > 0.0)
    warnings.push_back(fmt::format("the start is {:.2f} m from matter, nearer than the clearance of {} m", at_start, mission.planner.clearance_m));
  const auto warn_of_target = [&](const glm::dvec2& target, double z, const std::string& what) {
    const Clearance there = simulation.stage().scene.clearance(mission.vehicle.hull(), {target, z}, mission.planner.clearance_m);
    if (there.distance <= 0.0)
      warnings.push_back(fmt::format("{} is where the hull would touch '{}': it cannot be reached", what, simulation.stage().scene.world().solids[there.solid].name));
    else if (there.distance < mission.planner.clearance_m)
      warnings.push_back(fmt::format("{} is {:.2f} m from '{}', nearer than the clearance of {} m: the planner may not get there", what, there.distance,
                                     simulation.stage().scene.world().solids[there.solid].name, mission.planner.clearance_m));
  };
  if (planner_needs(mission.planner.name) == PlannerNeeds::goal && mission.planner.goal_m) warn_of_target(*mission.planner.goal_m, travel_heights(mission).front(), "the goal");
  if (mission.planner.name == "waypoints") {
    const auto altitudes = waypoint_altitudes(mission.planner, mission.start.z_m);
    for (std::size_t i = 0; i < altitudes.size(); ++i) warn_of_target(mission.planner.waypoints_m[i], mission.vehicle.flies() ? altitudes[i] : mission.start.z_m, fmt::format("way-point {}", i + 1));
  }
  return warnings;
}

std::string describe_scene(const Scene& scene) {
  const World& world = scene.world();
  const SceneFigures figures = scene.figures();
  std::string text = fmt::format("world      {}\n", world.name);
  if (!world.source.empty()) text += fmt::format("source     {}\n", world.source);
  static constexpr std::array shapes = {"boxes", "spheres", "cylinders", "walls", "maps", "prisms", "meshes"};
  std::array<std::size_t, std::variant_size_v<Shape>> counts{};
  for (const Solid& solid : world.solids) ++counts[solid.shape.index()];
  std::vector<std::string> kinds;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) kinds.push_back(fmt::format("{} {}", counts[i], shapes[i]));
  text += fmt::format("solids     {}{}{}\n", world.solids.size(), kinds.empty() ? "" : ": ", fmt::join(kinds, ", "));
  text += fmt::format("traced     {} convex parts, {} triangles, {} instances, {} moving\n", figures.parts, figures.triangles, figures.instances, figures.moving);
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const Material& material = world.materials[m];
    const auto users = std::count_if(world.solids.begin(), world.solids.end(), [m](const Solid& s) { return s.material == m; });
    text += fmt::format("material   {:<12} {:>4} solids, reflectivity {:.4g}, {:.4g} dB/m{}, {} light, {} motion\n", material.name, users, material.reflectivity,
                        material.attenuation_db_per_m, material.depends_on_frequency() ? " at 1 GHz" : "", material.stops_light ? "stops" : "passes", material.stops_motion ? "stops" : "passes");
  }
  if (world.bounds) text += fmt::format("bounds     x {:.2f} to {:.2f}, y {:.2f} to {:.2f} m\n", world.bounds->x, world.bounds->z, world.bounds->y, world.bounds->w);
  if (const auto box = extent(world))
    text += fmt::format("extent     x {:.2f} to {:.2f}, y {:.2f} to {:.2f}, z {:.2f} to {:.2f} m\n", box->low.x, box->high.x, box->low.y, box->high.y, box->low.z, box->high.z);
  text += fmt::format("memory     {:.1f} MB in the ray tracer\nbuilt in   {:.1f} ms\n", static_cast<double>(figures.memory_bytes) / 1e6, 1e3 * figures.build_s);
  for (const std::string& notice : world.notices) text += fmt::format("notice: {}\n", notice);
  return text;
}

std::vector<std::string> stealth_warnings(const World& world, const Sensor& sensor) {
  std::map<std::string, std::vector<std::string>> undetected;
  for (const Solid& solid : world.solids)
    if (const Material& material = world.materials[solid.material]; material.stops_motion && !sensor.detects(material)) undetected[material.name].push_back(solid.name);
  std::vector<std::string> warnings;
  for (const auto& [material, solids] : undetected)
    warnings.push_back(fmt::format("{} of material '{}' stop motion but lie below the detection floor of sensor '{}': a robot that relies on it would run into them", name_some(solids), material,
                                   sensor.spec().name));
  return warnings;
}

}  // namespace thicket

#include "thicket/sim/fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

/// A number of rays: one stays one, since it stands for a direction and not for a grid.
std::int64_t scaled(std::int64_t rays, const std::string& fidelity) {
  if (rays <= 1) return rays;
  return fidelity == "reference" ? 2 * rays : std::min(rays, std::max<std::int64_t>(8, rays / 2));
}

void scale_rays(LobeRadarSpec& lobe, const std::string& fidelity) {
  if (lobe.ray_spacing_m) *lobe.ray_spacing_m *= fidelity == "reference" ? 0.5 : 2.0;
  lobe.azimuth_rays = scaled(lobe.azimuth_rays, fidelity);
  lobe.elevation_rays = scaled(lobe.elevation_rays, fidelity);
  lobe.rows = fidelity == "reference" ? "all" : "one";
}
void scale_rays(ScanningRadarSpec& radar, const std::string& fidelity) {
  radar.elevation_rays = scaled(radar.elevation_rays, fidelity);
  radar.cone_rays = scaled(radar.cone_rays, fidelity) * (fidelity == "reference" && radar.cone_rays > 1 ? 2 : 1);
}

template <class Radar>
void change(Radar& radar, const std::string& fidelity) {
  scale_rays(radar, fidelity);
  if (fidelity == "reference") {
    radar.surfaces = "all";
  } else {
    radar.bounces_max = 1;
    radar.fresnel = false;
  }
}
void change(LidarSpec&, const std::string&) {}

std::string list(const std::vector<PhysicsPart>& parts, bool modelled) {
  std::string text;
  for (const PhysicsPart& part : parts)
    if (part.modelled == modelled) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", part.name, part.why);
  return text.empty() ? "nothing" : text;
}

}  // namespace

SensorSpec at_fidelity(SensorSpec spec, const std::string& fidelity) {
  if (fidelity != "auto") std::visit([&](auto& s) { change(s, fidelity); }, spec);
  return spec;
}

VehicleSpec at_fidelity(VehicleSpec spec, const std::string& fidelity) {
  if (spec.model == "auto" && fidelity != "auto") spec.model = fidelity == "fast" ? "kinematic" : "rigid_body";
  return spec;
}

RunModel model_of(const Simulation& simulation) {
  const Mission& mission = simulation.mission();
  RunModel model;
  for (const auto& sensor : simulation.stage().sensors) model.sensors.push_back({sensor->spec().name, sensor->model_of(simulation.scene(), simulation.platform())});
  if (mission.vehicle.flies()) model.others.push_back({"six degrees of freedom", simulation.stage().flight.rigid_body, simulation.stage().flight.reason});
  model.others.push_back({"moving solids", simulation.scene().moves(), simulation.scene().moves() ? "the world has some" : "nothing moves"});
  model.others.push_back({"drift of odometry", !mission.odometry.perfect(), mission.odometry.perfect() ? "the keys of [odometry] ask for none" : "asked for"});
  model.others.push_back({"map", mission.map.enabled, mission.map.enabled ? fmt::format("store {}, cells of {} m", mission.map.store, mission.map.resolution_m) : "[map] enabled = false"});
  return model;
}

std::string describe(const RunModel& model) {
  // Four lobes are told once.
  std::vector<std::pair<std::string, std::string>> told;  // what, of whom
  for (const SensorModel& sensor : model.sensors) {
    const std::string what = fmt::format("models {}; leaves out {}", list(sensor.parts, true), list(sensor.parts, false));
    const auto same = std::ranges::find(told, what, &std::pair<std::string, std::string>::first);
    if (same != told.end()) same->second += ", " + sensor.sensor;
    else told.emplace_back(what, sensor.sensor);
  }
  std::string text;
  for (const auto& [what, of_whom] : told) text += fmt::format("{} {}. ", of_whom, what);
  return text + fmt::format("The run models {}; leaves out {}.", list(model.others, true), list(model.others, false));
}

}  // namespace thicket

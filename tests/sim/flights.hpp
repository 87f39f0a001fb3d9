// Flights that tests make.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "finished.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/flight.hpp"

namespace thicket {

inline VehicleSpec quadrotor() {
  VehicleSpec spec;
  spec.type = "quadrotor";
  spec.radius_m = 0.402;
  spec.height_m = 0.2;
  spec.speed_max_m_s = 10.0;
  spec.turn_acceleration_deg_s2 = 360.0;
  return spec;
}

/// A flight by itself: one short-sighted sensor, no map.
inline Mission flight(const glm::dvec3& start) {
  Mission mission;
  mission.vehicle = quadrotor();
  mission.vehicle.model = "kinematic";
  mission.start = {start.x, start.y, start.z, 0.0};
  mission.step_s = 0.01;
  LidarSpec blind;
  blind.range_max_m = 0.01;
  blind.position_m = {0.0, 0.0, 0.1};  // in the hull: above it, it could be in what the hull flies under
  mission.sensors = {blind};
  mission.map.enabled = false;
  mission.planner.name = "waypoints";
  mission.planner.clearance_m = 0.01;
  mission.planner.speed_m_s = 1.0;
  mission.planner.waypoints_m = {{start.x, start.y, 1.0}};
  return mission;
}

inline World world_of(Shape shape, const glm::dvec3& position) {
  World world;
  Material material;
  material.name = "wall";
  world.materials.push_back(material);
  world.solids.push_back({"thing", 0, position, 0.0, std::move(shape)});
  return world;
}

inline Simulation flown(const Mission& mission, World world) {
  auto simulation = Simulation::create(mission, std::move(world));
  if (!simulation) FAIL(simulation.error().message);
  while (simulation->step()) {
  }
  return *simulation;
}

/// Flies by hand until something is touched, or for some seconds.
inline Simulation driven(const Mission& mission, World world, const Command& command, double seconds) {
  auto simulation = Simulation::create(mission, std::move(world));
  if (!simulation) FAIL(simulation.error().message);
  REQUIRE_FALSE(simulation->verdict());
  simulation->drive(command);
  while (simulation->time() < seconds && simulation->step()) {
  }
  return *simulation;
}

inline Command climbing(double rate) {
  Command command;
  command.climb = rate;
  return command;
}

inline Mission shipped(const char* name, const std::vector<Override>& overrides = {}) {
  auto mission = read_mission(find_input(name), overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

inline std::string verdict(const Simulation& simulation) { return simulation.verdict() ? to_string(simulation.verdict()->kind) : "running"; }

}  // namespace thicket

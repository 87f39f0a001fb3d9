// What a person should know of a world or a mission before it runs.
#pragma once

#include <string>
#include <vector>

#include "thicket/sim/simulation.hpp"

namespace thicket {

/// Warnings, a sentence each: matter that stops motion and would not be detected by the sensor that drives the bumpers, because of its reflectivity or because
/// the plane of the sensor passes above or below it; a start inside the clearance; a goal in matter or in its clearance.
std::vector<std::string> mission_warnings(const Simulation& simulation);

/// Of a world by itself: matter that stops motion and lies below the detection floor of a sensor, at any height.
std::vector<std::string> stealth_warnings(const World& world, const Sensor& sensor);

/// A few lines about a world: solids by shape, what is traced, materials, bounds, extent, memory, time to build, and the notices of its reader.
std::string describe_scene(const Scene& scene);

}  // namespace thicket

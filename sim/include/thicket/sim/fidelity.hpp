// How much of the physics a run models: what its scene requires, less, or all there is.
#pragma once

#include <string>
#include <vector>

#include "thicket/radar/sensor.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket {

class Simulation;

/// A sensor under a fidelity. "auto": as its keys say; what a scene does not show is left out, which changes nothing. "reference": nothing is left out, and lobes, cones and rows have twice as many rays each way. "fast": half as many each way (8 at
/// least), no multipath, one row of jittered rays too, and interfaces that reflect as much at any angle.
SensorSpec at_fidelity(SensorSpec spec, const std::string& fidelity);

/// The vehicle's model under a fidelity, where the mission leaves it open: "fast" flies by the kinematic one, "reference" the rigid body.
VehicleSpec at_fidelity(VehicleSpec spec, const std::string& fidelity);

/// What a run models and leaves out.
struct SensorModel {
  std::string sensor;
  std::vector<PhysicsPart> parts;
};
struct RunModel {
  std::vector<SensorModel> sensors;
  std::vector<PhysicsPart> others;  ///< the vehicle, the map, moving solids, odometry
};
RunModel model_of(const Simulation& simulation);

/// The same as a paragraph.
std::string describe(const RunModel& model);

}  // namespace thicket

// Vehicles: how commands become motion.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/nav/planner.hpp"
#include "thicket/sim/flight.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// The keys of [vehicle]: a differential drive or a quadrotor, with the hull of an upright cylinder. Defaults: Pioneer P3-AT (sim/presets/p3at.toml has the sources).
struct VehicleSpec : FlightSpec {
  std::string name = "p3at";
  std::string type = "differential_drive";  ///< or "quadrotor"
  double radius_m = 0.356;
  double height_m = 0.277;
  double ground_clearance_m = 0.0;
  double speed_max_m_s = 0.7;
  double turn_rate_max_deg_s = 140.0;
  double acceleration_m_s2 = 0.3;
  double deceleration_m_s2 = 0.3;
  double turn_acceleration_deg_s2 = 100.0;

  bool flies() const { return type == "quadrotor"; }
  Hull hull() const { return {radius_m, ground_clearance_m, ground_clearance_m + height_m}; }
  VehicleLimits limits(double decision_period) const {
    return {radius_m, speed_max_m_s, radians(turn_rate_max_deg_s), deceleration_m_s2, radians(turn_acceleration_deg_s2), decision_period, std::nullopt};
  }
};
const Section& vehicle_section();

/// Motion at constant speed and turn rate: an arc of a circle (or a straight line), in closed form.
struct Arc {
  Pose2 start;
  double speed = 0.0;      ///< m/s
  double turn_rate = 0.0;  ///< rad/s

  Pose2 at(double time) const;
};

/// A differential drive. Speeds follow the command within the limits of acceleration; within a step they are constant, and the arc is integrated exactly.
struct DifferentialDrive {
  Pose2 pose;
  double speed = 0.0;      ///< m/s
  double turn_rate = 0.0;  ///< rad/s

  /// Takes the new speeds and returns the arc of the next `dt` seconds; the pose stays, `pose = arc.at(t)` moves it.
  Arc step(const Command& command, double dt, const VehicleSpec& limits);
};

/// Where a vehicle is and how it moves: in the plane as a differential drive has it (`speed` is forward), and in space. One that does not fly keeps the height of its start.
struct Vehicle : DifferentialDrive {
  double z = 0.0;            ///< m
  glm::dvec3 velocity{0.0};  ///< m/s, in the world; of one that flies, as all below
  glm::dquat attitude{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 rates{0.0};     ///< rad/s, about the body axes
  Unrest unrest;
  bool on_floor = false;

  FlightState flight() const { return {{pose.position, z}, velocity, attitude, rates}; }
  /// Takes over a state in space; pose, speed and turn rate follow.
  void take(const FlightState& state);
  /// m/s, leftward.
  double lateral() const { return glm::dot(glm::dvec2(velocity), direction(pose.yaw + 0.5 * pi)); }
  /// The part of the attitude that is not heading: the robot knows it.
  glm::dquat tilt() const;
};

}  // namespace thicket

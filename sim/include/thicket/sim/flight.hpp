// The quadrotor: its keys, and how commands become motion in space. docs/quadrotor.md tells the formulas and what was measured.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

struct VehicleSpec;
struct Command;

inline constexpr double gravity = 9.80665;  // m/s^2, standard

/// The keys of [vehicle] that only a quadrotor heeds. Defaults: hector_quadrotor (sim/presets/hector_quadrotor.toml has the sources).
struct FlightSpec {
  std::string model = "auto";                        ///< "kinematic" | "rigid_body" | "auto": see `choose_flight_model`
  double mass_kg = 1.477;
  glm::dvec3 inertia_kg_m2{0.01152, 0.01152, 0.0218};  ///< about the body axes
  double thrust_max_n = 30.0;                        ///< of all rotors
  double tilt_max_deg = 45.0;
  std::vector<double> drag = {0.3};                  ///< N per m/s against the air, along the body axes; one for all or three
  double velocity_time_s = 0.3;                      ///< first-order response of the velocity
  double climb_rate_max_m_s = 5.0;                   ///< up and down
  double landing_speed_max_m_s = 0.5;                ///< onto the floor; faster is a collision
  double altitude_gain_1_s = 0.8;                    ///< climb rate asked for per metre of altitude error
  std::optional<double> velocity_gain_1_s;           ///< rigid body: acceleration per velocity error; not given: 1 / velocity_time_s
  double attitude_gain_1_s2 = 400.0;                 ///< rigid body: angular acceleration per radian of attitude error
  double attitude_rate_gain_1_s = 36.0;              ///< rigid body: the same per rad/s
  double yaw_rate_gain_1_s = 8.0;                    ///< rigid body: angular acceleration per error of the yaw rate
  glm::dvec3 wind_m_s{0.0};                          ///< of the air, in the world
  double gust_m_s = 0.0;                             ///< standard deviation of each component (Ornstein-Uhlenbeck)
  double gust_time_s = 2.0;                          ///< correlation time
  double jitter_m_s = 0.0;                           ///< the same on the commanded velocity, as of a hand that flies
  double jitter_time_s = 0.5;

  glm::dvec3 drag_axes() const { return drag.size() == 3 ? glm::dvec3(drag[0], drag[1], drag[2]) : glm::dvec3(drag.empty() ? 0.0 : drag[0]); }
};

/// Which model runs, and why.
struct FlightModel {
  bool rigid_body = false;
  std::string reason;
};

/// What the keys say, or for "auto": the kinematic model, unless the air moves (wind_m_s, gust_m_s), or taking up the cruising speed `speed` (m/s) takes more than 15 degrees of tilt (or tilt_max_deg does not allow it): speed / velocity_time_s
/// is then the acceleration that the attitude must first turn to, and the kinematic model has it at once.
FlightModel choose_flight_model(const VehicleSpec& spec, double speed);

/// What is wrong with the keys for a step of `step` s, in words that tell what to do; nothing if they can fly. Of the rigid body: a closed loop that is not stable, or not with RK4 at this step.
std::optional<std::string> vehicle_fault(const VehicleSpec& spec, const FlightModel& model, double step);

/// The longest step, s, at which RK4 keeps each eigenvalue of the rigid body's closed loop about hovering inside its region of stability, |1 + z + z^2/2 + z^3/6 + z^4/24| <= 1 with z = eigenvalue * step (Hairer and Wanner, "Solving
/// ordinary differential equations II", IV.2); 0: the loop itself is not stable.
double longest_stable_step(const VehicleSpec& spec);

/// A coordinate and how fast it changes.
struct Coordinate {
  double position = 0.0, velocity = 0.0;
};
/// A constant velocity `wanted` for `time` s, with a response of the first order of time constant `lag` and an acceleration of at most `limit`, in closed form.
Coordinate first_order(const Coordinate& begin, double wanted, double lag, double limit, double time);

/// How an altitude is held: the climb rate that is asked for is gain * (target - altitude), at most `rate_max`.
struct AltitudeHold {
  double target = 0.0, gain = 0.8, rate_max = 5.0, lag = 0.3;
  double up_max = 5.0, down_max = 5.0;  ///< m/s^2
};
/// In closed form too: it is piecewise linear, and the pieces are joined where one ends (to 1e-14 s).
Coordinate hold_altitude(const Coordinate& begin, const AltitudeHold& hold, double time);

/// A quadrotor in space. The pose is that of its centre of mass's foot point: the body turns about it, the hull does not tilt.
struct FlightState {
  glm::dvec3 position{0.0};  ///< m; z above the floor, which is at z = 0
  glm::dvec3 velocity{0.0};  ///< m/s, in the world
  glm::dquat attitude{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 rates{0.0};     ///< rad/s, about the body axes
};

/// Forces on a rigid body: thrust along its z axis in N, torques about its axes in N m.
struct Wrench {
  double thrust = 0.0;
  glm::dvec3 torque{0.0};
};
/// A step of the rigid body by RK4 (Newton and Euler; drag linear, against air that moves with `wind`). The quaternion is normalised at the end.
FlightState rigid_body_step(const FlightState& now, const VehicleSpec& spec, const glm::dvec3& wind, const std::function<Wrench(const FlightState&)>& wrench, double step);

/// roll, pitch, yaw, rad: turned by roll first, then pitch, then yaw (REP 103).
glm::dvec3 roll_pitch_yaw(const glm::dquat& attitude);

/// The motion within a step as contact sees it: the cubic with the positions and velocities of both ends. Off the true way by at most dt^4 / 384 times its fourth derivative: below a micrometre at 50 ms.
struct FlightPath {
  glm::dvec3 points[4];  ///< of the cubic's control polygon
  double duration = 0.0;

  static FlightPath between(const FlightState& begin, const FlightState& end, double duration);
  glm::dvec3 at(double time) const;
  /// At no time faster than this, in the plane and vertically, m/s.
  double speed_bound() const;
  double climb_bound() const;
};

/// Air and hand, which are random: Ornstein-Uhlenbeck processes, sampled exactly (Gillespie, "Exact numerical simulation of the Ornstein-Uhlenbeck process and its integral", Physical Review E 54, 1996, eq. 1.9).
struct Unrest {
  glm::dvec3 gust{0.0}, jitter{0.0};  ///< m/s

  void advance(const FlightSpec& spec, std::uint64_t seed, std::uint64_t step_number, double step);
};

/// The state after `step` seconds of free flight under a command (in the frame of the heading). `turn_rate` is the yaw rate that the vehicle's limits allow now, rad/s.
FlightState fly(const FlightState& now, const Command& command, double turn_rate, const Unrest& unrest, const VehicleSpec& spec, bool rigid_body, double step);

}  // namespace thicket

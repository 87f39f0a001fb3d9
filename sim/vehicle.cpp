#include "thicket/sim/vehicle.hpp"

#include <algorithm>

namespace thicket {

const Section& vehicle_section() {
  using S = VehicleSpec;
  static const Section section =
      SectionOf<S>("[vehicle]", "a differential drive or a quadrotor; `preset` (a name from sim/presets, or a file) sets all keys, the others come on top")
          .key("name", &S::name, "what it is called")
          .choice("type", &S::type, {"differential_drive", "quadrotor"}, "how it moves. The keys from `model` on are of a quadrotor")
          .key("radius_m", &S::radius_m, "m", above_up_to(0.0, 100.0), "radius of the hull, an upright cylinder about the axis it turns on")
          .key("height_m", &S::height_m, "m", above_up_to(0.0, 100.0), "height of the hull")
          .key("ground_clearance_m", &S::ground_clearance_m, "m", between(0.0, 100.0), "what is lower than this passes under the hull")
          .key("speed_max_m_s", &S::speed_max_m_s, "m/s", above_up_to(0.0, 1e3), "forward speed, at most; of a quadrotor in any horizontal direction")
          .key("turn_rate_max_deg_s", &S::turn_rate_max_deg_s, "deg/s", above_up_to(0.0, 3600.0), "turn rate, at most")
          .key("acceleration_m_s2", &S::acceleration_m_s2, "m/s^2", above_up_to(0.0, 1e3), "gaining speed; a quadrotor has velocity_time_s")
          .key("deceleration_m_s2", &S::deceleration_m_s2, "m/s^2", above_up_to(0.0, 1e3), "losing speed; of a quadrotor: what planners count on when they brake")
          .key("turn_acceleration_deg_s2", &S::turn_acceleration_deg_s2, "deg/s^2", above_up_to(0.0, 36000.0), "gaining or losing turn rate")
          .choice("model", &S::model, {"auto", "kinematic", "rigid_body"}, "kinematic: the velocity follows in closed form, tilt as its acceleration needs it; rigid_body: six degrees of freedom and an attitude controller; auto: kinematic, unless there is wind, or the speed takes more than 15 degrees of tilt to get up to")
          .key("mass_kg", &S::mass_kg, "kg", above_up_to(0.0, 1e3), "mass")
          .key("inertia_kg_m2", &S::inertia_kg_m2, "kg m^2", above_up_to(0.0, 1e3), "moments of inertia about the body axes x, y, z")
          .key("thrust_max_n", &S::thrust_max_n, "N", above_up_to(0.0, 1e5), "thrust of all rotors, at most")
          .key("tilt_max_deg", &S::tilt_max_deg, "deg", above_up_to(0.0, 80.0), "tilt, at most: the acceleration in the plane is at most g tan of it")
          .key("drag", &S::drag, "N s/m", between(0.0, 1e3), "drag force per speed against the air: one number, or three along the body axes")
          .lengths(1, 3)
          .key("velocity_time_s", &S::velocity_time_s, "s", between(0.01, 100.0), "time in which the velocity takes up 63 % of a change that is commanded")
          .key("climb_rate_max_m_s", &S::climb_rate_max_m_s, "m/s", above_up_to(0.0, 1e3), "climbing and sinking, at most")
          .key("landing_speed_max_m_s", &S::landing_speed_max_m_s, "m/s", above_up_to(0.0, 1e3), "a floor that is met faster is a collision, and no landing")
          .key("altitude_gain_1_s", &S::altitude_gain_1_s, "1/s", above_up_to(0.0, 100.0), "altitude controller: climb rate asked for per metre of error; up to 1 / (4 velocity_time_s) it does not overshoot")
          .key("velocity_gain_1_s", &S::velocity_gain_1_s, "1/s", above_up_to(0.0, 100.0), "rigid body, velocity controller: acceleration asked for per m/s of error; not given: 1 / velocity_time_s")
          .key("attitude_gain_1_s2", &S::attitude_gain_1_s2, "1/s^2", above_up_to(0.0, 1e6), "rigid body, attitude controller: angular acceleration per radian of error")
          .key("attitude_rate_gain_1_s", &S::attitude_rate_gain_1_s, "1/s", above_up_to(0.0, 1e4), "rigid body, attitude controller: angular acceleration per rad/s")
          .key("yaw_rate_gain_1_s", &S::yaw_rate_gain_1_s, "1/s", above_up_to(0.0, 1e4), "rigid body: angular acceleration per rad/s of error of the yaw rate")
          .key("wind_m_s", &S::wind_m_s, "m/s", between(-100.0, 100.0), "velocity of the air, x, y, z")
          .key("gust_m_s", &S::gust_m_s, "m/s", between(0.0, 100.0), "gusts: standard deviation of each component of the wind (an Ornstein-Uhlenbeck process)")
          .key("gust_time_s", &S::gust_time_s, "s", above_up_to(0.0, 1e4), "correlation time of gusts")
          .key("jitter_m_s", &S::jitter_m_s, "m/s", between(0.0, 100.0), "a hand that flies: standard deviation of what is added to each component of the commanded velocity, likewise")
          .key("jitter_time_s", &S::jitter_time_s, "s", above_up_to(0.0, 1e4), "its correlation time");
  return section;
}

Pose2 Arc::at(double time) const {
  const double turn = turn_rate * time, way = speed * time;
  // The chord of the arc: 2 r sin(turn/2) = way * sin(h)/h with h = turn/2, in the direction of the middle heading.
  const double half = 0.5 * turn;
  const double chord = way * (std::abs(half) < 1e-8 ? 1.0 : std::sin(half) / half);
  return {start.position + chord * direction(start.yaw + half), wrap_angle(start.yaw + turn)};
}

Arc DifferentialDrive::step(const Command& command, double dt, const VehicleSpec& limits) {
  const double wanted = std::clamp(command.speed, -limits.speed_max_m_s, limits.speed_max_m_s);
  const bool faster = std::abs(wanted) > std::abs(speed);
  const double change = (faster ? limits.acceleration_m_s2 : limits.deceleration_m_s2) * dt;
  speed = std::clamp(wanted, speed - change, speed + change);
  const double turn_limit = radians(limits.turn_rate_max_deg_s), turn_change = radians(limits.turn_acceleration_deg_s2) * dt;
  turn_rate = std::clamp(std::clamp(command.turn_rate, -turn_limit, turn_limit), turn_rate - turn_change, turn_rate + turn_change);
  return {pose, speed, turn_rate};
}

void Vehicle::take(const FlightState& state) {
  const glm::dvec3 angles = roll_pitch_yaw(state.attitude);
  pose = {glm::dvec2(state.position), angles.z};
  z = state.position.z;
  velocity = state.velocity;
  attitude = state.attitude;
  rates = state.rates;
  speed = glm::dot(glm::dvec2(velocity), direction(pose.yaw));
  turn_rate = rates.z;
}

glm::dquat Vehicle::tilt() const { return glm::conjugate(Pose::planar(0.0, 0.0, 0.0, pose.yaw).orientation) * attitude; }

}  // namespace thicket

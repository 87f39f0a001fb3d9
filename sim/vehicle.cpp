#include "thicket/sim/vehicle.hpp"

#include <algorithm>

namespace thicket {

const Section& vehicle_section() {
  using S = VehicleSpec;
  static const Section section =
      SectionOf<S>("[vehicle]", "a differential drive; `preset` (a name from sim/presets, or a file) sets all keys, the others come on top")
          .key("name", &S::name, "what it is called")
          .key("radius_m", &S::radius_m, "m", above_up_to(0.0, 100.0), "radius of the hull, an upright cylinder about the axis it turns on")
          .key("height_m", &S::height_m, "m", above_up_to(0.0, 100.0), "height of the hull")
          .key("ground_clearance_m", &S::ground_clearance_m, "m", between(0.0, 100.0), "what is lower than this passes under the hull")
          .key("speed_max_m_s", &S::speed_max_m_s, "m/s", above_up_to(0.0, 1e3), "forward speed, at most")
          .key("turn_rate_max_deg_s", &S::turn_rate_max_deg_s, "deg/s", above_up_to(0.0, 3600.0), "turn rate, at most")
          .key("acceleration_m_s2", &S::acceleration_m_s2, "m/s^2", above_up_to(0.0, 1e3), "gaining speed")
          .key("deceleration_m_s2", &S::deceleration_m_s2, "m/s^2", above_up_to(0.0, 1e3), "losing speed")
          .key("turn_acceleration_deg_s2", &S::turn_acceleration_deg_s2, "deg/s^2", above_up_to(0.0, 36000.0), "gaining or losing turn rate");
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

}  // namespace thicket

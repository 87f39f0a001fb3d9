#include "pilot.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {

Pilot::Pilot(const PlannerSpec& spec, const VehicleLimits& vehicle)
    : vehicle_(vehicle),
      keep_(vehicle.hull_radius + spec.clearance_m),
      gap_(std::max(0.01, 0.05 * spec.clearance_m)),
      look_ahead_(std::clamp(0.3 * keep_, 0.06, 0.5)),
      same_place_(std::max(0.06, 0.12 * keep_)),
      speed_(std::min(vehicle.speed, spec.speed_m_s.value_or(vehicle.speed))),
      goal_tolerance_(spec.goal_tolerance_m) {}

void Pilot::look(const Senses& senses) {
  pose_ = senses.pose;
  speed_now_ = senses.speed;
  turn_rate_ = senses.turn_rate;
  contour_.clear();
  // The bumpers decide whether there is anything to steer around at all; only then the rays of the scan are looked at one by one.
  if (!senses.bumpers.any_pressed()) return;
  const double reach = std::max(keep_ + look_ahead_, vehicle_.hull_radius + senses.bumpers.press_distance());
  for (const ContourPoint& point : senses.contour)
    if (point.distance <= reach) contour_.push_back(point);
}

double Pilot::distance_to(const glm::dvec2& point) const { return glm::distance(pose_.position, point); }

Steering::Way Pilot::way_to(const glm::dvec2& point) const {
  const Steering steering(contour_, keep_, look_ahead_);
  return steering.free_way(bearing(pose_.to_inner(point)), keep_ - gap_, distance_to(point));
}

bool Pilot::blocked_toward(const glm::dvec2& point) const {
  const auto way = way_to(point);
  return way.point && way.distance < gap_;
}

bool Pilot::open_toward(const glm::dvec2& point) const {
  const auto way = way_to(point);
  return !way.point || way.distance > 2.0 * gap_ + 0.5 * look_ahead_;
}

Command Pilot::go_to(const glm::dvec2& point) const { return drive(bearing(pose_.to_inner(point)), way_to(point).distance); }

void Pilot::touch_wall_toward(const glm::dvec2& point) {
  const auto way = way_to(point);
  contact_ = way.point ? pose_.to_outer(contour_[*way.point].position) : point;
}

Command Pilot::follow(Hand hand) {
  const Steering steering(contour_, keep_, look_ahead_);
  // With the wall on the left hand the robot turns right, away from it, until a heading is open; the heading next to the wall is the boundary's.
  const auto edge = steering.sweep(bearing(pose_.to_inner(contact_)), hand == Hand::left ? -1 : +1);
  boxed_in_ = !edge;
  if (!edge) return {};
  if (edge->point) contact_ = pose_.to_outer(contour_[*edge->point].position);
  const double limit = speed_ * speed_ / vehicle_.deceleration + 1.0;
  Command command = drive(edge->heading, steering.free_way(edge->heading, keep_ - 2.0 * gap_, limit).distance);
  // The boundary is steered along by looking ahead: a robot that covers that distance between a few decisions swings from side to side.
  command.speed = std::min(command.speed, look_ahead_ / (3.5 * vehicle_.decision_period));
  return command;
}

Command Pilot::drive(double heading, double way) const {
  // Turn: as fast as can be braked before the heading is reached, the delay of one decision included.
  const double error = wrap_angle(heading), size = std::abs(error);
  const double rate = std::min({vehicle_.turn_rate, 0.8 * std::sqrt(2.0 * vehicle_.turn_acceleration * size), size / (2.0 * vehicle_.decision_period)});
  // Forward: nothing before the robot faces within 60 degrees of its way; never faster than it can brake, on its way and on the heading it has now.
  const double facing = std::max(0.0, 2.0 * std::cos(error) - 1.0);
  const Steering steering(contour_, keep_, look_ahead_);
  const double ahead = steering.free_way(0.0, keep_ - 4.0 * gap_, way + 1.0).distance;
  const auto braking_speed = [&](double distance) {
    const double left = std::max(0.0, distance - speed_now_ * vehicle_.decision_period);
    return std::max(std::sqrt(2.0 * vehicle_.deceleration * left), std::min(distance, gap_) / (2.0 * vehicle_.decision_period));
  };
  return {std::min({speed_ * facing, braking_speed(way), braking_speed(ahead)}), std::copysign(rate, error)};
}

}  // namespace thicket

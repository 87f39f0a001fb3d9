#include "pilot.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {

namespace {

/// Deciding more often than ten times a second does not make a vehicle answer sooner: gains stay those that it can follow.
VehicleLimits vehicle_for_steering(VehicleLimits vehicle) {
  vehicle.decision_period = std::max(vehicle.decision_period, 0.1);
  return vehicle;
}

}  // namespace

Pilot::Pilot(const PlannerSpec& spec, const VehicleLimits& vehicle)
    : vehicle_(vehicle_for_steering(vehicle)),
      keep_(vehicle.hull_radius + spec.clearance_m),
      gap_(std::max(0.01, 0.05 * spec.clearance_m)),
      look_ahead_(std::clamp(0.4 * keep_, 0.06, 0.6)),
      // The boundary is steered along by looking ahead: a robot that covers this distance faster than it can decide and turn swings from side to side. A turn by
      // 20 degrees takes 2 sqrt(0.35 / turn acceleration).
      following_speed_(look_ahead_ / (2.5 * vehicle_.decision_period + 1.2 * std::sqrt(0.35 / vehicle.turn_acceleration))),
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

bool Pilot::blocked_by_other(const glm::dvec2& point) const {
  const auto way = way_to(point);
  if (!way.point) return false;
  const double apart = wrap_angle(contour_[*way.point].bearing - bearing(pose_.to_inner(contact_)));
  return std::abs(apart) > 0.5 * pi;
}

Command Pilot::go_to(const glm::dvec2& point) const { return drive(bearing(pose_.to_inner(point)), way_to(point).distance); }

void Pilot::touch_wall_toward(const glm::dvec2& point) {
  const auto way = way_to(point);
  contact_ = way.point ? pose_.to_outer(contour_[*way.point].position) : point;
}

Command Pilot::follow(Hand hand) {
  // With the wall on the left hand the robot turns right, away from it, until a heading is open; the heading next to the wall is the boundary's.
  const int turn = hand == Hand::left ? -1 : +1;
  const double to_contact = bearing(pose_.to_inner(contact_));
  double keep = keep_;
  auto edge = Steering(contour_, keep, look_ahead_).sweep(to_contact, turn);
  if (!edge) {
    // Swung a little too deep into a corner, with matter nearer than the clearance on several sides: find the way out along the distance that there is.
    for (const ContourPoint& point : contour_) keep = std::min(keep, point.distance);
    if (keep > keep_ - 10.0 * gap_) edge = Steering(contour_, keep, look_ahead_).sweep(to_contact, turn);
  }
  boxed_in_ = !edge;
  if (!edge) return {};
  double heading = edge->heading;
  if (edge->point) {
    const ContourPoint& point = contour_[*edge->point];
    contact_ = pose_.to_outer(point.position);
    // The open heading next to the wall points at the grown wall's tangent; come down to it gently, in proportion to the distance from it, or the robot swings.
    const double off = point.distance - keep;
    if (off > 0.0) {
      const double steep = 0.5 * pi - std::abs(wrap_angle(point.bearing - heading)), gentle = off / look_ahead_;
      heading += turn * std::clamp(steep - gentle, 0.0, 0.5 * edge->open);
    }
  }
  // In a dead end both ways round are about as short, but only one is the boundary's own: the walk counts its turns.
  heading = wrap_angle(heading);
  if (turn * heading < -radians(120.0)) heading += turn * 2.0 * pi;
  const double limit = speed_ * speed_ / vehicle_.deceleration + 1.0;
  Command command = drive(heading, Steering(contour_, keep, look_ahead_).free_way(heading, keep - 2.0 * gap_, limit).distance);
  command.speed = std::min(command.speed, following_speed_);
  return command;
}

Command Pilot::drive(double heading, double way) const {
  // Turn: as fast as can be braked before the heading is reached, the delay of one decision included.
  const double error = heading, size = std::abs(error);
  const double rate = std::min({vehicle_.turn_rate, 0.8 * std::sqrt(2.0 * vehicle_.turn_acceleration * size), size / (2.0 * vehicle_.decision_period)});
  // Forward: nothing before the robot faces within 60 degrees of its way; never faster than it can brake, on its way and on the heading it has now.
  const double facing = size < 0.5 * pi ? std::max(0.0, 2.0 * std::cos(error) - 1.0) : 0.0;
  const Steering steering(contour_, keep_, look_ahead_);
  const double ahead = steering.free_way(0.0, keep_ - 4.0 * gap_, way + 1.0).distance;
  const auto braking_speed = [&](double distance) {
    const double left = std::max(0.0, distance - speed_now_ * vehicle_.decision_period);
    return std::max(std::sqrt(2.0 * vehicle_.deceleration * left), std::min(distance, gap_) / (2.0 * vehicle_.decision_period));
  };
  return {std::min({speed_ * facing, braking_speed(way), braking_speed(ahead)}), std::copysign(rate, error)};
}

}  // namespace thicket

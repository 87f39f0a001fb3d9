#include "pilot.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>

#include "thicket/nav/steering.hpp"

namespace thicket {

namespace {

/// Deciding more often than ten times a second does not make a vehicle answer sooner: gains stay those that it can follow.
VehicleLimits vehicle_for_steering(VehicleLimits vehicle) {
  vehicle.decision_period = std::max(vehicle.decision_period, 0.1);
  return vehicle;
}

constexpr double longest_stand = 2.0;    // s before a corner of the boundary, facing it
constexpr double sharp = radians(45.0);  // an inner corner of the boundary that is turned in on the spot

}  // namespace

Pilot::Pilot(const PlannerSpec& spec, const VehicleLimits& vehicle)
    : vehicle_(vehicle_for_steering(vehicle)),
      keep_(vehicle.hull_radius + spec.clearance_m),
      gap_(std::max(0.01, 0.05 * spec.clearance_m)),
      look_ahead_(std::clamp(0.4 * keep_, 0.06, 0.6)),
      // The boundary is steered along by looking ahead: a robot that covers this distance faster than it can decide and turn swings from side to side. A turn by
      // 20 degrees takes 2 sqrt(0.35 / turn acceleration).
      turn_time_(2.5 * vehicle_.decision_period + 1.2 * std::sqrt(0.35 / vehicle.turn_acceleration)),
      same_place_(std::max(0.06, 0.12 * keep_)),
      speed_(std::min(vehicle.speed, spec.speed_m_s.value_or(vehicle.speed))),
      goal_tolerance_(spec.goal_tolerance_m),
      surroundings_(keep_),
      unseen_(2.0 * keep_ + std::max(look_ahead_, speed_ * speed_ / (2.0 * vehicle_.deceleration)), keep_ / 6.0, 10.0) {
  if (spec.follower == "rules2012") rules_.emplace(vehicle_, speed_, spec.clearance_m);
  horizon_ = std::max(2.0 * look_ahead_, 0.5 * speed_ * speed_ / vehicle.deceleration + look_ahead_);
}

void Pilot::look(const Senses& senses) {
  pose_ = senses.pose;
  speed_now_ = senses.speed;
  // The bumpers decide whether there is anything to steer around at all; only then the rays of the scan are looked at one by one.
  senses_ = &senses;
  unseen_.look(senses.contour, pose_, senses.time);
  const Contour* contour = &senses.contour;
  if (unseen_.has_gaps()) {
    completed_ = senses.contour;
    unseen_.complete(completed_);
    contour = &completed_;
  }
  const double reach = std::max(keep_ + look_ahead_, vehicle_.hull_radius + senses.bumpers.press_distance());
  arcs_ = unseen_.has_gaps() && std::any_of(contour->begin(), contour->end(), [](const ContourPoint& point) { return point.arc != no_arc; });
  arcs_near_.clear();
  if (arcs_) std::copy_if(contour->begin(), contour->end(), std::back_inserter(arcs_near_), [reach](const ContourPoint& point) { return point.distance <= reach; });
  surroundings_.look(*contour, senses.bumpers, pose_, senses.time, reach);
  discs_ = surroundings_.discs();
  nearest_ = INFINITY;
  for (const GrownDisc& disc : discs_)
    if (!disc.gate) nearest_ = std::min(nearest_, glm::distance(disc.centre, pose_.position));
}

double Pilot::distance_to(const glm::dvec2& point) const { return glm::distance(pose_.position, point); }

Pilot::Way Pilot::free_way(double heading, double shrink, double limit) const {
  Way way{limit, none};
  const glm::dvec2 ahead = direction(pose_.yaw + heading);
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    const glm::dvec2 to = discs_[i].centre - pose_.position;
    const double radius = discs_[i].radius - shrink, along = glm::dot(to, ahead), across = to.x * ahead.y - to.y * ahead.x;
    if (along <= 0.0 || std::abs(across) >= radius) continue;
    const double square = radius * radius - across * across;
    const double distance = std::max(0.0, along - std::sqrt(square));
    if (distance < way.distance) way = {distance, i};
  }
  return way;
}

Pilot::Way Pilot::way_out(double heading, double shrink, double limit) const {
  Way way{limit, none};
  const glm::dvec2 ahead = direction(pose_.yaw + heading);
  const double margin = 0.5 * gap_, most = nearest_ - margin;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    const glm::dvec2 to = discs_[i].centre - pose_.position;
    // In the middle of a passage that is shut: out of it the way that the boundary tells, be it across the middle.
    if (discs_[i].gate && glm::length(to) < discs_[i].radius) continue;
    const double radius = std::min({discs_[i].radius - shrink, most, glm::length(to) - margin}), along = glm::dot(to, ahead), across = to.x * ahead.y - to.y * ahead.x;
    if (along <= 0.0 || std::abs(across) >= radius) continue;
    const double distance = std::max(0.0, along - std::sqrt(radius * radius - across * across) - 2.0 * margin);
    if (distance < way.distance) way = {distance, i};
  }
  return way;
}

Pilot::Way Pilot::way_to(const glm::dvec2& point, double shrink) const { return free_way(bearing(pose_.to_inner(point)), shrink, distance_to(point)); }

bool Pilot::blocked_toward(const glm::dvec2& point) const {
  // What is still rolling the other way is turned round first: where it then stands decides.
  if (speed_now_ > gap_ && std::abs(bearing(pose_.to_inner(point))) > radians(60.0)) return false;
  const auto way = way_to(point, gap_);
  if (way.disc == none || way.distance >= gap_) return false;
  if (ahead(way, point)) return true;
  // By a wider margin what is passed by on one side: a straight way along a wall must not be open at one glance and blocked at the next.
  const glm::dvec2 on = glm::normalize(point - pose_.position), to = discs_[way.disc].centre - pose_.position;
  const auto left = [&on](const glm::dvec2& v) { return on.x * v.y - on.y * v.x > 0.0; };
  for (const GrownDisc& disc : discs_) {
    const glm::dvec2 other = disc.centre - pose_.position;
    const double along = glm::dot(on, other), across = std::abs(on.x * other.y - on.y * other.x);
    if (left(other) != left(to) && along > 0.0 && along < keep_ && across < disc.radius) return true;  // a gap
  }
  if (stands_before(point)) return true;
  const auto closer = way_to(point, 2.0 * gap_);
  return closer.disc != none && closer.distance < gap_;
}

bool Pilot::stands_before(const glm::dvec2& point) const {
  const double off = bearing(pose_.to_inner(point));
  return std::abs(off) < radians(10.0) && way_out(off, 2.0 * gap_, gap_).distance <= 0.0;
}

bool Pilot::open_toward(const glm::dvec2& point) const {
  const auto way = way_to(point, 0.5 * gap_);
  return way.disc == none || way.distance > 2.0 * gap_ + 0.5 * look_ahead_;
}

bool Pilot::blocked_by_other(const glm::dvec2& point) const {
  const auto way = way_to(point, 0.5 * gap_);
  if (way.disc == none) return false;
  // Grown obstacles that touch are one: from the disc under the hand to all that it hangs together with.
  std::vector<std::size_t> open;
  std::vector<bool> known(discs_.size());
  std::size_t first = 0;
  for (std::size_t i = 1; i < discs_.size(); ++i)
    if (glm::distance(discs_[i].centre, contact_) < glm::distance(discs_[first].centre, contact_)) first = i;
  open.push_back(first);
  known[first] = true;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    if (i == way.disc) return false;
    for (std::size_t j = 0; j < discs_.size(); ++j)
      if (!known[j] && glm::distance(discs_[i].centre, discs_[j].centre) < discs_[i].radius + discs_[j].radius) {
        known[j] = true;
        open.push_back(j);
      }
  }
  return true;
}

int Pilot::nearer_side(const glm::dvec2& point) const {
  const auto way = way_to(point, gap_);
  if (way.disc == none) return 0;
  const glm::dvec2 on = point - pose_.position, to = discs_[way.disc].centre - pose_.position;
  const double sine = (to.x * on.y - to.y * on.x) / (glm::length(to) * glm::length(on));
  return std::abs(sine) < 0.035 ? 0 : sine > 0.0 ? +1 : -1;
}

bool Pilot::ahead(const Way& way, const glm::dvec2& point) const {
  const glm::dvec2 on = point - pose_.position, to = discs_[way.disc].centre - pose_.position;
  return glm::dot(on, to) > 0.5 * glm::length(on) * glm::length(to);
}

Command Pilot::go_to(const glm::dvec2& point) const {
  Way way = way_to(point, gap_);
  if (way.disc != none && !ahead(way, point)) way = way_to(point, 2.0 * gap_);
  return drive(bearing(pose_.to_inner(point)), way.distance);
}

void Pilot::touch_wall_toward(const glm::dvec2& point) {
  const auto way = way_to(point, gap_);
  contact_ = way.disc != none ? discs_[way.disc].centre : point;
  if (rules_) rules_->begin();
}

bool Pilot::roll_on(Hand hand) {
  const int turn = hand == Hand::left ? +1 : -1;
  const double length = horizon_ + 0.5 * look_ahead_;
  if (roll(discs_, contact_, pose_.position, turn, 0.7 * keep_, length, path_)) return true;
  // No free place about the contact, as where a lobe tells no more than that there is matter somewhere on an arc: then the nearest anywhere.
  if (roll(discs_, contact_, pose_.position, turn, INFINITY, length, path_)) return true;
  // Matter nearer than it should be on all sides, as at a start in a narrow place: then the way out is along the distance that there is.
  for (GrownDisc& disc : discs_) disc.radius = std::min(disc.radius, glm::distance(disc.centre, pose_.position) - 1e-3);
  return roll(discs_, contact_, pose_.position, turn, INFINITY, length, path_);
}

Command Pilot::follow(Hand hand) {
  if (rules_) {
    const Command command = rules_->follow(*senses_, hand);
    boxed_in_ = rules_->boxed_in();
    return command;
  }
  // What the hand was on is out of sight, as between two lobes: back to where it was.
  if (discs_.empty()) {
    boxed_in_ = false;
    return go_to(contact_);
  }
  if (arcs_) return follow_arcs(hand);
  boxed_in_ = !roll_on(hand);
  if (boxed_in_) return {};
  const auto& points = path_.points;
  // Where on it the robot is: the first place that the boundary, walked from behind, is near. (The other side of a dead end may be as near.)
  std::size_t here = 0;
  double least = glm::distance(points[0].position, pose_.position);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double away = glm::distance(points[i].position, pose_.position);
    if (away < least) {
      least = away;
      here = i;
    } else if (away > least + 0.25 * look_ahead_) {
      break;
    }
  }
  contact_ = discs_[points[here].disc].centre;

  // What stands before a corner that it cannot get nearer to is at the corner, until it has gone some way from there.
  if (stalled_at_ && distance_to(*stalled_at_) > 0.5 * look_ahead_) stalled_at_.reset();
  const bool stalled = stalled_at_.has_value();

  // Where to: as far on as the boundary is straight, no farther than the next sharp inner corner, past that once it is reached.
  const double start = points[here].along;
  double stop = INFINITY;
  std::size_t target = here;
  const auto way_of = [&](std::size_t i) { return points[i].position - discs_[points[i].disc].centre; };  // outward; the boundary's way is at right angles to it
  const glm::dvec2 outward = way_of(here);
  for (std::size_t i = here; i < points.size(); ++i) {
    const double ahead = points[i].along - start;
    if (points[i].corner && i + 1 < points.size()) {
      const GrownDisc &from = discs_[points[i].disc], &to = discs_[points[i + 1].disc];
      // A robot that cannot stop before it has as good as gone through.
      if (ahead < 0.5 * look_ahead_ && stopping_distance() < ahead + 0.5 * look_ahead_) surroundings_.shut(from, to);
      const glm::dvec2 before = points[i].position - from.centre, after = points[i].position - to.centre;
      const double corner = std::acos(std::clamp(glm::dot(before, after) / (glm::length(before) * glm::length(after)), -1.0, 1.0));
      if (corner > sharp && glm::distance(points[i].position, pose_.position) > (stalled ? 1.0 : 0.25) * look_ahead_) {
        stop = std::max(0.0, ahead);
        if (ahead <= look_ahead_ || target == i - 1) target = i;
        break;
      }
    }
    if (ahead <= look_ahead_) {
      target = i;
      continue;
    }
    const glm::dvec2 there = way_of(i);
    const bool straight = glm::dot(outward, there) > 0.985 * glm::length(outward) * glm::length(there);
    if (straight && target + 1 == i && ahead < horizon_) target = i;
  }
  // Around a corner the robot, which heads for a place ahead on the arc, would run inside of it.
  const glm::dvec2 there = way_of(target);
  const double bend = (hand == Hand::left ? 1.0 : -1.0) * std::atan2(outward.x * there.y - outward.y * there.x, glm::dot(outward, there));
  const double ahead_of_here = std::min(look_ahead_, points[target].along - start);
  const glm::dvec2 aim = points[target].position + glm::normalize(there) * (0.25 * std::clamp(bend, 0.0, 0.6) * ahead_of_here);
  double heading = bearing(pose_.to_inner(aim));
  // In a dead end both ways round are about as short, but only one is the boundary's own: the walk counts its turns.
  const int away = hand == Hand::left ? -1 : +1;
  if (away * heading < -radians(120.0)) heading += away * 2.0 * pi;
  const double reach = std::max(look_ahead_, points[target].along - start);
  const double limit = speed_ * speed_ / vehicle_.deceleration + 1.0;
  Command command = drive(heading, std::min(stop + 0.5 * gap_, way_out(wrap_angle(heading), 2.0 * gap_, limit).distance));
  command.speed = std::min(command.speed, reach / turn_time_);
  const bool stands = speed_now_ < 0.01 && command.speed < 0.01 && std::abs(heading) < radians(15.0);
  if (!stands) stands_since_ = senses_->time;
  if (senses_->time - stands_since_ > longest_stand) stalled_at_ = pose_.position;
  return command;
}

Command Pilot::follow_arcs(Hand hand) {
  // With the wall on the left hand the robot turns right, away from it, until a heading is open.
  const int turn = hand == Hand::left ? -1 : +1;
  const double to_contact = bearing(pose_.to_inner(contact_));
  double keep = keep_;
  auto edge = Steering(arcs_near_, keep, look_ahead_).sweep(to_contact, turn);
  if (!edge) {
    // Swung a little too deep into a corner: out along the distance that there is.
    for (const ContourPoint& point : arcs_near_) keep = std::min(keep, point.distance - 1e-3);
    edge = Steering(arcs_near_, keep, look_ahead_).sweep(to_contact, turn);
  }
  boxed_in_ = !edge;
  if (!edge) return {};
  double heading = edge->heading;
  if (edge->point) {
    const ContourPoint& point = arcs_near_[*edge->point];
    contact_ = pose_.to_outer(point.position);
    // It points at the grown wall's tangent: come down to it gently, in proportion to the distance from it, or the robot swings.
    if (const double off = point.distance - keep; off > 0.0) {
      const double steep = 0.5 * pi - std::abs(wrap_angle(point.bearing - heading)), gentle = off / look_ahead_;
      heading += turn * std::clamp(steep - gentle, 0.0, 0.5 * edge->open);
    }
  }
  heading = wrap_angle(heading);
  if (turn * heading < -radians(120.0)) heading += turn * 2.0 * pi;
  Command command = drive(heading, Steering(arcs_near_, keep, look_ahead_).free_way(wrap_angle(heading), keep - 2.0 * gap_, speed_ * speed_ / vehicle_.deceleration + 1.0).distance);
  command.speed = std::min(command.speed, look_ahead_ / turn_time_);
  return command;
}

Command Pilot::drive(double heading, double way) const {
  // Turn: as fast as can be braked before the heading is reached, the delay of one decision included.
  const double error = heading, size = std::abs(error);
  double rate = std::min({vehicle_.turn_rate, 0.8 * std::sqrt(2.0 * vehicle_.turn_acceleration * size), size / (2.0 * vehicle_.decision_period)});
  // Forward: nothing before the robot faces within 60 degrees of its way; never faster than it can brake, on its way and on the heading it has now.
  const double facing = size < 0.5 * pi ? std::max(0.0, 2.0 * std::cos(error) - 1.0) : 0.0;
  // Where nothing has looked lately, it looks first.
  if (facing > 0.0 && unseen_.has_gaps()) {
    if (const auto turn = unseen_.turn_to_see(heading, 0.5 * (vehicle_.hull_radius + keep_), vehicle_.hull_radius, std::min(way, std::max(look_ahead_, stopping_distance()))))
      return {0.0, std::copysign(std::min(vehicle_.turn_rate, std::max(0.2, std::abs(*turn) / (2.0 * vehicle_.decision_period))), *turn)};
  }
  // Turning round, first stop: the arc of a robot that is still rolling leads to where nobody has looked.
  if (facing == 0.0) rate *= std::clamp(1.0 - (speed_now_ - 0.2 * look_ahead_) / (0.4 * look_ahead_), 0.0, 1.0);
  const double ahead = way_out(0.0, 4.0 * gap_, way + 1.0).distance;
  const auto braking_speed = [&](double distance) {
    const double left = std::max(0.0, distance - speed_now_ * vehicle_.decision_period);
    return std::max(std::sqrt(2.0 * vehicle_.deceleration * left), std::min(distance, gap_) / (2.0 * vehicle_.decision_period));
  };
  return {std::min({speed_ * facing, braking_speed(way), braking_speed(ahead)}), std::copysign(rate, error)};
}

}  // namespace thicket

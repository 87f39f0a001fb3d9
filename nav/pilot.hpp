// The robot's handling, shared by all planners: drive to a point, follow a boundary. Private to the room.
#pragma once

#include <glm/vec2.hpp>

#include "thicket/nav/planner.hpp"
#include "thicket/nav/steering.hpp"

namespace thicket {

/// Which hand is on the wall.
enum class Hand { left, right };
inline Hand other(Hand hand) { return hand == Hand::left ? Hand::right : Hand::left; }

class Pilot {
 public:
  Pilot(const PlannerSpec& spec, const VehicleLimits& vehicle);

  /// Takes in what is sensed; everything below is about this moment.
  void look(const Senses& senses);

  const Pose2& pose() const { return pose_; }
  double distance_to(const glm::dvec2& point) const;
  bool at(const glm::dvec2& goal) const { return distance_to(goal) <= goal_tolerance_; }

  /// The straight way to a point is blocked where the robot stands: it cannot get nearer without giving up its clearance.
  bool blocked_toward(const glm::dvec2& point) const;
  /// The straight way is open for more than a moment. (Neither blocked nor open: too close to call; planners go on with what they do.)
  bool open_toward(const glm::dvec2& point) const;
  /// While following: what blocks the straight way is not the wall under the hand but something on the other side of the robot, as in a gap just as wide as it needs.
  bool blocked_by_other(const glm::dvec2& point) const;
  /// Drives straight toward a point and brakes for it and for what stands before it.
  Command go_to(const glm::dvec2& point) const;

  /// Puts the hand on what blocks the way to a point.
  void touch_wall_toward(const glm::dvec2& point);
  /// Follows the boundary of the grown obstacle under the hand.
  Command follow(Hand hand);
  /// While following: no heading is open at all.
  bool boxed_in() const { return boxed_in_; }

  /// Two positions count as the same place within this, m.
  double same_place() const { return same_place_; }
  /// Distance that the robot's axis keeps from matter, m.
  double keep() const { return keep_; }

 private:
  Steering::Way way_to(const glm::dvec2& point) const;
  /// `heading` beyond +-pi turns the long way round.
  Command drive(double heading, double way) const;

  VehicleLimits vehicle_;
  double keep_;        ///< hull radius + clearance: distance of the axis from matter
  double gap_;         ///< a way shorter than this is no way
  double look_ahead_;  ///< m
  double following_speed_;
  double same_place_;
  double speed_;
  double goal_tolerance_;
  bool boxed_in_ = false;
  glm::dvec2 contact_{0.0, 0.0};  ///< the point of the wall that the hand is on, world

  Pose2 pose_;
  double turn_rate_ = 0.0, speed_now_ = 0.0;
  Contour contour_;  ///< the part that matters now
};

}  // namespace thicket

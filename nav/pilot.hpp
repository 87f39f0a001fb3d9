// The robot's handling, shared by all planners: drive to a point, follow a boundary. Private to the room.
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "rolling.hpp"
#include "rules2012.hpp"
#include "surroundings.hpp"
#include "thicket/nav/planner.hpp"
#include "unseen.hpp"

namespace thicket {

/// Which hand is on the wall.
enum class Hand { left, right };
inline Hand other(Hand hand) { return hand == Hand::left ? Hand::right : Hand::left; }

class Pilot {
 public:
  Pilot(const PlannerSpec& spec, const VehicleLimits& vehicle);

  /// Takes in what is sensed; everything below is about this moment. `senses` must live until the decision is made.
  void look(const Senses& senses);

  const Pose2& pose() const { return pose_; }
  double distance_to(const glm::dvec2& point) const;
  bool at(const glm::dvec2& goal) const { return distance_to(goal) <= goal_tolerance_; }

  /// The straight way to a point is blocked where the robot stands: it cannot get nearer without giving up its clearance.
  bool blocked_toward(const glm::dvec2& point) const;
  /// It faces a point and cannot get nearer.
  bool stands_before(const glm::dvec2& point) const;
  /// The straight way is open for more than a moment. (Neither blocked nor open: too close to call; planners go on with what they do.)
  bool open_toward(const glm::dvec2& point) const;
  /// While following: what blocks the straight way is another obstacle than the one under the hand, as in a gap just as wide as the robot needs.
  bool blocked_by_other(const glm::dvec2& point) const;
  /// Of what blocks the way to a point: along which side of it the robot comes nearer to the point, +1 left, -1 right; 0: neither clearly, it is met head-on.
  int nearer_side(const glm::dvec2& point) const;
  /// Drives straight toward a point and brakes for it and for what stands before it.
  Command go_to(const glm::dvec2& point) const;

  /// Puts the hand on what blocks the way to a point.
  void touch_wall_toward(const glm::dvec2& point);
  /// Follows the boundary of the grown obstacle under the hand.
  Command follow(Hand hand);
  /// While following: there is no place to go at all.
  bool boxed_in() const { return boxed_in_; }
  /// While following: nothing is near any more, not even where the hand was: what moved away, or what a lobe told was not there.
  bool wall_is_gone() const { return !rules_ && discs_.empty() && distance_to(contact_) < keep_; }
  /// What the follower does, in words; may be empty.
  const char* following() const { return rules_ ? rules_->state() : ""; }

  /// What it takes to stop from the speed that it has now, m.
  double stopping_distance() const { return 0.5 * speed_now_ * speed_now_ / vehicle_.deceleration + speed_now_ * vehicle_.decision_period; }
  /// Two positions count as the same place within this, m.
  double same_place() const { return same_place_; }
  /// Distance that the robot's axis keeps from matter, m.
  double keep() const { return keep_; }

 private:
  /// How far the axis can go along a heading, up to `limit`, until it enters a disc made smaller by `shrink`, and which; a disc that it is in already stops whatever goes toward its middle.
  struct Way {
    double distance = 0.0;
    std::size_t disc = none;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  Way free_way(double heading, double shrink, double limit) const;
  /// The same for discs that are nowhere larger than the distance that the robot has now: what brakes a robot that came too near must not keep it there.
  Way way_out(double heading, double shrink, double limit) const;
  Way way_to(const glm::dvec2& point, double shrink) const;
  /// What stops a way to a point stands in it, and not beside it.
  bool ahead(const Way& way, const glm::dvec2& point) const;
  bool roll_on(Hand hand);
  /// Lobes tell on which arc there is matter, not where on it: the robot keeps away from all of the arc, by headings that are open.
  Command follow_arcs(Hand hand);
  /// `heading` beyond +-pi turns the long way round.
  Command drive(double heading, double way) const;

  VehicleLimits vehicle_;
  double keep_;        ///< hull radius + clearance: distance of the axis from matter
  double gap_;         ///< a way shorter than this is no way
  double look_ahead_;  ///< m
  double horizon_;     ///< m of boundary that are looked at ahead
  double turn_time_;   ///< s that a small change of heading takes
  double same_place_;
  double speed_;
  double goal_tolerance_;
  bool boxed_in_ = false;
  glm::dvec2 contact_{0.0, 0.0};  ///< the matter that the hand is on
  double stands_since_ = 0.0;     ///< s: following, but neither moving nor turning
  std::optional<glm::dvec2> stalled_at_;

  Pose2 pose_;
  double speed_now_ = 0.0, nearest_ = 0.0;
  const Senses* senses_ = nullptr;  ///< while a decision is made
  Surroundings surroundings_;
  Unseen unseen_;                   ///< what was seen lately, of a robot whose sensors leave gaps
  Contour completed_;               ///< the contour with that
  bool arcs_ = false;               ///< a sensor with lobes
  Contour arcs_near_;               ///< and what it sees within reach
  std::optional<Rules2012> rules_;  ///< instead of the boundary of the grown obstacles
  std::vector<GrownDisc> discs_;  ///< as now, in the frame of the pose
  BoundaryPath path_;
};

}  // namespace thicket

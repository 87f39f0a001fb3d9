// What Bug1 and Bug2 have in common: go to the goal until something is in the way, walk along it. Private to the room.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "boundary_walk.hpp"
#include "pilot.hpp"

namespace thicket {

class Bug : public Planner {
 public:
  Bug(const PlannerSpec& spec, const VehicleLimits& vehicle);

  Decision decide(const Senses& senses) final;
  std::vector<Mark> marks() const override { return marks_; }

 protected:
  /// One decision on the boundary, `walk()` being up to date.
  virtual Decision on_boundary() = 0;
  /// What to remember when a boundary is met.
  virtual void on_hit() {}
  /// With every decision, before anything else: for planners that look farther than the pilot does.
  virtual void look_far(const Senses&) {}
  /// Where to go straight while no boundary is followed.
  virtual glm::dvec2 aim() { return goal_; }
  /// The hand that goes on the wall at a hit; `first` is the one of the spec. That is the default, but for a hit right beside the last leave point, where the way to the goal grazes what was left: there
  /// it goes on the way that leads nearer, and not all around again. (No theorem asks for the same side at every hit.)
  virtual Hand choose_hand(Hand first);

  /// The way from here to the goal does not enter the obstacle that is followed: it is open, or it is something else that stands in it.
  bool leads_away();
  Decision follow(const char* state);
  Decision leave();
  /// The boundary is not what it was taken for: starts anew from here, but not for ever.
  Decision lost(const char* how);
  Decision unreachable(const std::string& why) const;

  Pilot& pilot() { return pilot_; }
  const Pilot& pilot() const { return pilot_; }
  const BoundaryWalk& walk() const { return walk_; }
  const glm::dvec2& goal() const { return goal_; }
  double distance_to_goal() const { return pilot_.distance_to(goal_); }
  void mark(const char* label, const glm::dvec2& at);
  void mark_segment(const char* label, const glm::dvec2& from, const glm::dvec2& to);
  void turn_round() { hand_ = other(hand_); }
  /// The walk is counted from here: at a hit, and where a planner turns round for good.
  void begin_walk();

 private:
  Pilot pilot_;
  glm::dvec2 goal_;
  std::optional<glm::dvec2> start_;  ///< where the run began
  Hand first_hand_;
  Hand hand_;
  bool on_boundary_ = false;
  double time_ = 0.0, left_time_ = 0.0;  ///< s
  std::optional<glm::dvec2> left_at_;    ///< the last leave point
  bool returning_ = false;               ///< to it, until the robot is nearer to the goal than that
  int strays_ = 0;
  double left_for_other_ = INFINITY;  ///< distance to the goal when a boundary was last left for another obstacle
  BoundaryWalk walk_;
  std::vector<Mark> marks_;
};

}  // namespace thicket

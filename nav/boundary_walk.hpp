// The book-keeping of a walk around an obstacle: how far, how much turned, where closest to the goal, and whether the loop is closed. Private to the room.
#pragma once

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {

/// Fed with every pose from the hit point on.
///
/// The loop is closed when the hit point is passed again with two witnesses: the robot faces about the way it left it, and it has turned about once around
/// (the boundary of an obstacle and that of a room both turn by 2 pi). Both are armed only after leaving the hit point's neighbourhood, for the walk starts in it.
class BoundaryWalk {
 public:
  BoundaryWalk() = default;
  BoundaryWalk(const Pose2& hit, const glm::dvec2& goal, double same_place);

  void advance(const Pose2& pose);

  const glm::dvec2& hit() const { return hit_; }
  double length() const { return length_; }
  /// Away from the hit point for the first time since the start.
  bool armed() const { return armed_; }
  bool closed() const { return closed_; }

  /// The place on the boundary that is closest to the goal so far, and how far along the walk it lies.
  const glm::dvec2& closest() const { return closest_; }
  double closest_distance() const { return closest_distance_; }
  double length_at_closest() const { return length_at_closest_; }

  /// The step from the pose before to the last one.
  const glm::dvec2& previous() const { return previous_.position; }
  const glm::dvec2& current() const { return current_.position; }

 private:
  glm::dvec2 hit_{0.0, 0.0}, goal_{0.0, 0.0};
  double same_place_ = 0.1;
  Pose2 previous_, current_;
  double length_ = 0.0;
  double turned_ = 0.0;       ///< since armed, rad
  double leaving_yaw_ = 0.0;  ///< when armed
  bool armed_ = false, closed_ = false;
  glm::dvec2 closest_{0.0, 0.0};
  double closest_distance_ = 0.0, length_at_closest_ = 0.0;
};

/// Distance from a point to a segment.
double distance_to_segment(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to);

}  // namespace thicket

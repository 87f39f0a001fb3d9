// The book-keeping of a walk around an obstacle: how far, where closest to the goal, and whether the loop is closed. Private to the room.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {

/// Fed with every pose from the hit point on.
///
/// The loop is closed when the robot comes back onto the beginning of its own track, with witnesses: it passes two places of it one after the other, heading the same way as then (the far side
/// of a narrow corridor is near too, but is walked the other way), and it has walked at least the circle around a point, the shortest outside there is, or turned once around, as in a cell that
/// is smaller than that, and that holds where it came from. The beginning of the track and not the hit point alone, because a hit in a notch is not passed again: the robot swings around in it a little
/// differently each time. How often it has turned since is no witness for long walks: in a dead end both ways round are as short.
class BoundaryWalk {
 public:
  BoundaryWalk() = default;
  /// `same_place`: two positions are the same within this; `keep`: the distance of the robot's axis from matter, the scale of everything here; `run_out`: what it rolls on after the hit before it can
  /// turn, which may be along the boundary the other way; `came_from`: a place that the robot has been at, the farther the better.
  BoundaryWalk(const Pose2& hit, const glm::dvec2& goal, double same_place, double keep, double run_out, const glm::dvec2& came_from);

  void advance(const Pose2& pose);

  const glm::dvec2& hit() const { return hit_; }
  double length() const { return length_; }
  /// Away from the hit point for the first time since the start, where every test would succeed at once.
  bool armed() const { return !track_.empty(); }
  bool closed() const { return closed_; }
  /// The walk goes round and round on a boundary that the hit point is not on.
  bool strayed() const { return strayed_; }

  /// Where on the boundary it was closest to the goal so far.
  const glm::dvec2& closest() const { return closest_; }
  double closest_distance() const { return closest_distance_; }
  /// Of a closed loop: its length, and how far it is from its end onward to the closest point.
  double loop_length() const { return length_ - rejoined_; }
  double onward_to_closest() const;

  /// The step from the pose before to the last one.
  const glm::dvec2& previous() const { return previous_.position; }
  const glm::dvec2& current() const { return current_.position; }

 private:
  struct TrackPoint {
    Pose2 pose;
    double length = 0.0, turned = 0.0;
  };
  bool rejoins(const TrackPoint& point) const;
  /// The circle around a point, less a fifth for cut corners, m.
  double shortest_outside() const { return 1.6 * pi * keep_; }

  glm::dvec2 hit_{0.0, 0.0}, goal_{0.0, 0.0}, came_from_{0.0, 0.0};
  double same_place_ = 0.1, keep_ = 1.0, run_out_ = 0.0;
  Pose2 previous_, current_;
  double length_ = 0.0, turned_ = 0.0;  ///< since the hit, m and rad
  std::vector<TrackPoint> track_;       ///< the beginning of the walk
  TrackPoint milestone_;                ///< a point of the walk, moved on whenever the walk has become twice as long (Brent 1980)
  std::size_t met_ = 0;                 ///< number of the last place of the track that was met again, from 1 on; 0: none
  double length_at_met_ = 0.0;
  bool closed_ = false, strayed_ = false;
  double rejoined_ = 0.0;               ///< length at the track point that closed the loop
  glm::dvec2 closest_{0.0, 0.0};
  double closest_distance_ = 0.0, length_at_closest_ = 0.0;
};

/// Distance from a point to a segment.
double distance_to_segment(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to);

}  // namespace thicket

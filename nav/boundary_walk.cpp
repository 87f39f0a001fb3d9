#include "boundary_walk.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {

double distance_to_segment(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 along = to - from;
  const double squared = glm::dot(along, along);
  const double t = squared > 0.0 ? std::clamp(glm::dot(point - from, along) / squared, 0.0, 1.0) : 0.0;
  return glm::distance(point, from + t * along);
}

BoundaryWalk::BoundaryWalk(const Pose2& hit, const glm::dvec2& goal, double same_place, double keep, double run_out, const glm::dvec2& came_from)
    : hit_(hit.position),
      goal_(goal),
      came_from_(came_from),
      same_place_(same_place),
      keep_(keep),
      run_out_(run_out),
      previous_(hit),
      current_(hit),
      closest_(hit.position),
      closest_distance_(glm::distance(hit.position, goal)) {}

void BoundaryWalk::advance(const Pose2& pose) {
  previous_ = current_;
  current_ = pose;
  length_ += glm::distance(previous_.position, current_.position);
  turned_ += wrap_angle(current_.yaw - previous_.yaw);
  const double to_goal = glm::distance(pose.position, goal_);
  if (to_goal < closest_distance_) {
    closest_ = pose.position;
    closest_distance_ = to_goal;
    length_at_closest_ = length_;
  }
  if (closed_) return;
  for (std::size_t i = 0; i < track_.size() && !closed_; ++i) {
    if (i + 1 == met_ || !rejoins(track_[i])) continue;
    closed_ = met_ > 0 && i + 1 > met_ && length_ - length_at_met_ < 5.0 * same_place_;
    rejoined_ = track_[i].length;
    met_ = i + 1;
    length_at_met_ = length_;
  }
  if (closed_) return;
  // (Turning on the spot in a narrow passage is no loop: here only length counts.)
  if (milestone_.length > 0.0 && length_ - milestone_.length > shortest_outside() && rejoins(milestone_)) strayed_ = true;
  if (length_ > std::max(2.0 * milestone_.length, 2.0 * pi * keep_)) milestone_ = {pose, length_, turned_};
  // Short against any boundary (none is shorter than the circle around a point, 2 pi keep), and short enough to lie on the one that was hit.
  const bool away = length_ > 3.0 * same_place_ && length_ < 1.5 * keep_ + run_out_;
  if (away && (track_.empty() || length_ - track_.back().length >= same_place_)) track_.push_back({pose, length_, turned_});
}

bool BoundaryWalk::rejoins(const TrackPoint& point) const {
  const double walked = length_ - point.length;
  // Within a loop no place is farther than half of its length from any other: what came from farther away is not in a cell, it turned on the spot in the mouth of a passage.
  const bool cell = std::abs(std::abs(turned_ - point.turned) - 2.0 * pi) < radians(75.0) && glm::distance(came_from_, point.pose.position) < 0.5 * walked + same_place_;
  const bool around = walked > shortest_outside() || cell;
  if (!around || std::abs(wrap_angle(current_.yaw - point.pose.yaw)) > radians(75.0)) return false;
  return distance_to_segment(point.pose.position, previous_.position, current_.position) <= same_place_;
}

double BoundaryWalk::onward_to_closest() const {
  const double loop = loop_length(), onward = std::fmod(length_at_closest_ - rejoined_, loop);
  return onward < 0.0 ? onward + loop : onward;
}

}  // namespace thicket

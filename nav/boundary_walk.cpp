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

BoundaryWalk::BoundaryWalk(const Pose2& hit, const glm::dvec2& goal, double same_place)
    : hit_(hit.position),
      goal_(goal),
      same_place_(same_place),
      previous_(hit),
      current_(hit),
      closest_(hit.position),
      closest_distance_(glm::distance(hit.position, goal)) {}

void BoundaryWalk::advance(const Pose2& pose) {
  previous_ = current_;
  current_ = pose;
  length_ += glm::distance(previous_.position, current_.position);
  const double to_goal = glm::distance(pose.position, goal_);
  if (to_goal < closest_distance_) {
    closest_ = pose.position;
    closest_distance_ = to_goal;
    length_at_closest_ = length_;
  }
  if (!armed_) {
    armed_ = glm::distance(pose.position, hit_) > 3.0 * same_place_;
    leaving_yaw_ = pose.yaw;
    return;
  }
  turned_ += wrap_angle(current_.yaw - previous_.yaw);
  const bool here = distance_to_segment(hit_, previous_.position, current_.position) <= same_place_;
  const bool faces_as_before = std::abs(wrap_angle(pose.yaw - leaving_yaw_)) < radians(135.0);
  // The turn at the hit point itself is not in the sum: a hit in a sharp corner leaves out up to half a turn.
  const bool once_around = std::abs(turned_) > pi && std::abs(turned_) < 3.0 * pi;
  if (here && faces_as_before && once_around) closed_ = true;
}

}  // namespace thicket

#include "far_view.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {

void FarView::look(const Pose2& pose, const Contour& contour) {
  pose_ = pose;
  contour_.clear();
  const ContourPoint* before = contour.empty() ? nullptr : &contour.back();
  for (const ContourPoint& point : contour) {
    if (std::isfinite(point.distance)) {
      farthest_ = std::max(farthest_, point.distance);
      contour_.push_back(point);
      const double apart = glm::distance(point.position, before->position);
      if (std::isfinite(before->distance) && apart > radius_ && apart < 2.0 * radius_) {
        const glm::dvec2 between = 0.5 * (point.position + before->position);
        contour_.push_back({between, glm::length(between), bearing(between)});
      }
    }
    before = &point;
  }
}

double FarView::free_way(double heading, double limit) const {
  const glm::dvec2 along = direction(heading);
  double way = limit;
  for (const ContourPoint& point : contour_) {
    const double ahead = glm::dot(point.position, along);
    if (ahead <= 0.0 || ahead - radius_ >= way) continue;
    const double across = along.x * point.position.y - along.y * point.position.x, half = radius_ * radius_ - across * across;
    if (half > 0.0) way = std::min(way, ahead - std::sqrt(half));
  }
  return std::max(0.0, way);
}

double FarView::free_toward(const glm::dvec2& point) const {
  return free_way(bearing(pose_.to_inner(point)), std::min(glm::distance(pose_.position, point), std::max(sight(), radius_)));
}

bool FarView::is_free(const glm::dvec2& point) const {
  return free_toward(point) >= std::min(glm::distance(pose_.position, point), std::max(sight(), radius_)) - 1e-9;
}

FarView::Place FarView::nearest_place(const glm::dvec2& goal) const {
  const glm::dvec2 to_goal = pose_.to_inner(goal);
  const double distance = glm::length(to_goal), ahead = bearing(to_goal);
  Place nearest{pose_.position, distance};
  for (int i = 0; i < 36; ++i) {  // straight on, 5 degrees left, 5 right, 10 left ... 85 right; from 90 on it gets no nearer
    const double off = radians(5.0) * (i % 2 == 0 ? i / 2 : -(i / 2 + 1));
    const double way = free_way(ahead + off, std::min(distance * std::cos(off), std::max(sight(), radius_)));
    const glm::dvec2 at = way * direction(ahead + off);
    if (const double left = glm::distance(at, to_goal); left < nearest.distance) nearest = {pose_.to_outer(at), left};
  }
  return nearest;
}

std::optional<FarView::Tangent> FarView::tangent(const glm::dvec2& goal, int turn) const {
  // The headings that are free a robot's width beyond where the way to the goal ends.
  const double beyond = std::min(free_toward(goal) + 2.0 * radius_, glm::distance(pose_.position, goal));
  const double radius = 1.1 * radius_;  // a little wider, to pass by without touching
  const Steering steering(contour_, radius, beyond);
  const auto edge = steering.sweep(bearing(pose_.to_inner(goal)), turn);
  if (!edge || !edge->point) return std::nullopt;
  const double off = contour_[*edge->point].distance;
  const double way = std::max(radius, off > radius ? std::sqrt(off * off - radius * radius) : 0.0), heading = wrap_angle(pose_.yaw + edge->heading);
  const glm::dvec2 at = pose_.position + way * direction(heading);
  return Tangent{at, heading, way + glm::distance(at, goal)};
}

}  // namespace thicket

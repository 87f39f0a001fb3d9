#include "far_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

/// How far it is free along a unit vector until a point is nearer than a radius, if that is less than `way` so far.
inline void shorten(double& way, const glm::dvec2& point, const glm::dvec2& along, double radius) {
  const double ahead = point.x * along.x + point.y * along.y;
  if (ahead <= 0.0 || ahead - radius >= way) return;
  const double across = along.x * point.y - along.y * point.x, square = radius * radius - across * across;
  if (square > 0.0) way = std::min(way, std::max(0.0, ahead - std::sqrt(square)));
}

}  // namespace

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
  for (const ContourPoint& point : contour_) shorten(limit, point.position, along, radius_);
  return limit;
}

double FarView::free_toward(const glm::dvec2& point) const {
  return free_way(bearing(pose_.to_inner(point)), std::min(glm::distance(pose_.position, point), sight()));
}

bool FarView::is_free(const glm::dvec2& point) const {
  return free_toward(point) >= std::min(glm::distance(pose_.position, point), sight()) - 1e-9;
}

std::optional<FarView::Place> FarView::place_nearer(const glm::dvec2& goal, double than) const {
  const glm::dvec2 to_goal = pose_.to_inner(goal);
  const double distance = glm::length(to_goal), ahead = bearing(to_goal);
  // Headings every 10 degrees up to 80 on both sides, for from 90 on it gets no nearer; only those that lead near enough if they are free all the way. The widest: `most`.
  constexpr int widest = 8;
  constexpr double spacing = radians(10.0);
  struct Heading {
    glm::dvec2 along{0.0, 0.0};
    double way = 0.0;
  };
  std::array<Heading, 2 * widest + 1> headings;
  int most = -1;
  for (int i = 0; i <= widest; ++i, ++most) {
    const glm::dvec2 off = direction(i * spacing);
    const double limit = std::min(distance * off.x, sight());
    if (glm::distance(limit * off, {distance, 0.0}) >= than) break;
    for (const int side : {-1, 1}) headings[static_cast<std::size_t>(widest + side * i)] = {direction(ahead + side * i * spacing), limit};
  }
  if (most < 0) return std::nullopt;
  // A point is in the way of the headings within asin(radius / distance) of its bearing; asin x <= x pi / 2.
  for (const ContourPoint& point : contour_) {
    double off = point.bearing - ahead;
    off = off > pi ? off - 2.0 * pi : off < -pi ? off + 2.0 * pi : off;
    const double half = point.distance > radius_ ? 0.5 * pi * radius_ / point.distance : 0.5 * pi;
    const int low = std::max(-most, static_cast<int>(std::ceil((off - half) / spacing))), high = std::min(most, static_cast<int>(std::floor((off + half) / spacing)));
    for (int i = low; i <= high; ++i) {
      Heading& heading = headings[static_cast<std::size_t>(widest + i)];
      shorten(heading.way, point.position, heading.along, radius_);
    }
  }
  std::optional<Place> nearest;
  for (int i = -most; i <= most; ++i) {
    const Heading& heading = headings[static_cast<std::size_t>(widest + i)];
    const glm::dvec2 at = heading.way * heading.along;
    if (const double left = glm::distance(at, to_goal); left < (nearest ? nearest->distance : than)) nearest = {pose_.to_outer(at), left};
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

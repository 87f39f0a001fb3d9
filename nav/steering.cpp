#include "thicket/nav/steering.hpp"

#include <algorithm>
#include <cmath>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

/// Half of the interval of headings that a disc of radius `keep` at `distance` blocks within `look_ahead`; 0 for none.
double blocked_half_width(double distance, double keep, double look_ahead) {
  if (distance >= keep + look_ahead) return 0.0;
  // Already too near: whatever leads closer is blocked, and more than that where it is too near by more than a robot swings anyway. (From the first
  // millimetre on, a gap that is open for a robot in its middle would be shut for one that is off by a finger's breadth.)
  if (distance <= keep) return 0.5 * pi + std::min(radians(60.0), std::max(0.0, keep - distance - 0.1 * look_ahead) / look_ahead);
  const double tangent = std::sqrt(distance * distance - keep * keep);
  if (tangent <= look_ahead) return std::asin(keep / distance);
  return std::acos(std::clamp((distance * distance + look_ahead * look_ahead - keep * keep) / (2.0 * distance * look_ahead), -1.0, 1.0));
}

}  // namespace

Steering::Steering(const Contour& contour, double keep, double look_ahead) : contour_(contour) {
  for (std::size_t i = 0; i < contour.size(); ++i)
    if (const double half = blocked_half_width(contour[i].distance, keep, look_ahead); half > 0.0) blocked_.push_back({contour[i].bearing, half, i});
}

std::optional<Steering::Edge> Steering::sweep(double from, int turn) const {
  const double sign = turn > 0 ? 1.0 : -1.0;
  constexpr double touching = 1e-9;  // intervals that only touch leave no heading between them
  Edge edge{from, std::nullopt};
  double turned = 0.0;
  for (;;) {
    // Of all intervals that hold the heading, the one that reaches farthest.
    double farthest = 0.0;
    std::optional<std::size_t> point;
    for (const Blocked& b : blocked_) {
      const double inside = sign * wrap_angle(b.bearing - edge.heading);  // bearing of the disc, in the sense of the turn
      const double reach = inside + b.half_width;
      if (std::abs(inside) < b.half_width + touching && reach > farthest + touching) {
        farthest = reach;
        point = b.point;
      }
    }
    if (!point) {
      edge.open = 2.0 * pi;
      for (const Blocked& b : blocked_) {
        const double to_bearing = sign * wrap_angle(b.bearing - edge.heading);
        edge.open = std::min(edge.open, (to_bearing < 0.0 ? to_bearing + 2.0 * pi : to_bearing) - b.half_width);
      }
      edge.open = std::max(0.0, edge.open);
      return edge;
    }
    turned += farthest;
    if (turned >= 2.0 * pi) return std::nullopt;
    edge.heading = wrap_angle(edge.heading + sign * farthest);
    edge.point = point;
  }
}

Steering::Way Steering::free_way(double heading, double radius, double limit) const {
  Way way{limit, std::nullopt};
  for (std::size_t i = 0; i < contour_.size(); ++i) {
    const ContourPoint& p = contour_[i];
    const double off = wrap_angle(p.bearing - heading);
    const double along = p.distance * std::cos(off), across = std::abs(p.distance * std::sin(off));
    if (along <= 0.0 || across >= radius) continue;
    const double distance = p.distance <= radius ? 0.0 : along - std::sqrt(radius * radius - across * across);
    if (distance < way.distance) way = {std::max(0.0, distance), i};
  }
  return way;
}

}  // namespace thicket

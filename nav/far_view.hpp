// What is free as far as the sensor sees, for a robot of some width. Private to the room.
#pragma once

#include <algorithm>
#include <optional>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/nav/steering.hpp"

namespace thicket {

/// The pilot looks at what is within its reach; this looks at the whole contour. Neighbouring echoes nearer to each other than the robot is wide are joined: it cannot
/// pass between them, and a wall seen at a low angle is no row of poles.
class FarView {
 public:
  /// `radius`: distance that the robot's axis keeps from matter, m.
  explicit FarView(double radius) : radius_(radius) {}

  void look(const Pose2& pose, const Contour& contour);

  /// How far it sees, m: a beam without an echo tells only that nothing is within the sensor's range, which is at least the farthest echo so far.
  double sight() const { return std::max(farthest_, radius_); }

  /// How far the straight way to a point is free, up to the point and to what it sees, m.
  double free_toward(const glm::dvec2& point) const;
  /// The straight way to a point is free, all of it or as far as it sees.
  bool is_free(const glm::dvec2& point) const;

  /// Of all places that can be reached straight, the one nearest to a goal; nothing if none is nearer to it than `than` m.
  struct Place {
    glm::dvec2 at{0.0, 0.0};
    double distance = 0.0;  ///< from there to the goal, m
  };
  std::optional<Place> place_nearer(const glm::dvec2& goal, double than) const;

  /// The end of what stands in the way to a goal, on the left (`turn` > 0) or the right: the heading past it, and the place where the robot is beside it.
  struct Tangent {
    glm::dvec2 at{0.0, 0.0};
    double heading = 0.0;  ///< in the world
    double way = 0.0;      ///< by there to the goal, m
  };
  std::optional<Tangent> tangent(const glm::dvec2& goal, int turn) const;

 private:
  double free_way(double heading, double limit) const;

  double radius_;
  double farthest_ = 0.0;  ///< of all echoes so far, m
  Pose2 pose_;
  Contour contour_;  ///< echoes, joined
};

}  // namespace thicket

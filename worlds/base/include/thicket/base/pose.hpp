// Where things are. x east, y north, z up; yaw counter-clockwise from east; body frame x forward, y left, z up (ROS REP 103).
#pragma once

#include <cmath>
#include <numbers>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace thicket {

inline constexpr double pi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / pi); }

/// The same angle in [-pi, pi].
inline double wrap_angle(double angle) { return std::remainder(angle, 2.0 * pi); }

/// Unit vector of a bearing in the plane.
inline glm::dvec2 direction(double bearing) { return {std::cos(bearing), std::sin(bearing)}; }

/// Bearing of a vector in the plane, rad in [-pi, pi].
inline double bearing(const glm::dvec2& v) { return std::atan2(v.y, v.x); }

/// A pose in the plane: metres and radians.
struct Pose2 {
  glm::dvec2 position{0.0, 0.0};
  double yaw = 0.0;

  /// A point of this pose's frame, in the frame that the pose is given in.
  glm::dvec2 to_outer(const glm::dvec2& point) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return position + glm::dvec2(c * point.x - s * point.y, s * point.x + c * point.y);
  }
  /// The opposite way.
  glm::dvec2 to_inner(const glm::dvec2& point) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    const glm::dvec2 d = point - position;
    return {c * d.x + s * d.y, -s * d.x + c * d.y};
  }
};

/// A pose in space: metres and a unit quaternion. Sensors tilt with the vehicle that carries them.
struct Pose {
  glm::dvec3 position{0.0, 0.0, 0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};

  static Pose planar(double x, double y, double z, double yaw) {
    return {{x, y, z}, {std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw)}};
  }
  /// This frame seen from outside, after `inner` seen from this frame.
  Pose operator*(const Pose& inner) const { return {position + orientation * inner.position, orientation * inner.orientation}; }
};

}  // namespace thicket

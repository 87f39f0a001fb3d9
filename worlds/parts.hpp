// The convex parts that solids are traced as, each with its exact answer to a hull; that to a ray is in part_rays.hpp. Private to the room.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/world.hpp"

namespace thicket {

/// Where a ray is inside a part: ranges (either may be negative), and which face each end lies on, for `part_normal`.
struct PartInterval {
  double enter = 0.0, leave = 0.0;
  std::int8_t enter_face = 0, leave_face = 0;
};

struct SpherePart {
  std::uint32_t solid;
  glm::dvec3 centre;
  double radius;
};
struct CylinderPart {
  std::uint32_t solid;
  glm::dvec3 centre;
  double radius, half_height;
};
/// A box in a frame that may be shared by many (the cells of one map): faces given by equal numbers are equal in every part.
struct BoxPart {
  std::uint32_t solid;
  glm::dvec3 frame;        ///< origin of the frame
  double cosine, sine;     ///< its yaw
  glm::dvec3 low, high;    ///< in the frame
};

struct Parts {
  std::vector<SpherePart> spheres;
  std::vector<CylinderPart> cylinders;
  std::vector<BoxPart> boxes;
};

/// Everything relative to `origin`.
Parts make_parts(const World& world, const glm::dvec3& origin);

Bounds part_bounds(const SpherePart& part);
Bounds part_bounds(const CylinderPart& part);
Bounds part_bounds(const BoxPart& part);

/// Horizontal distance from a vertical axis at `position` to what the part has between two heights; negative inside it, +inf if it has nothing there.
double axis_distance(const SpherePart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const CylinderPart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const BoxPart& part, const glm::dvec2& position, double z_low, double z_high);

}  // namespace thicket

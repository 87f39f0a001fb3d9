// The convex parts that solids are traced as, each with its exact answer to a hull; that to a ray is in part_rays.hpp. Private to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/world.hpp"

namespace thicket {

// A solid that stands upright and still is traced in the scene's frame; any other one, and every mesh, is a *prototype* in its own frame with an *instance*
// for each pose.

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

  std::size_t count() const { return spheres.size() + cylinders.size() + boxes.size(); }
};

/// Appends the parts of a solid that stands upright; nothing for a mesh or a prism. Everything relative to `origin`.
void add_parts(const Solid& solid, std::uint32_t index, const glm::dvec3& origin, Parts& parts);

/// Whether a solid is traced as an instance.
bool needs_instance(const Solid& solid);

/// How far a solid's matter reaches from its position, and what it takes at any time; empty (low above high) for a map without matter.
double reach_of(const Solid& solid);
Bounds whole_extent(const Solid& solid);
/// Of all solids; nothing where there is no matter.
std::optional<Bounds> whole_extent(const World& world);
bool changes_height(const Motion& motion);

/// Distance of a point from a triangle.
double triangle_distance(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// Where an instance stands.
struct Placing {
  glm::dvec3 position{0.0};
  glm::dmat3 turn{1.0};  ///< from the prototype's frame to the outer one
  double scale = 1.0;    ///< not 1 for meshes only
  bool upright = true;   ///< turned about the vertical axis at most

  glm::dvec3 to_outer(const glm::dvec3& p) const { return position + turn * (scale * p); }
  glm::dvec3 to_inner(const glm::dvec3& p) const { return (p - position) * turn / scale; }
  glm::dvec3 direction_to_inner(const glm::dvec3& d) const { return d * turn / scale; }
};

Bounds part_bounds(const SpherePart& part);
Bounds part_bounds(const CylinderPart& part);
Bounds part_bounds(const BoxPart& part);

/// Horizontal distance from a vertical axis at `position` to what the part has between two heights; negative inside it, +inf if it has nothing there.
double axis_distance(const SpherePart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const CylinderPart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const BoxPart& part, const glm::dvec2& position, double z_low, double z_high);

/// The same for a part of an instance that may be tilted.
double axis_distance(const Placing& placing, const SpherePart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const Placing& placing, const CylinderPart& part, const glm::dvec2& position, double z_low, double z_high);
double axis_distance(const Placing& placing, const BoxPart& part, const glm::dvec2& position, double z_low, double z_high);

/// To a flat convex polygon of at most 8 corners, in order; 0 where the axis passes through it between the heights.
double axis_distance(std::span<const glm::dvec3> polygon, const glm::dvec2& position, double z_low, double z_high);

}  // namespace thicket

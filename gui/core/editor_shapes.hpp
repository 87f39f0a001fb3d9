// Solids as seen from above: which is at a point, what they look like there, and what dragging them by a place does.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/worlds/world.hpp"

namespace thicket::gui {

/// Whether a solid, as it stands at a time, has matter above or below a point of the plan. Exact, but for meshes, of which the box that holds them counts.
bool covers(const Solid& solid, const glm::dvec2& point, double time);

/// The smallest solid that covers a point. Boxes that are a floor or ceiling of the world (as large as all of it, up to `ground` or from 2 m above it) are not found.
std::optional<std::uint32_t> solid_at(const World& world, const glm::dvec2& point, double time, double ground);

/// Closed lines that show a solid in the plan at a time: its outline, and that of holes; each leg of a wall by itself.
std::vector<std::vector<glm::dvec2>> rings(const Solid& solid, double time);

/// A place by which a solid can be dragged.
struct Grip {
  enum class Kind { body, corner, radius, point, turn } kind = Kind::body;
  std::size_t index = 0;      ///< of the corner, or of the point
  glm::dvec2 at{0.0, 0.0};
};
/// Corners of upright boxes, the radius of round ones, the points of walls and prisms, and for all but round ones one to turn them by, `reach` (m) beyond them.
std::vector<Grip> grips(const Solid& solid, double time, double reach);

/// The solid after its grip was dragged to a point; the body: by `to - grip.at`. Nothing gets smaller than `least`, m.
Solid dragged(const Solid& solid, const Grip& grip, const glm::dvec2& to, double time, double least = 0.01);

Solid moved(Solid solid, const glm::dvec2& by);

/// Where a point comes to lie on a grid; a grid of 0 leaves it.
glm::dvec2 snapped(const glm::dvec2& point, double grid);

/// New solids on the ground; coordinates are rounded to millimetres so that files stay legible.
Solid new_box(const glm::dvec2& a, const glm::dvec2& b, double ground, double height);
Solid new_sphere(const glm::dvec2& centre, const glm::dvec2& rim, double ground);
Solid new_cylinder(const glm::dvec2& centre, const glm::dvec2& rim, double ground, double height);
Solid new_wall(const std::vector<glm::dvec2>& points, double ground, double thickness, double height);
Solid new_prism(const std::vector<glm::dvec2>& points, double ground, double height);

}  // namespace thicket::gui

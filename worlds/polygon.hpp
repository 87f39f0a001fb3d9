// Simple polygons with holes: checked, and cut into triangles. Not a public header.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace thicket {

using Ring = std::vector<glm::dvec2>;  // closed: its last point is followed by its first

/// Positive if a, b, c turn counter-clockwise, negative if clockwise, 0 if they lie on a line: the sign is exact (as long as products of
/// coordinates neither overflow nor underflow), the magnitude is not.
double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// Whether a ring runs counter-clockwise. Exact for simple rings.
bool counter_clockwise(const Ring& ring);

/// What is wrong with a polygon, as a sentence without its end; nothing for a simple polygon of finite points whose holes lie inside it and
/// meet nothing. Edge k of a ring goes from its point k to the next, counted from 1.
std::optional<std::string> polygon_fault(const Ring& outline, const std::vector<Ring>& holes);

/// Cuts a polygon into counter-clockwise triangles by clipping ears. Indices count the outline's points and then those of each hole. The
/// rings may run either way. Uses every edge of every ring exactly once, also where points lie on a line. Sum of the areas: that of the
/// polygon, if `polygon_fault` finds nothing; otherwise the triangles are as many and as well connected, but may overlap. Time grows with
/// the square of the number of points.
std::vector<glm::uvec3> triangulate(const Ring& outline, const std::vector<Ring>& holes);

/// The same for one ring that is known to run counter-clockwise, and that may touch itself (as where a hole was joined to its outline by an
/// edge there and back).
std::vector<glm::uvec3> triangulate_counter_clockwise(const Ring& ring);

}  // namespace thicket

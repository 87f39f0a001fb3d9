// Tables of points, as sensor files give them. Private to the room.
#pragma once

#include <span>

#include <glm/vec2.hpp>

namespace thicket {

/// The second number of a table at `x`: straight between points, level beyond the ends. The points come by their first number, at least one; two of the same are a step,
/// at which the former counts.
double value_at(std::span<const glm::dvec2> table, double x);

}  // namespace thicket

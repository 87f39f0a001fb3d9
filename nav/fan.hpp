// Beams with an opening, as a fan of thin ones. Private to the room.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "thicket/scan/scan.hpp"

namespace thicket {

/// How many directions `for_fan` gives for a beam of this scan.
inline std::size_t fan_size(const Scan& scan, double spacing) {
  return scan.azimuth_opening <= 0.0 ? 1 : static_cast<std::size_t>(std::ceil(scan.azimuth_opening / spacing)) + 1;
}

/// Calls `use(direction)` with unit vectors of the sensor's frame, `spacing` rad apart or less, that together fill the azimuth opening of a beam; with its own direction where it has none.
template <class Use>
void for_fan(const Scan& scan, const Beam& beam, double spacing, Use&& use) {
  if (scan.azimuth_opening <= 0.0) return use(beam.direction);
  const auto steps = static_cast<std::int64_t>(std::ceil(scan.azimuth_opening / spacing));
  for (std::int64_t i = 0; i <= steps; ++i) {
    const double turn = scan.azimuth_opening * (static_cast<double>(i) / static_cast<double>(steps) - 0.5), c = std::cos(turn), s = std::sin(turn);
    use(glm::dvec3(c * beam.direction.x - s * beam.direction.y, s * beam.direction.x + c * beam.direction.y, beam.direction.z));
  }
}

}  // namespace thicket

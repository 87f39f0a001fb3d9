// The part of the plane that a picture of a run shows, seen from above. Private to the room.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

namespace thicket {

/// Below a line of words, with a margin around.
struct PictureFrame {
  glm::dvec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};  ///< m
  double scale = 10.0;                                             ///< pixels per metre
  static constexpr double margin = 16.0, header = 34.0;

  void hold(const glm::dvec2& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// The pixel of a place.
  glm::dvec2 at(const glm::dvec2& p) const { return {margin + (p.x - low.x) * scale, header + margin + (high.y - p.y) * scale}; }
};

/// A round length of about a fifth of a picture of this width, m.
inline double scale_bar_length(double width_m) {
  const double wanted = width_m / 5.0, power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double step : {5.0, 2.0})
    if (wanted >= step * power) return step * power;
  return power;
}

}  // namespace thicket

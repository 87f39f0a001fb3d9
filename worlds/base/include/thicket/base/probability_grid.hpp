// What is known of the cells of a map, as plain data: for files, pictures and judgements.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

namespace thicket {

/// `probability[row * width + column]`, row 0 at the *bottom* (y grows with the row), so that cell (column, row) covers x in [column, column + 1] * resolution from `origin` and the same for y.
struct ProbabilityGrid {
  static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

  int width = 0;
  int height = 0;
  double resolution = 0.1;         ///< metres a cell, > 0
  glm::dvec2 origin{0.0, 0.0};     ///< world position of the lower-left corner, m
  std::vector<float> probability;  ///< of matter that a beam cannot pass, in (0, 1); NaN: never sensed
  std::vector<std::uint8_t> through;  ///< 1: the last beam through it was inside matter there: penetrable, may still stop motion; empty: nowhere

  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column); }
  bool known(std::size_t i) const { return !std::isnan(probability[i]); }
  bool sensed_through(std::size_t i) const { return !through.empty() && through[i] != 0; }
};

}  // namespace thicket

#include "table.hpp"

#include <algorithm>

namespace thicket {

double value_at(std::span<const glm::dvec2> table, double x) {
  const auto above = std::ranges::lower_bound(table, x, {}, &glm::dvec2::x);
  if (above == table.end()) return table.back().y;
  if (above == table.begin()) return above->y;
  const glm::dvec2& a = *std::prev(above);
  const glm::dvec2& b = *above;
  return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

}  // namespace thicket

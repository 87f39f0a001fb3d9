#include "thicket/worlds/shape_fault.hpp"

#include <fmt/format.h>

#include "polygon.hpp"

namespace thicket {

std::optional<std::string> shape_fault(const Shape& shape) {
  if (const auto* wall = std::get_if<Wall>(&shape)) {
    if (wall->points.size() < 2) return fmt::format("the wall has {} points, expected two or more", wall->points.size());
    for (std::size_t i = 1; i < wall->points.size(); ++i)
      if (wall->points[i] == wall->points[i - 1]) return fmt::format("points {} and {} of the wall are the same, expected different ones", i, i + 1);
  }
  if (const auto* prism = std::get_if<Prism>(&shape))
    if (const auto fault = polygon_fault(prism->outline, prism->holes)) return "the prism is not a simple polygon: " + *fault;
  return std::nullopt;
}

}  // namespace thicket

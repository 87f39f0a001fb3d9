// Scenarios of the MovingAI benchmarks (Sturtevant 2012): lists of starts and goals on a map. Private to the room.
#pragma once

#include <filesystem>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"

namespace thicket {

/// Cells (column, row), with row 0 at the bottom as in `GridMap`. (In the file it is at the top.)
struct Scenario {
  glm::ivec2 start{0, 0}, goal{0, 0};
};

/// The scenarios for a map of `size` cells that lie beside it: in NAME.scen, NAME.map.scen and NAME-*.scen, in the order of these files' names; only rows that name the
/// map's file. Errors: `file:line: what, expected`; rows for a map of another size, cells outside it.
Result<std::vector<Scenario>> read_scenarios(const std::filesystem::path& map, const glm::ivec2& size);

}  // namespace thicket

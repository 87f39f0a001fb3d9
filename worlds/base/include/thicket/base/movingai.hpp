// Grid maps of the MovingAI benchmarks (Sturtevant 2012, "Benchmarks for grid-based pathfinding").
#pragma once

#include <filesystem>

#include "thicket/base/map_file.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// Reads a `.map` file: the lines `type octile`, `height H`, `width W`, `map`, and then H rows of W letters, the top row first (the last row of the grid).
/// `.`, `G` and `S` become free, `@`, `O`, `T` and `W` (water) occupied. Lines may end as on Windows; empty lines may follow the rows.
/// `cell_size`: metres a cell, from least_cell_m to largest_cell_m; the format has none. The grid's origin is 0, 0.
/// Errors: `file:line:column: what, expected`; sizes above max_image_pixels cells are refused before memory is taken.
Result<GridMap> read_movingai_map(const std::filesystem::path& file, double cell_size);

/// Writes a `.map` file: free cells as `.`, occupied and unknown ones as `@`. Resolution and origin are lost. Written to a temporary name and renamed.
Result<Done> write_movingai_map(const std::filesystem::path& file, const GridMap& map);

}  // namespace thicket

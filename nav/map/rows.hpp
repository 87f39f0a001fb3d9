// Taking a row of a window into a row of a tile: many cells at once. Private to the room.
#pragma once

#include <cstdint>

#include "window.hpp"

namespace thicket {

/// How a code changes a cell.
struct Rule {
  int low = 0, high = 0;  ///< clamps, in the cells' units
  bool limit = false;     ///< false: evidence adds to the log-odds. True: a look that is no new witness brings a cell to where a first look would bring it, and no farther
};

/// For `tile_size` cells. `touched` gets a bit for each cell with a code; the codes are 0 afterwards.
std::uint64_t take_row(std::int8_t* values, Code* codes, const Rule& rule);
std::uint64_t take_row(std::int16_t* values, Code* codes, const Rule& rule);

}  // namespace thicket

// Taking what a window says into a tile: many cells at once. Private to the room.
#pragma once

#include <array>
#include <cstdint>

#include "window.hpp"

namespace thicket {

/// How a code changes a cell.
struct Rule {
  int low = 0, high = 0;  ///< clamps, in the cells' units
  bool limit = false;     ///< false: evidence adds to the log-odds. True: a look that is no new witness brings a cell to where a first look would bring it, and no farther
};

/// What was taken from rows of `tile_size` codes.
struct Taken {
  int cells = 0;                                   ///< with a code
  std::array<bool, blocks_per_side> in_block{};  ///< of each block along the row: whether it has such cells
};

/// Whether any of the `block_size` rows of `tile_size` codes has one; rows lie `stride` apart.
bool any_code(const Code* codes, std::int64_t stride);
/// Takes as many rows into the rows of a tile, whose values follow each other. The codes are 0 afterwards.
Taken take_rows(std::int8_t* values, Code* codes, std::int64_t stride, const Rule& rule);
Taken take_rows(std::int16_t* values, Code* codes, std::int64_t stride, const Rule& rule);
/// A bit for each of `tile_size` codes that is not 0.
std::uint64_t touched_of(const Code* codes);

}  // namespace thicket

// Taking what a window says into a tile: many cells at once. Private to the room.
#pragma once

#include <array>
#include <cstdint>

#include "tables.hpp"

namespace thicket {

/// How a code changes a cell.
struct Rule {
  int low = 0, high = 0;  ///< clamps, in the cells' units
  bool limit = false;     ///< false: evidence adds to the log-odds. True: a look that is no new witness brings a cell as far as a first look would, a step a scan, and no farther
};

/// What was taken from rows of `tile_size` codes.
struct Taken {
  int cells = 0;                                   ///< with a code
  std::array<bool, blocks_per_side> in_block{};  ///< of each block along the row: whether it has such cells
};

/// Codes become `to` at least.
void raise_all(Code* codes, std::int64_t count, Code to);
/// Cells of an arc come in pieces of a row.
inline constexpr int piece_size = 16;
struct Piece {
  Code* codes;
  float greatest;                              ///< of the likelihoods
  std::array<Level, piece_size> levels{};
  std::array<float, piece_size> likelihood;  ///< odds times the normal error of the range; 0 where the cell is not of the arc
};
struct Arc {
  float radius = 0.0f, per_spread = 0.0f;        ///< in cells; one over the spread
  const float* odds = nullptr;                   ///< for each level
  std::array<float, piece_size> sums{};        ///< of all likelihoods, place by place: so the same on every machine
};
/// Makes a piece of the first `count` cells at its codes and levels: the first of them lies `along` from the middle of the arc, its row a distance whose square is `square`. In cells.
void add_piece(Arc& arc, float along, float square, int count, Piece& piece);
/// Whether any of the `block_size` rows of `tile_size` codes has one; rows lie `stride` apart.
bool any_code(const Code* codes, std::int64_t stride);
/// Takes as many rows into the rows of a tile, whose values follow each other. The codes are 0 afterwards.
Taken take_rows(std::int8_t* values, Code* codes, std::int64_t stride, const Rule& rule);
Taken take_rows(std::int16_t* values, Code* codes, std::int64_t stride, const Rule& rule);
/// A bit for each of `tile_size` codes that is not 0.
std::uint64_t touched_of(const Code* codes);

}  // namespace thicket

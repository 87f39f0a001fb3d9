// What a map keeps of a square of cells. Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "thicket/nav/occupancy_map.hpp"

namespace thicket {

inline constexpr int tile_bits = 6, tile_size = 1 << tile_bits, tile_cells = tile_size * tile_size;
inline constexpr int block_bits = 3, block_size = 1 << block_bits, blocks_per_side = tile_size >> block_bits;  ///< "last seen" is kept for blocks of 8 x 8 cells

/// Log-odds as whole numbers.
template <class Cell>
struct Units;
template <>
struct Units<std::int8_t> {
  static constexpr double per_nat = 32.0;
};
template <>
struct Units<std::int16_t> {
  static constexpr double per_nat = 4096.0;
};
template <class Cell>
inline constexpr Cell unknown_cell = std::numeric_limits<Cell>::min();

inline CellIndex tile_of(const CellIndex& cell) { return {cell.column >> tile_bits, cell.row >> tile_bits}; }  // arithmetic shifts: floors
inline std::size_t place_in_tile(const CellIndex& cell) { return static_cast<std::size_t>(cell.row & (tile_size - 1)) << tile_bits | static_cast<std::size_t>(cell.column & (tile_size - 1)); }
inline std::size_t block_of(std::size_t place) { return (place >> (tile_bits + block_bits)) * blocks_per_side + ((place & (tile_size - 1)) >> block_bits); }

template <class Cell>
struct Tile {
  using Bits = std::array<std::uint64_t, tile_size>;  ///< a bit a cell, a word a row

  std::array<Cell, tile_cells> values;                      ///< log-odds; `unknown_cell`: never sensed
  std::array<float, blocks_per_side * blocks_per_side> seen;  ///< s, when anything of the block was last sensed
  std::unique_ptr<Bits> through;                            ///< sensed through; null: no cell is

  Tile() {
    values.fill(unknown_cell<Cell>);
    seen.fill(-std::numeric_limits<float>::infinity());
  }
  Tile(const Tile& other) : values(other.values), seen(other.seen), through(other.through ? std::make_unique<Bits>(*other.through) : nullptr) {}
  Tile& operator=(const Tile& other) {
    if (this != &other) *this = Tile(other);
    return *this;
  }
  Tile(Tile&&) = default;
  Tile& operator=(Tile&&) = default;
  ~Tile() = default;

  bool is_through(std::size_t place) const { return through && ((*through)[place >> tile_bits] >> (place & (tile_size - 1)) & 1) != 0; }
  void set_through(std::size_t place) {
    if (!through) through = std::make_unique<Bits>(Bits{});
    (*through)[place >> tile_bits] |= std::uint64_t{1} << (place & (tile_size - 1));
  }
  std::size_t bytes() const { return sizeof(Tile) + (through ? sizeof(Bits) : 0); }
};

}  // namespace thicket

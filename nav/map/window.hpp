// A scan as it is drawn, before it is taken into a map's tiles. Private to the room.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "tile.hpp"

namespace thicket {

inline constexpr double evidence_per_nat = 32.0;  ///< what a scan says of a cell comes in these, whatever the cells of the map are

/// What a scan says of a cell: 0 nothing, else evidence + 128, in 1/32 nat of log-odds. Where several beams say something the greatest counts: occupied wins over free.
using Code = std::uint8_t;
inline constexpr int no_evidence = 128, most_evidence = 127;
constexpr Code code_of(int evidence) { return static_cast<Code>(no_evidence + std::clamp(evidence, -most_evidence, most_evidence)); }

/// A square of cells around a sensor. Scratch: a copy of a map starts with an empty one.
class Window {
 public:
  Window() = default;
  Window(const Window&) : Window() {}
  Window& operator=(const Window&) { return *this; }
  Window(Window&&) = default;
  Window& operator=(Window&&) = default;
  ~Window() = default;

  /// Puts it around a cell, on the grid of the tiles, `reach` cells to each side. Everything in it must be untouched: as it was made, or left behind by `take_rows`.
  void place(const CellIndex& centre, std::int64_t reach) {
    tiles_ = (2 * reach + 1) / tile_size + 2;
    const auto cells = static_cast<std::size_t>(stride() * tiles_ * tile_size);
    if (codes_.size() < cells) codes_.resize(cells, 0);
    low_ = tile_of({centre.column - reach, centre.row - reach});
    marked_ = {{tiles_, tiles_}, {-1, -1}};
  }
  /// From a row to the next: an odd number of tiles, for a power of two would put all cells of a column into one set of the cache.
  std::int64_t stride() const { return (tiles_ | 1) * tile_size; }
  std::int64_t tiles() const { return tiles_; }
  /// The tile of its lower-left cell.
  const CellIndex& low() const { return low_; }
  /// The lower-left corner, in cells.
  CellIndex corner() const { return {low_.column * tile_size, low_.row * tile_size}; }
  /// A point of the world, m, in cells from that corner.
  glm::dvec2 place_of(const glm::dvec2& point, double resolution) const { return point / resolution - glm::dvec2(static_cast<double>(corner().column), static_cast<double>(corner().row)); }
  Code* at(std::int64_t column, std::int64_t row) { return codes_.data() + row * stride() + column; }

  /// A rectangle in which cells are drawn, in cells, is to be marked: what was never marked is not taken.
  void mark(const glm::dvec2& low, const glm::dvec2& high) {
    const auto tile = [&](double cell) { return std::clamp(static_cast<std::int64_t>(std::floor(cell)) >> tile_bits, std::int64_t{0}, tiles_ - 1); };
    marked_.first = {std::min(marked_.first.column, tile(low.x - 1.0)), std::min(marked_.first.row, tile(low.y - 1.0))};
    marked_.second = {std::max(marked_.second.column, tile(high.x + 1.0)), std::max(marked_.second.row, tile(high.y + 1.0))};
  }
  /// The first and the last tile that was marked, of this window's; none: the last is before the first.
  const std::pair<CellIndex, CellIndex>& marked() const { return marked_; }

  /// Cells sensed through, in a plane of its own that exists from the first such cell on.
  void set_through(std::int64_t column, std::int64_t row) {
    if (through_.size() < codes_.size()) through_.resize(codes_.size(), 0);
    through_[static_cast<std::size_t>(row * stride() + column)] = 1;
    any_through_ = true;
  }
  std::uint8_t* through_at(std::int64_t column, std::int64_t row) { return any_through_ ? through_.data() + row * stride() + column : nullptr; }
  /// Cells that this one tells something of become untouched in the other, which lies in the same place.
  void take_from(Window& other) {
    const auto first = static_cast<std::size_t>(marked_.first.row * tile_size * stride()), past = static_cast<std::size_t>((marked_.second.row + 1) * tile_size * stride());
    for (std::size_t i = first; i < past; ++i) other.codes_[i] = codes_[i] != 0 ? Code{0} : other.codes_[i];
  }
  bool any_through() const { return any_through_; }
  void no_more_through() { any_through_ = false; }

 private:
  std::vector<Code> codes_;
  std::vector<std::uint8_t> through_;
  bool any_through_ = false;
  std::int64_t tiles_ = 0;
  CellIndex low_;
  std::pair<CellIndex, CellIndex> marked_;
};

}  // namespace thicket

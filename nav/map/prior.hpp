// What a map knew of the cells of a window before a scan. Private to the room.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "cells.hpp"
#include "rows.hpp"

namespace thicket {

/// The tiles of a window, looked up when they are first asked for. Scratch: a copy of a map starts with an empty one.
class Prior {
 public:
  Prior() = default;
  Prior(const Prior&) : Prior() {}

  /// Valid until the cells change.
  void place(const Cells& cells, const Window& window) {
    cells_ = &cells;
    low_ = window.low();
    columns_ = window.tiles();
    tiles_.assign(static_cast<std::size_t>(columns_ * columns_), nullptr);
    used_ = 0;
  }
  /// Of a cell of the window, and those that follow it in the row as far as the tile goes.
  const Level* at(std::int64_t column, std::int64_t row) {
    const Level*& tile = tiles_[static_cast<std::size_t>((row >> tile_bits) * columns_ + (column >> tile_bits))];
    if (!tile) tile = look_up({low_.column + (column >> tile_bits), low_.row + (row >> tile_bits)});
    return tile + place_in_tile({column, row});
  }
  /// Of `count` cells of a row, as many as a piece has at most; of the rest of the piece anything.
  void copy(std::int64_t column, std::int64_t row, int count, std::array<Level, piece_size>& levels) {
    const int in_tile = tile_size - static_cast<int>(column & (tile_size - 1));
    if (in_tile >= piece_size) {
      std::memcpy(levels.data(), at(column, row), piece_size);
      return;
    }
    std::copy_n(at(column, row), std::min(count, in_tile), levels.begin());
    if (count > in_tile) std::copy_n(at(column + in_tile, row), count - in_tile, levels.begin() + in_tile);
  }

 private:
  using Levels = std::array<std::int8_t, tile_cells>;
  const Level* look_up(const CellIndex& tile) {
    static const Levels nothing{};
    if (used_ == made_.size()) made_.push_back(std::make_unique<Levels>());
    const std::int8_t* levels = cells_->levels(tile, made_[used_]->data());
    if (levels == made_[used_]->data()) ++used_;
    return reinterpret_cast<const Level*>(levels ? levels : nothing.data());
  }

  const Cells* cells_ = nullptr;
  CellIndex low_;
  std::int64_t columns_ = 0;
  std::vector<const Level*> tiles_;
  std::vector<std::unique_ptr<Levels>> made_;  ///< of maps that do not keep them as they are asked for
  std::size_t used_ = 0;
};

}  // namespace thicket

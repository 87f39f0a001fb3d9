#include "cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "store.hpp"

namespace thicket {
namespace {

template <class Cell>
int to_units(double probability) {
  return static_cast<int>(std::lround(Units<Cell>::per_nat * std::log(probability / (1.0 - probability))));
}

template <class Cell>
class CellsOf final : public Cells {
 public:
  explicit CellsOf(const MapSpec& spec)
      : store_(make_store<Cell>(spec.store, to_units<Cell>(0.5 + spec.tolerance))), low_(to_units<Cell>(spec.clamp_low)), high_(to_units<Cell>(spec.clamp_high)) {}
  CellsOf(const CellsOf& other) : store_(other.store_->clone()), low_(other.low_), high_(other.high_) {}
  std::unique_ptr<Cells> clone() const override { return std::make_unique<CellsOf>(*this); }

  std::size_t take(Window& window, bool limit, double time) override {
    std::size_t cells = 0;
    const auto [first, last] = window.marked();
    for (std::int64_t row = first.row; row <= last.row; ++row)
      for (std::int64_t column = first.column; column <= last.column; ++column) cells += take_tile(window, column, row, {low_, high_, limit}, time);
    window.no_more_through();
    return cells;
  }

  CellView view(const CellIndex& cell) const override {
    const Tile<Cell>* tile = find(tile_of(cell));
    return tile ? view_of(*tile, place_in_tile(cell)) : CellView{};
  }

  const std::int8_t* levels(const CellIndex& index, std::int8_t* scratch) const override {
    const Tile<Cell>* tile = store_->find(index, scratch_);
    cached_ = nullptr;
    if (!tile) return nullptr;
    if constexpr (sizeof(Cell) == 1) {
      if (tile != &scratch_) return tile->values.data();
    }
    constexpr int scale = static_cast<int>(Units<Cell>::per_nat / evidence_per_nat);
    for (std::size_t place = 0; place < tile_cells; ++place) {
      const int value = tile->values[place];
      scratch[place] = static_cast<std::int8_t>(value == unknown_cell<Cell> ? 0 : (value + (value < 0 ? -scale : scale) / 2) / scale);
    }
    return scratch;
  }

  void put(const CellIndex& cell, double probability, bool through, double time) override {
    const CellIndex index = tile_of(cell);
    const std::size_t place = place_in_tile(cell);
    Tile<Cell>& tile = store_->open(index);
    tile.values[place] = std::isnan(probability) ? unknown_cell<Cell> : static_cast<Cell>(std::clamp(to_units<Cell>(std::clamp(probability, 1e-6, 1.0 - 1e-6)), low_, high_));
    if (through) tile.set_through(place);
    else if (tile.through) (*tile.through)[place >> tile_bits] &= ~(std::uint64_t{1} << (place & (tile_size - 1)));
    tile.seen[block_of(place)] = static_cast<float>(time);
    store_->close(index);
    cached_ = nullptr;
  }

  bool surely_free(const CellIndex& cell) const override {
    const Tile<Cell>* tile = find(tile_of(cell));
    if (!tile) return false;
    const Cell value = tile->values[place_in_tile(cell)];
    return value != unknown_cell<Cell> && value <= low_;
  }

  std::size_t known() const override {
    std::size_t count = 0;
    store_->each([&](const CellIndex&, const Tile<Cell>& t) { count += static_cast<std::size_t>(std::count_if(t.values.begin(), t.values.end(), [](Cell v) { return v != unknown_cell<Cell>; })); });
    return count;
  }
  std::size_t memory_bytes() const override { return store_->memory_bytes(); }

  std::optional<std::pair<CellIndex, CellIndex>> extent() const override {
    std::optional<std::pair<CellIndex, CellIndex>> all;
    each(nullptr, [&](const CellIndex& cell, const CellView&) {
      if (!all) all = {cell, {cell.column + 1, cell.row + 1}};
      all->first = {std::min(all->first.column, cell.column), std::min(all->first.row, cell.row)};
      all->second = {std::max(all->second.column, cell.column + 1), std::max(all->second.row, cell.row + 1)};
    });
    return all;
  }

  void each(const Cells* since, const std::function<void(const CellIndex&, const CellView&)>& use) const override {
    const CellsOf* before = static_cast<const CellsOf*>(since);
    std::vector<CellIndex> tiles;
    store_->each([&](const CellIndex& index, const Tile<Cell>&) {
      if (!before || !store_->shares(*before->store_, index)) tiles.push_back(index);
    });
    std::sort(tiles.begin(), tiles.end(), [](const CellIndex& a, const CellIndex& b) { return std::pair(a.row, a.column) < std::pair(b.row, b.column); });
    Tile<Cell> scratch;
    for (const CellIndex& index : tiles) {
      const Tile<Cell>& tile = *store_->find(index, scratch);
      for (std::size_t place = 0; place < tile_cells; ++place)
        if (tile.values[place] != unknown_cell<Cell>)
          use({index.column * tile_size + static_cast<std::int64_t>(place & (tile_size - 1)), index.row * tile_size + static_cast<std::int64_t>(place >> tile_bits)}, view_of(tile, place));
    }
  }

  void changed_tiles(const Cells* other, const std::function<void(const CellIndex&, std::span<const CellLook>)>& use) const override {
    const CellsOf* before = static_cast<const CellsOf*>(other);
    std::vector<CellLook> looks(tile_cells);
    store_->each([&](const CellIndex& index, const Tile<Cell>& tile) {
      if (before && store_->shares(*before->store_, index)) return;
      for (std::size_t place = 0; place < tile_cells; ++place) {
        const Cell value = tile.values[place];
        looks[place] = value == unknown_cell<Cell> ? CellLook{} : CellLook{share_of(value), true, tile.is_through(place), value <= low_};
      }
      use({index.column * tile_size, index.row * tile_size}, looks);
    });
    if (!before) return;
    std::fill(looks.begin(), looks.end(), CellLook{});
    Tile<Cell> scratch;
    before->store_->each([&](const CellIndex& index, const Tile<Cell>&) {
      if (!store_->find(index, scratch)) use({index.column * tile_size, index.row * tile_size}, looks);
    });
  }

 private:
  /// The probability of a value, 0 ... 255, from a table of what eight bits can say: nobody sees more.
  static std::uint8_t share_of(Cell value) {
    static const auto table = [] {
      std::array<std::uint8_t, 256> shares{};
      for (int i = 0; i < 256; ++i) shares[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 / (1.0 + std::exp(-(i - 128) / Units<std::int8_t>::per_nat))));
      return shares;
    }();
    constexpr int scale = static_cast<int>(Units<Cell>::per_nat / Units<std::int8_t>::per_nat);
    return table[static_cast<std::size_t>(std::clamp(static_cast<int>(value) / scale + 128, 0, 255))];
  }

  CellView view_of(const Tile<Cell>& tile, std::size_t place) const {
    const Cell value = tile.values[place];
    if (value == unknown_cell<Cell>) return {};
    return {true, 1.0 / (1.0 + std::exp(-value / Units<Cell>::per_nat)), tile.is_through(place), tile.seen[block_of(place)]};
  }

  /// The tile that was asked for last is at hand: neighbours are asked one after another.
  const Tile<Cell>* find(const CellIndex& index) const {
    if (!cached_ || !(cached_index_ == index)) {
      cached_ = store_->find(index, scratch_);
      cached_index_ = index;
    }
    return cached_;
  }

  std::size_t take_tile(Window& window, std::int64_t column, std::int64_t row, const Rule& rule, double time) {
    const CellIndex index{window.low().column + column, window.low().row + row};
    Tile<Cell>* tile = nullptr;
    std::size_t cells = 0;
    for (int block = 0; block < blocks_per_side; ++block) {
      const std::int64_t first = row * tile_size + block * block_size;
      Code* const codes = window.at(column * tile_size, first);
      if (!any_code(codes, window.stride())) continue;
      if (!tile) {
        tile = &store_->open(index);
        cached_ = nullptr;
      }
      if (tile->through || window.any_through()) take_through(window, column * tile_size, first, *tile, block * block_size);
      const Taken taken = take_rows(tile->values.data() + block * block_size * tile_size, codes, window.stride(), rule);
      cells += static_cast<std::size_t>(taken.cells);
      for (std::size_t b = 0; b < blocks_per_side; ++b)
        if (taken.in_block[b]) tile->seen[static_cast<std::size_t>(block * blocks_per_side) + b] = static_cast<float>(time);
    }
    if (tile) store_->close(index);
    return cells;
  }

  /// Sensed through is what a beam passed inside of matter, unless another met a surface there.
  static void take_through(Window& window, std::int64_t column, std::int64_t row, Tile<Cell>& tile, int row_of_tile) {
    for (int y = 0; y < block_size; ++y) {
      const Code* codes = window.at(column, row + y);
      std::uint64_t passed = 0;
      if (std::uint8_t* through = window.through_at(column, row + y)) {
        for (int i = 0; i < tile_size; ++i) passed |= std::uint64_t{through[i] != 0 && codes[i] <= no_evidence} << i;
        std::fill(through, through + tile_size, std::uint8_t{0});
      }
      const std::uint64_t touched = touched_of(codes);
      if ((!tile.through && passed == 0) || touched == 0) continue;
      if (!tile.through) tile.through = std::make_unique<typename Tile<Cell>::Bits>(typename Tile<Cell>::Bits{});
      auto& bits = (*tile.through)[static_cast<std::size_t>(row_of_tile + y)];
      bits = (bits & ~touched) | passed;
    }
  }

  std::unique_ptr<Store<Cell>> store_;
  int low_, high_;
  mutable Tile<Cell> scratch_;
  mutable const Tile<Cell>* cached_ = nullptr;
  mutable CellIndex cached_index_;
};

}  // namespace

std::unique_ptr<Cells> make_cells(const MapSpec& spec) {
  if (spec.cell_bits == 16) return std::make_unique<CellsOf<std::int16_t>>(spec);
  return std::make_unique<CellsOf<std::int8_t>>(spec);
}

}  // namespace thicket

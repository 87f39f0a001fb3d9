#include "store.hpp"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "quadtree.hpp"

namespace thicket {
namespace {

/// Tiles that exist only where something was seen. Copies share them until one of the copies writes.
template <class Cell>
class TileStore final : public Store<Cell> {
 public:
  std::unique_ptr<Store<Cell>> clone() const override { return std::make_unique<TileStore>(*this); }

  Tile<Cell>& open(const CellIndex& index) override {
    auto& shared = tiles_[index];
    if (!shared) shared = std::make_shared<Tile<Cell>>();
    else if (shared.use_count() > 1) shared = std::make_shared<Tile<Cell>>(*shared);
    return *shared;
  }
  void close(const CellIndex&) override {}
  const Tile<Cell>* find(const CellIndex& index, Tile<Cell>&) const override {
    const auto found = tiles_.find(index);
    return found == tiles_.end() ? nullptr : found->second.get();
  }
  void each(const std::function<void(const CellIndex&, const Tile<Cell>&)>& use) const override {
    for (const auto& [index, tile] : tiles_) use(index, *tile);
  }
  bool shares(const Store<Cell>& other, const CellIndex& index) const override {
    const auto& tiles = static_cast<const TileStore&>(other).tiles_;
    const auto here = tiles_.find(index), there = tiles.find(index);
    return here != tiles_.end() && there != tiles.end() && here->second == there->second;
  }
  std::size_t memory_bytes() const override {
    // A node of the table: its link and value; the block that counts a tile's owners; and the table's buckets.
    std::size_t bytes = tiles_.bucket_count() * sizeof(void*);
    for (const auto& [index, tile] : tiles_) bytes += tile->bytes() + sizeof(void*) + sizeof(typename decltype(tiles_)::value_type) + 2 * sizeof(void*);
    return bytes;
  }

 private:
  std::unordered_map<CellIndex, std::shared_ptr<Tile<Cell>>, IndexHash> tiles_;
};

/// One rectangle of tiles, which grows by half of itself where something is seen beyond: what a map of known size costs. A copy copies all of it.
template <class Cell>
class DenseStore final : public Store<Cell> {
 public:
  std::unique_ptr<Store<Cell>> clone() const override { return std::make_unique<DenseStore>(*this); }

  Tile<Cell>& open(const CellIndex& index) override {
    if (!holds(index)) grow(index);
    return tiles_[at(index)];
  }
  void close(const CellIndex&) override {}
  const Tile<Cell>* find(const CellIndex& index, Tile<Cell>&) const override { return holds(index) ? &tiles_[at(index)] : nullptr; }
  void each(const std::function<void(const CellIndex&, const Tile<Cell>&)>& use) const override {
    for (std::int64_t row = 0; row < height_; ++row)
      for (std::int64_t column = 0; column < width_; ++column) {
        const CellIndex index{low_.column + column, low_.row + row};
        const Tile<Cell>& tile = tiles_[at(index)];
        if (std::any_of(tile.values.begin(), tile.values.end(), [](Cell value) { return value != unknown_cell<Cell>; })) use(index, tile);
      }
  }
  /// Nothing is shared, but what is the same is told: tiles are compared faster than used.
  bool shares(const Store<Cell>& other, const CellIndex& index) const override {
    const DenseStore& dense = static_cast<const DenseStore&>(other);
    if (!holds(index) || !dense.holds(index)) return false;
    const Tile<Cell>&here = tiles_[at(index)], &there = dense.tiles_[dense.at(index)];
    const bool same_through = here.through && there.through ? *here.through == *there.through : !here.through && !there.through;
    return same_through && here.values == there.values && here.seen == there.seen;
  }
  std::size_t memory_bytes() const override {
    std::size_t bytes = 0;
    for (const auto& tile : tiles_) bytes += tile.bytes();
    return bytes;
  }

 private:
  bool holds(const CellIndex& i) const { return i.column >= low_.column && i.row >= low_.row && i.column < low_.column + width_ && i.row < low_.row + height_; }
  std::size_t at(const CellIndex& i) const { return static_cast<std::size_t>((i.row - low_.row) * width_ + (i.column - low_.column)); }
  void grow(const CellIndex& index) {
    const auto stretch = [](std::int64_t low, std::int64_t size, std::int64_t to) -> std::pair<std::int64_t, std::int64_t> {
      if (size == 0) return {to, 1};
      const std::int64_t more = size / 2 + 1;
      if (to < low) return {std::min(to, low - more), low + size - std::min(to, low - more)};
      if (to >= low + size) return {low, std::max(to + 1 - low, size + more)};
      return {low, size};
    };
    DenseStore grown;
    std::tie(grown.low_.column, grown.width_) = stretch(low_.column, width_, index.column);
    std::tie(grown.low_.row, grown.height_) = stretch(low_.row, height_, index.row);
    grown.tiles_.resize(static_cast<std::size_t>(grown.width_ * grown.height_));
    for (std::int64_t row = 0; row < height_; ++row)
      for (std::int64_t column = 0; column < width_; ++column) {
        const CellIndex i{low_.column + column, low_.row + row};
        grown.tiles_[grown.at(i)] = std::move(tiles_[at(i)]);
      }
    *this = std::move(grown);
  }

  CellIndex low_;
  std::int64_t width_ = 0, height_ = 0;
  std::vector<Tile<Cell>> tiles_;
};

/// A forest of quadtrees, a tree a tile: where all cells of a square are within the tolerance of each other it is one leaf.
template <class Cell>
class QuadtreeStore final : public Store<Cell> {
 public:
  explicit QuadtreeStore(int tolerance) : tolerance_(std::min(tolerance, Quadtree<Cell>::most_error)) {}
  std::unique_ptr<Store<Cell>> clone() const override { return std::make_unique<QuadtreeStore>(*this); }

  Tile<Cell>& open(const CellIndex& index) override {
    const auto found = trees_.find(index);
    open_ = Tile<Cell>();
    open_errors_.fill(0);
    if (found != trees_.end()) found->second.expand(open_, &open_errors_);
    return open_;
  }
  void close(const CellIndex& index) override { trees_[index] = Quadtree<Cell>(open_, open_errors_, tolerance_); }
  const Tile<Cell>* find(const CellIndex& index, Tile<Cell>& scratch) const override {
    const auto found = trees_.find(index);
    if (found == trees_.end()) return nullptr;
    scratch = Tile<Cell>();
    found->second.expand(scratch, nullptr);
    return &scratch;
  }
  void each(const std::function<void(const CellIndex&, const Tile<Cell>&)>& use) const override {
    Tile<Cell> scratch;
    for (const auto& [index, tree] : trees_) {
      scratch = Tile<Cell>();
      tree.expand(scratch, nullptr);
      use(index, scratch);
    }
  }
  bool shares(const Store<Cell>& other, const CellIndex& index) const override {
    const auto& trees = static_cast<const QuadtreeStore&>(other).trees_;
    const auto here = trees_.find(index), there = trees.find(index);
    return here != trees_.end() && there != trees.end() && here->second.same_as(there->second);
  }
  std::size_t memory_bytes() const override {
    std::size_t bytes = trees_.bucket_count() * sizeof(void*);
    for (const auto& [index, tree] : trees_) bytes += sizeof(void*) + sizeof(typename decltype(trees_)::value_type) + tree.heap_bytes();
    return bytes;
  }

 private:
  int tolerance_;
  std::unordered_map<CellIndex, Quadtree<Cell>, IndexHash> trees_;
  Tile<Cell> open_;
  typename Quadtree<Cell>::Errors open_errors_{};
};

}  // namespace

template <class Cell>
std::unique_ptr<Store<Cell>> make_store(const std::string& name, int tolerance) {
  if (name == "dense") return std::make_unique<DenseStore<Cell>>();
  if (name == "quadtree") return std::make_unique<QuadtreeStore<Cell>>(tolerance);
  return std::make_unique<TileStore<Cell>>();
}

template std::unique_ptr<Store<std::int8_t>> make_store(const std::string&, int);
template std::unique_ptr<Store<std::int16_t>> make_store(const std::string&, int);

}  // namespace thicket

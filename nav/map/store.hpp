// Where a map's tiles are kept. Private to the room.
#pragma once

#include <functional>
#include <memory>

#include "tile.hpp"

namespace thicket {

/// Tiles by index. All stores answer alike; they differ in memory, and in what a copy costs.
template <class Cell>
class Store {
 public:
  virtual ~Store() = default;
  virtual std::unique_ptr<Store> clone() const = 0;

  /// The tile, made if there is none, to be changed; `close` it before another is opened.
  virtual Tile<Cell>& open(const CellIndex& tile) = 0;
  virtual void close(const CellIndex& tile) = 0;
  /// The tile, or null where nothing was ever sensed. `scratch` may hold it: valid until that or the store changes.
  virtual const Tile<Cell>* find(const CellIndex& tile, Tile<Cell>& scratch) const = 0;
  /// Every tile in which something was sensed, in no particular order.
  virtual void each(const std::function<void(const CellIndex&, const Tile<Cell>&)>& use) const = 0;
  /// The tile is the very one of the other store (of the same kind), or like it in everything. False: it may have changed.
  virtual bool shares(const Store& other, const CellIndex& tile) const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

/// `tolerance`: in units of the cells, of the quadtree.
template <class Cell>
std::unique_ptr<Store<Cell>> make_store(const std::string& name, int tolerance);

struct IndexHash {
  std::size_t operator()(const CellIndex& i) const {
    return static_cast<std::size_t>(i.column) * 0x9e3779b97f4a7c15u ^ static_cast<std::size_t>(i.row) * 0xc2b2ae3d27d4eb4fu;
  }
};

}  // namespace thicket

// The cells of a map, whatever their width and wherever they are kept. Private to the room.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "rows.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "window.hpp"

namespace thicket {

class Cells {
 public:
  virtual ~Cells() = default;
  virtual std::unique_ptr<Cells> clone() const = 0;

  /// Takes in a window and leaves it untouched. How many cells it told something of.
  virtual std::size_t take(Window& window, bool limit, double time) = 0;
  virtual CellView view(const CellIndex& cell) const = 0;
  /// Log-odds of a tile's cells in 1/32 nat, row by row; `unknown_cell` may stand for 0. Null: nothing is known of it. `scratch`, of `tile_cells`, may hold them: valid until that or the map changes.
  virtual const std::int8_t* levels(const CellIndex& tile, std::int8_t* scratch) const = 0;
  /// A cell as it is read from a file or an update; NaN: unknown.
  virtual void put(const CellIndex& cell, double probability, bool through, double time) = 0;
  virtual bool surely_free(const CellIndex& cell) const = 0;
  virtual std::size_t known() const = 0;
  virtual std::size_t memory_bytes() const = 0;
  virtual std::optional<std::pair<CellIndex, CellIndex>> extent() const = 0;
  /// Calls `use(cell, view)` for known cells, tile after tile by row and column; only of tiles that `since`, if given (cells of the same kind), does not share.
  virtual void each(const Cells* since, const std::function<void(const CellIndex&, const CellView&)>& use) const = 0;
  /// As `OccupancyMap::changed_tiles`; `other`, if given, is of the same kind.
  virtual void changed_tiles(const Cells* other, const std::function<void(const CellIndex&, std::span<const CellLook>)>& use) const = 0;
};

std::unique_ptr<Cells> make_cells(const MapSpec& spec);

}  // namespace thicket

// A tile as a quadtree (Kraetzschmar, Gassull & Uhl, "Probabilistic quadtrees for variable-resolution mapping of large environments", IAV 2004). Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tile.hpp"

namespace thicket {

/// A tile in few bytes: an inner node is a bit, a leaf a bit and a value (and whether it was sensed through). Squares of equal cells become one leaf; so do, with a tolerance, squares of nearly equal ones, of which the
/// leaf then has the middle. "Last seen" is one time for the whole tile.
///
/// Merging loses something each time. How much each leaf may be off what its cells would be without merging is kept with it, and nothing is merged that would bring it above the tolerance.
template <class Cell>
class Quadtree {
 public:
  using Errors = std::array<std::uint8_t, tile_cells>;
  static constexpr int most_error = 255;  ///< no tolerance may be larger: of cells of 16 bits a sixteenth of a nat

  Quadtree() = default;
  /// `tolerance`: in units of the cells, 0 ... `most_error`.
  Quadtree(const Tile<Cell>& tile, const Errors& errors, int tolerance);

  void expand(Tile<Cell>& tile, Errors* errors) const;
  bool same_as(const Quadtree& other) const { return nodes_ == other.nodes_; }
  std::size_t heap_bytes() const { return nodes_ ? sizeof(Nodes) + nodes_->inner.size() + nodes_->values.size() * sizeof(Cell) + nodes_->errors.size() + nodes_->through.size() + 2 * sizeof(void*) : 0; }

 private:
  struct Nodes {
    float seen = 0.0f;
    std::vector<std::uint8_t> inner;    ///< a bit a node larger than a cell, in preorder: it has children
    std::vector<Cell> values;           ///< of the leaves, in the same order
    std::vector<std::uint8_t> errors;   ///< of the leaves; empty: all 0
    std::vector<std::uint8_t> through;  ///< a bit a leaf; empty: all 0
  };
  std::shared_ptr<const Nodes> nodes_;  ///< never changed: copies share it
};

}  // namespace thicket

#include "quadtree.hpp"

#include <algorithm>
#include <cmath>

namespace thicket {
namespace {

/// Bits one after another.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  void put(bool bit) {
    if (count_ % 8 == 0) bytes_.push_back(0);
    bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (bit ? 1u << (count_ % 8) : 0u));
    ++count_;
  }

 private:
  std::vector<std::uint8_t>& bytes_;
  std::size_t count_ = 0;
};

/// The largest square of a Z-ordered tile that begins at a place has places whose bits lie side by side; this gives a Z-ordered index's place in rows.
constexpr std::size_t place_of(std::size_t z) {
  std::size_t place = 0;
  for (int bit = 0; bit < tile_bits; ++bit) place |= (z >> (2 * bit) & 1) << bit | (z >> (2 * bit + 1) & 1) << (bit + tile_bits);
  return place;
}
constexpr auto make_places() {
  std::array<std::uint16_t, tile_cells> places{};
  for (std::size_t z = 0; z < tile_cells; ++z) places[z] = static_cast<std::uint16_t>(place_of(z));
  return places;
}
constexpr auto places = make_places();

}  // namespace

template <class Cell>
Quadtree<Cell>::Quadtree(const Tile<Cell>& tile, const Errors& errors, int tolerance) {
  // From the leaves up, in Z order: of each square the least and greatest value, and how far off its cells may be.
  struct Square {
    Cell low, high;
    std::uint8_t error;
    bool through, one;  // one: it can be a leaf
  };
  std::array<std::vector<Square>, tile_bits + 1> levels;  // 0: cells
  levels[0].reserve(tile_cells);
  for (std::size_t z = 0; z < tile_cells; ++z) {
    const std::size_t place = places[z];
    levels[0].push_back({tile.values[place], tile.values[place], errors[place], tile.is_through(place), true});
  }
  for (std::size_t level = 1; level <= tile_bits; ++level) {
    const auto& below = levels[level - 1];
    levels[level].reserve(below.size() / 4);
    for (std::size_t i = 0; i < below.size(); i += 4) {
      Square square = below[i];
      bool one = square.one;
      std::uint8_t error = square.error;
      for (std::size_t k = 1; k < 4; ++k) {
        const Square& other = below[i + k];
        one = one && other.one && other.through == square.through && (other.low == unknown_cell<Cell>) == (square.low == unknown_cell<Cell>);
        square.low = std::min(square.low, other.low);
        square.high = std::max(square.high, other.high);
        error = std::max(error, other.error);
      }
      // A leaf has the middle, at most half of the spread from each of the values, which themselves may be off.
      if (one && square.low != square.high) {
        const int worst = error + (static_cast<int>(square.high) - square.low + 1) / 2;
        one = worst <= tolerance;
        error = static_cast<std::uint8_t>(std::min(worst, most_error));
      }
      square.one = one;
      square.error = error;  // of a square that is no leaf, nobody asks for it
      levels[level].push_back(square);
    }
  }
  auto nodes = std::make_shared<Nodes>();
  nodes->seen = *std::max_element(tile.seen.begin(), tile.seen.end());
  BitWriter inner(nodes->inner), through(nodes->through);
  bool any_through = false, any_error = false;
  const auto write = [&](auto&& self, std::size_t level, std::size_t i) -> void {
    const Square& square = levels[level][i];
    if (level > 0) inner.put(!square.one);
    if (square.one) {
      nodes->values.push_back(static_cast<Cell>((static_cast<int>(square.low) + square.high) / 2));
      nodes->errors.push_back(square.error);
      through.put(square.through);
      any_through |= square.through;
      any_error |= square.error != 0;
      return;
    }
    for (std::size_t k = 0; k < 4; ++k) self(self, level - 1, 4 * i + k);
  };
  write(write, tile_bits, 0);
  if (!any_through) nodes->through.clear();
  if (!any_error) nodes->errors.clear();
  nodes->inner.shrink_to_fit();
  nodes->values.shrink_to_fit();
  nodes->errors.shrink_to_fit();
  nodes->through.shrink_to_fit();
  nodes_ = std::move(nodes);
}

template <class Cell>
void Quadtree<Cell>::expand(Tile<Cell>& tile, Errors* errors) const {
  if (!nodes_) return;
  const Nodes& nodes = *nodes_;
  tile.seen.fill(nodes.seen);
  std::size_t node = 0, leaf = 0;
  const auto read = [&](auto&& self, std::size_t level, std::size_t first) -> void {
    const std::size_t cells = std::size_t{1} << (2 * level);
    const bool inner = level > 0 && (nodes.inner[node / 8] >> (node % 8) & 1) != 0;
    node += level > 0;
    if (inner) {
      for (std::size_t k = 0; k < 4; ++k) self(self, level - 1, first + k * cells / 4);
      return;
    }
    const bool through = !nodes.through.empty() && (nodes.through[leaf / 8] >> (leaf % 8) & 1) != 0;
    const std::uint8_t error = nodes.errors.empty() ? std::uint8_t{0} : nodes.errors[leaf];
    for (std::size_t z = first; z < first + cells; ++z) {
      tile.values[places[z]] = nodes.values[leaf];
      if (through) tile.set_through(places[z]);
      if (errors) (*errors)[places[z]] = error;
    }
    ++leaf;
  };
  read(read, tile_bits, 0);
}

template class Quadtree<std::int8_t>;
template class Quadtree<std::int16_t>;

}  // namespace thicket

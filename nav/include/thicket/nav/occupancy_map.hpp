// The occupancy map that grows while the robot drives.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/map_file.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/probability_grid.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

/// The keys of [map].
struct MapSpec {
  bool enabled = true;
  double resolution_m = 0.1;
  double probability_hit = 0.7;    ///< of matter in a cell, given an echo in it
  double probability_miss = 0.4;   ///< of matter in a cell, given a beam that went through it
  double clamp_low = 0.1192;       ///< probabilities stay between these, so that the map can change its mind (OctoMap's values)
  double clamp_high = 0.971;
};
const Section& map_section();

/// What the map knows of one cell.
struct CellView {
  bool known = false;            ///< sensed at least once
  double probability = 0.5;      ///< of matter that a beam cannot pass
  bool sensed_through = false;   ///< the last beam through it was inside matter there: penetrable, may still stop motion
};

/// Cell (column, row) covers [column, column + 1) x [row, row + 1) times the resolution; indices may be negative.
struct CellIndex {
  std::int64_t column = 0, row = 0;
  bool operator==(const CellIndex&) const = default;
};

/// Log-odds in 8 bits, in tiles that exist only where something was seen. Copies share tiles until one of them writes.
///
/// One scan updates each cell once: occupied (an echo lies in it) before sensed through before free. Free is what a beam passed in the open, sensed through what it
/// passed between the edges of matter; behind the end of a beam nothing is said. A beam with an opening counts as a fan of thin ones, whose arc of echoes is all occupied. In units of 1/32, log-odds of a cell rise by logit(probability_hit)
/// or fall by logit(probability_miss), between the clamps (Moravec & Elfes 1985 in the log-odds form of Thrun 2003; clamping as OctoMap, 2013).
class OccupancyMap {
 public:
  explicit OccupancyMap(const MapSpec& spec);

  /// Takes in a scan made from a vehicle's (estimated) pose.
  void integrate(const Scan& scan, const Pose& vehicle);

  double resolution() const { return spec_.resolution_m; }
  CellIndex cell_at(const glm::dvec2& point) const;
  CellView view(const CellIndex& cell) const;
  /// Free with the certainty of the clamp.
  bool surely_free(const CellIndex& cell) const;

  /// Cells known so far, and bytes of their tiles.
  std::size_t known_cells() const;
  std::size_t memory_bytes() const;
  /// The smallest block of cells that holds all known ones: first and one past the last; nothing for an empty map.
  std::optional<std::pair<CellIndex, CellIndex>> extent() const;

  /// Three-valued, for map_server: occupied above 0.65, free below 0.196 unless sensed through, else unknown. The origin is the lower-left corner.
  GridMap to_grid() const;
  /// All that is known, over the block of cells that `extent` gives; empty for an empty map.
  ProbabilityGrid to_probabilities() const;

 private:
  static constexpr int tile_bits = 6, tile_size = 1 << tile_bits;
  static constexpr std::int8_t unknown = -128;
  struct Tile {
    std::array<std::int8_t, tile_size * tile_size> log_odds;
    std::array<std::uint64_t, tile_size> through{};  ///< a bit a cell: sensed through
    Tile() { log_odds.fill(unknown); }
  };
  struct CellHash {
    std::size_t operator()(const CellIndex& i) const {
      return static_cast<std::size_t>(i.column) * 0x9e3779b97f4a7c15u ^ static_cast<std::size_t>(i.row) * 0xc2b2ae3d27d4eb4fu;
    }
  };
  /// A window of cells around the sensor, in which a scan is drawn before it is taken into the tiles. Scratch: a copy of a map starts with an empty one.
  struct Window {
    Window() = default;
    Window(const Window&) : Window() {}
    Window& operator=(const Window&) { return *this; }
    Window(Window&&) = default;
    Window& operator=(Window&&) = default;
    ~Window() = default;

    std::vector<std::uint8_t> states;  ///< a square of cells, all untouched between scans
    std::int64_t tiles = 0;            ///< its edge, in tiles
    /// From a row to the next: an odd number of tiles, for a power of two would put all cells of a column into one set of the cache.
    std::int64_t stride() const { return (tiles | 1) * tile_size; }
    CellIndex tile;  ///< the tile of its lower-left cell
  };
  enum State : std::uint8_t { untouched = 0, free = 1, through = 2, occupied = 3 };

  void place_window(const Scan& scan, const glm::dvec2& sensor);
  void draw_beam(const Scan& scan, const Beam& beam, const glm::dvec2& from, const glm::dvec2& direction, double scale);
  void apply();
  void apply_to_tile(const CellIndex& tile, std::uint8_t* states);
  const Tile* tile(const CellIndex& cell) const;

  MapSpec spec_;
  int low_;  ///< the lower clamp in units of 1/32
  std::array<std::int8_t, 4 * 256> next_value_;  ///< [state * 256 + value as a byte]: what a scan makes of a cell
  std::unordered_map<CellIndex, std::shared_ptr<Tile>, CellHash> tiles_;
  Window window_;
};

}  // namespace thicket

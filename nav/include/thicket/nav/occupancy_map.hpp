// The occupancy map that grows while the robot drives.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/map_file.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

/// The keys of [map].
struct MapSpec {
  bool enabled = true;
  std::string store = "tiles";     ///< "tiles": exists only where something was seen | "dense": one rectangle | "quadtree": squares of like cells are one
  int cell_bits = 8;               ///< 8 or 16
  double resolution_m = 0.1;
  double probability_hit = 0.7;    ///< of matter in a cell, given an echo in it
  double probability_miss = 0.4;   ///< of matter in a cell, given a beam that went through it
  double probability_detection = 0.5;  ///< that a lobe gives an echo of a cell's matter: what it frees it frees by 1 - this
  double lobe_share = 0.7;         ///< of a lobe's opening, about its axis: where its silence counts. A wall that is met aslant at the border gives no echo
  std::optional<double> range_sigma_m; ///< standard deviation of ranges; not given: what the sensor states
  double clamp_low = 0.1192;       ///< probabilities stay between these, so that the map can change its mind (OctoMap's values)
  double clamp_high = 0.971;
  std::string evidence = "views";  ///< "views": a look from where the sensor stood before is no new witness | "scans": every scan counts, as in 2018
  double tolerance = 0.02;         ///< of the quadtree: as far as probabilities near 1/2 may be off (log-odds by four times that)
  std::string initial;             ///< a file of probabilities to begin with; empty: nothing is known
};
const Section& map_section();

/// What the map knows of one cell.
struct CellView {
  bool known = false;            ///< sensed at least once
  double probability = 0.5;      ///< of matter that a beam cannot pass
  bool sensed_through = false;   ///< the last beam through it was inside matter there: penetrable, may still stop motion
  double last_seen = -std::numeric_limits<double>::infinity();  ///< s, when it or a cell nearby (of its block of 8 x 8; in the quadtree of 64 x 64) was last sensed
};

/// Cell (column, row) covers [column, column + 1) x [row, row + 1) times the resolution; indices may be negative.
struct CellIndex {
  std::int64_t column = 0, row = 0;
  bool operator==(const CellIndex&) const = default;
};

/// A cell as a picture needs it.
struct CellLook {
  std::uint8_t probability = 128;  ///< of matter, 0 ... 255 for 0 ... 1
  bool known = false, sensed_through = false, surely_free = false;
  bool operator==(const CellLook&) const = default;
};

class Cells;
class Prior;
class SensorModel;
class ViewMemory;
class Window;

/// Log-odds of matter (Moravec & Elfes 1985 in the log-odds form of Thrun 2003; clamped as in OctoMap, 2013). A copy is a snapshot: with the store "tiles" it shares all cells until one of both writes.
///
/// One scan updates each cell once, and occupied wins over sensed through over free. What a beam and what a lobe say of the cells is told in docs/mapping.md, and so is when a look counts as a new witness.
/// Reading one map from several threads at once is not safe, reading copies of it is.
class OccupancyMap {
 public:
  explicit OccupancyMap(const MapSpec& spec);
  OccupancyMap(const OccupancyMap& other);
  OccupancyMap& operator=(const OccupancyMap& other);
  OccupancyMap(OccupancyMap&&) noexcept;
  OccupancyMap& operator=(OccupancyMap&&) noexcept;
  ~OccupancyMap();

  /// Takes in a scan made from a vehicle's (estimated) pose.
  void integrate(const Scan& scan, const Pose& vehicle);

  double resolution() const { return spec_.resolution_m; }
  CellIndex cell_at(const glm::dvec2& point) const;
  CellView view(const CellIndex& cell) const;
  /// Free with the certainty of the clamp.
  bool surely_free(const CellIndex& cell) const;

  /// Cells known so far, bytes that hold them, and cells that scans told something of so far, each counted with every scan.
  std::size_t known_cells() const;
  std::size_t memory_bytes() const;
  std::uint64_t cells_updated() const { return cells_updated_; }
  /// The smallest block of cells that holds all known ones: first and one past the last; nothing for an empty map.
  std::optional<std::pair<CellIndex, CellIndex>> extent() const;

  /// Three-valued, for map_server: occupied above 0.65, free below 0.196 unless sensed through, else unknown. The origin is the lower-left corner.
  GridMap to_grid() const;
  /// All that is known, over the block of cells that `extent` gives; empty for an empty map.
  ProbabilityGrid to_probabilities() const;
  /// Puts in what is known beforehand, between the clamps. Errors: a grid of another resolution, or whose origin is not a multiple of it.
  Result<Done> start_from(const ProbabilityGrid& grid);

  /// The edge of the squares that `changed_tiles` gives, cells.
  static constexpr int tile_cells_across = 64;
  /// Calls `use(corner, looks)` for each square of cells that may not be as it was in another copy of this map, row by row from its lower-left cell `corner`; of squares that only the other map knows, too. Without another one,
  /// or with one of another resolution or store: for all that is known. The looks are valid during the call.
  void changed_tiles(const OccupancyMap* other, const std::function<void(const CellIndex& corner, std::span<const CellLook> looks)>& use) const;

  /// The cells that are not as they were in an earlier copy of this map, in few bytes: for windows, and for links with little bandwidth. To 1/32 nat of log-odds.
  std::vector<std::uint8_t> changes_since(const OccupancyMap& earlier) const;
  /// Makes a copy of the earlier map a copy of the later one. Errors: bytes that are no such update, or of another resolution; then nothing is changed.
  Result<Done> apply_changes(std::span<const std::uint8_t> changes);

 private:
  MapSpec spec_;
  std::unique_ptr<Cells> cells_;
  std::unique_ptr<SensorModel> model_;
  std::unique_ptr<ViewMemory> views_;
  std::unique_ptr<Prior> prior_;
  std::unique_ptr<Window> window_, again_;  ///< what is new in a scan, and what was seen from here before
  std::uint64_t cells_updated_ = 0;
};

}  // namespace thicket

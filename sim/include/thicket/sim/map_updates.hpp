// What it takes to tell somebody else of a map while it grows.
#pragma once

#include <cstddef>
#include <optional>

#include "thicket/nav/occupancy_map.hpp"

namespace thicket {

class Simulation;

/// Updates of a run's map, one at the end of each whole second of simulated time: the bytes of `changes_since` the second before. What comes after the last whole second is not counted.
struct MapUpdates {
  static constexpr double every_s = 1.0;
  std::size_t count = 0;  ///< seconds, those in which nothing changed too
  std::size_t bytes = 0;  ///< of all of them
  std::size_t most = 0;   ///< bytes of the largest

  /// Bytes of an update; NaN if there was none.
  double mean() const;
};

/// Counts them along a run. It keeps a copy of the map of the second before, which shares with the map all tiles that have not changed.
class UpdateMeter {
 public:
  /// To be called before the first step, after every step, and when the run has ended.
  void note(const Simulation& simulation);
  const MapUpdates& updates() const { return updates_; }

 private:
  std::optional<OccupancyMap> before_;
  double due_ = 0.0;  ///< s
  MapUpdates updates_;
};

}  // namespace thicket

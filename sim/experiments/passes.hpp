// What a lobe has while it is carried past an object: the profiles of a strafing run. Private to sim/experiments, and used by its tests.
#pragma once

#include <cstddef>
#include <vector>

#include "thicket/sim/simulation.hpp"

namespace thicket {

/// A top of a profile.
struct Top {
  double range = 0.0;      ///< m
  double amplitude = 0.0;
};

/// The scans of the first sensor along a way on which y grows.
struct Pass {
  std::vector<double> y;                     ///< m, of the sensor at each scan
  std::vector<std::vector<float>> profiles;  ///< amplitude by range bin
  std::vector<float> threshold;              ///< of the last scan
  std::vector<double> detected;              ///< m, range of the first echo of each scan; NaN: none
  double first_range = 0.0, bin_size = 0.0;  ///< m

  double range(std::size_t bin) const { return first_range + static_cast<double>(bin) * bin_size; }
  /// The scan nearest to y = 0.
  std::size_t closest() const;
  /// Sum of the amplitudes over all scans, bin by bin: the source's second kind of graph.
  std::vector<double> sum() const;
  /// The strongest bin of a scan between two ranges, m.
  Top strongest(std::size_t scan, double low, double high) const;
  /// The same of the sum.
  Top strongest_of_sum(double low, double high) const;
  /// Share of the scans whose first echo lies within `tolerance` m of the distance from (0, y) to (x, 0).
  double found(double x, double tolerance) const;
};

/// Drives a run to its end and keeps every scan of its first sensor, which has a receiver.
Pass fly_past(Simulation simulation);

}  // namespace thicket

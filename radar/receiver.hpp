// From what comes back to range bins, noise, and detections. Private to the room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "thicket/base/random.hpp"
#include "thicket/radar/sensor_spec.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

/// What one ray brings back from one place.
struct Return {
  double range = 0.0;            ///< m, half the way
  float strength = 0.0f;         ///< power; under the printed law an amplitude
  float radial_velocity = 0.0f;  ///< m/s
};

class Receiver {
 public:
  /// `wave` gives the frequency, for the phases of I/Q, and the law: under the printed one amplitudes are added, else powers (or, with I/Q, fields with the phase of their way).
  Receiver(const ReceiverSpec& spec, const RadarSpec& wave, double range_min, double range_max);

  std::uint32_t bins() const;

  /// Makes room for `beams` profiles. (Memory is used again.)
  void start(std::size_t beams, Profiles& profiles) const;

  /// Fills profile `beam` from the returns (in their order, so that sums are the same bit for bit), and appends what is detected by increasing range: the range of the top's bin,
  /// its amplitude, the mean radial velocity (by strength) of what is in it. `ground`: what the ground alone would return, for the floor gate; empty without one.
  /// May be called for several beams at a time.
  void receive(std::span<const Return> returns, std::span<const Return> ground, const Random& random, std::uint64_t scan, std::uint32_t beam, Profiles& profiles,
               std::vector<Echo>& detections) const;

  /// Standard deviation of the white noise of a bin (per component of I/Q) before smoothing.
  double noise() const;
  /// The least power that is detected without noise, of a return in the middle of a bin; under the printed law the least amplitude, squared.
  double floor_power() const;
};

}  // namespace thicket

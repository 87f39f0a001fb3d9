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

/// The bins' amplitudes are what the returns make, plus noise, after the moving average and clipped at `saturation`. The noise may make an amplitude of signal "amplitude" negative.
/// The moving average (with "iq" that of I and Q) is over as many bins before as behind, of an even number one more before; at the ends it is over those that there are.
/// The random walk starts at 0 before the first bin. Clutter is a power that is added to that of the returns; with "iq" it has a random phase in every bin, so the noise does it.
class Receiver {
 public:
  /// `wave` gives the frequency, for the phases of I/Q, and the law: under the printed one amplitudes are added, else powers (or, with I/Q, fields with the phase of their way).
  Receiver(const ReceiverSpec& spec, const RadarSpec& wave, double range_min, double range_max);

  std::uint32_t bins() const { return bins_; }

  /// Makes room for `beams` profiles. (Memory is used again.)
  void start(std::size_t beams, Profiles& profiles) const;

  /// Fills profile `beam` from the returns (in their order, so that sums are the same bit for bit), and appends what is detected by increasing range: the range of the top's bin,
  /// its amplitude, the mean radial velocity (by strength) of what is in it. `ground`: what the ground alone would return, for the floor gate; empty without one.
  /// May be called for several beams at a time.
  void receive(std::span<const Return> returns, std::span<const Return> ground, const Random& random, std::uint64_t scan, std::uint32_t beam, Profiles& profiles,
               std::vector<Echo>& detections) const;

  /// Standard deviation of the white noise of a bin (per component of I/Q) before smoothing.
  double noise() const { return noise_; }
  /// The least power that is detected without noise, of a return in the middle of a bin; under the printed law the least amplitude, squared. It makes up for what the smoothing takes
  /// from its top, and the clutter is under it: 0 where that alone is above the threshold. Infinite where the saturation is below the threshold. The threshold of CFAR is here that of
  /// noise and clutter alone, at their mean powers (without the random walk). The floor gate is not in it.
  double floor_power() const { return floor_power_; }

 private:
  /// What is added up in a bin.
  enum class Sum : std::uint8_t { powers, amplitudes, fields };
  struct Scratch;

  /// Adds up the returns and gives the signal that the pulse makes of them: powers, amplitudes or fields. Whether any of them moves.
  bool deposit(std::span<const Return> returns, Scratch& scratch) const;
  /// The pulse's part of that. A return is shared by the two bins it is between, so that a pulse that is not much longer than a bin is flatter for a return between them.
  void spread(Scratch& scratch, std::size_t part) const;
  void add_noise(const Random& random, std::uint64_t scan, std::uint32_t beam, Scratch& scratch) const;
  /// The moving average of `values`, in place.
  void smooth(std::vector<float>& values, Scratch& scratch) const;
  /// What the ground alone would give, without noise and clutter.
  void amplitude_of_ground(std::span<const Return> ground, Scratch& scratch) const;
  /// Exact where powers are exponential, as those of the noise of I and Q are. The noise of amplitudes is normal, and the
  /// rate is that of Student's distribution: with 16 training bins on either side 1.7e-2, 4.6e-3 and 1.3e-3 instead of 1e-2, 1e-3 and 1e-4.
  void cfar_threshold(std::span<const float> amplitude, std::span<float> threshold, Scratch& scratch) const;
  /// Tops: bins at which the amplitude reaches the threshold and exceeds what is on either side. Of several bins that are equal, the middle one.
  void detect(std::span<const float> amplitude, std::span<const float> threshold, std::vector<Echo>& detections) const;
  void set_velocities(std::span<const Return> returns, std::span<Echo> tops, Scratch& scratch) const;
  std::size_t parts() const { return sum_ == Sum::fields ? 2 : 1; }
  double find_floor_power() const;

  Sum sum_ = Sum::powers;
  std::uint32_t bins_ = 0;
  double first_range_ = 0.0, bin_size_ = 0.0, range_min_ = 0.0, range_max_ = 0.0;  // m
  std::int64_t first_seen_ = 0, last_seen_ = -1;  // bins whose middle is in the sensor's range
  std::vector<float> pulse_;                      // by distance from its peak in bins; what is added up is spread like this
  std::size_t margin_ = 0;                        // bins before and beyond the profile from which the pulse reaches into it, up to a whole block
  double half_waves_per_m_ = 0.0;
  double noise_ = 0.0, walk_ = 0.0, clutter_ = 0.0, saturation_ = 0.0, threshold_ = 0.0;
  std::int64_t smoothed_before_ = 0, smoothed_after_ = 0;  // bins in the moving average besides the one in question
  std::int64_t training_ = 0, guard_ = 0;
  std::vector<double> cfar_factor_;  // by the number of training bins: of the mean power; empty without CFAR
  std::int64_t velocity_reach_ = 1;  // bins about a top of which the velocity is taken
  double floor_power_ = 0.0;
  bool floor_gate_ = false;
  enum class Pick : std::uint8_t { first, strongest, all } pick_ = Pick::first;
};

}  // namespace thicket

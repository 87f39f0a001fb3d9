// Counter-based randomness: every number is a pure function of (mission seed, sensor, scan number, beam, use, index), so that results do not
// depend on the number of threads, on the order of work, or on who else draws numbers.
#pragma once

#include <array>
#include <cstdint>

namespace thicket {

/// What a random number is for; two uses never share one.
enum class RandomUse : std::uint8_t { ray_choice, range_noise, sampling, receiver, foliage, odometry, gust, jitter };

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011), from the Random123 library.
class Random {
 public:
  /// `sensor` tells apart the sensors of one mission.
  Random(std::uint64_t seed, std::uint16_t sensor) : seed_(seed), sensor_(sensor) {}

  /// Four independent numbers, uniform in the open interval (0, 1), 32 bits each. `scan` < 2^48, `index` < 2^24.
  std::array<double, 4> uniform(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const;

  /// Four independent standard normal numbers, the quantiles of those of `uniform`: between -6.4 and 6.4.
  std::array<double, 4> normal(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const;

 private:
  std::uint64_t seed_;
  std::uint16_t sensor_;
};

/// Where a standard normal number lies below with `probability`, which is in the open interval (0, 1). To about 1e-16 of itself, in both tails
/// (Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Applied Statistics 37, 1988).
double normal_quantile(double probability);

}  // namespace thicket

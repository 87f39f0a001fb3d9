// When a sensor scans. Private to the room.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace thicket {

/// Whether a sensor of `rate_hz` that has made `count` scans is due at a time, s; if so, this scan is counted. The first is due at 0, number n at n / rate.
///
/// A rate above the step's gives one scan a step; the count keeps up with the time, so that the rate is right on average. What rounding may make of a time that is a multiple of the step is made up for: 1 ns, and
/// from 10^6 s on, where a double is coarser, a few of its units.
inline bool scan_due(double time, double rate_hz, std::uint64_t& count) {
  const double slack = std::max(1e-9, 1e-15 * time);
  if (time < static_cast<double>(count) / rate_hz - slack) return false;
  count = std::max(count + 1, static_cast<std::uint64_t>(std::floor((time + slack) * rate_hz)) + 1);
  return true;
}

}  // namespace thicket

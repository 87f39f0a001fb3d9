// Cosines and sines of phases, many at a time. Private to the room.
#pragma once

#include <array>
#include <cstddef>

#include "thicket/base/pose.hpp"

namespace thicket {

/// Cosine and sine of whole turns, |turns| < 2^50, to 1e-12 (plus the rounding of `turns`). No branches and no calls: several at a time.
template <std::size_t count>
void cosine_and_sine(const std::array<double, count>& turns, std::array<double, count>& cosine, std::array<double, count>& sine) {
  constexpr double rounds = 0x1.8p52;  // a double of this size has no room for a fraction
  for (std::size_t i = 0; i < count; ++i) {
    const double whole = (turns[i] + rounds) - rounds;
    const double x = (turns[i] - whole) * (0.5 * pi), x2 = x * x;  // a quarter of the angle, up to pi/4
    const double s = x * (1.0 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880 + x2 * (-1.0 / 39916800 + x2 * (1.0 / 6227020800)))))));
    const double c = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320 + x2 * (-1.0 / 3628800 + x2 * (1.0 / 479001600))))));
    const double s_half = 2.0 * s * c, c_half = 1.0 - 2.0 * s * s;
    sine[i] = 2.0 * s_half * c_half;
    cosine[i] = 1.0 - 2.0 * s_half * s_half;
  }
}

}  // namespace thicket

// Functions that the inverse sensor models ask for a million times a second, as tables. Private to the room.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "window.hpp"

namespace thicket {

/// Log-odds in 1/32 nat, as an index of tables.
using Level = std::uint8_t;

/// A number for each level; of `unknown_cell` that of 0.
template <class Number = double, class Of>
std::array<Number, 256> for_levels(Of of) {
  std::array<Number, 256> values{};
  for (int level = -128; level < 128; ++level) values[static_cast<Level>(level)] = static_cast<Number>(of(level == -128 ? 0.0 : level / evidence_per_nat));
  return values;
}
/// p / (1 - p), and p.
inline const std::array<double, 256> odds_of_level = for_levels([](double log_odds) { return std::exp(log_odds); });
inline const std::array<double, 256> probability_of_level = for_levels([](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); });

/// exp(-x^2 / 2) for |x| <= 2, from a table: to 1e-3.
inline constexpr int bell_steps = 1024;
inline const auto bell_table = [] {
  std::array<float, 2 * bell_steps + 1> values{};
  for (int i = 0; i <= 2 * bell_steps; ++i) values[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * std::pow(static_cast<double>(i) / bell_steps, 2)));
  return values;
}();
inline double bell(double x) { return static_cast<double>(bell_table[static_cast<std::size_t>(std::min(std::abs(x), 2.0) * bell_steps + 0.5)]); }

/// The evidence that multiplies odds by `ratio` > 0, in 1/32 nat, between -127 and 127: to a tenth of a unit before it is rounded. From a table by the first bits of the number: 16 octaves about 1, in 256 parts each.
inline constexpr int evidence_part_bits = 8, evidence_octaves = 16;
inline const auto evidence_table = [] {
  std::array<std::int8_t, static_cast<std::size_t>(evidence_octaves << evidence_part_bits)> values{};
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const int octave = (i >> evidence_part_bits) - evidence_octaves / 2, part = i & ((1 << evidence_part_bits) - 1);
    const double nats = octave * std::log(2.0) + std::log1p((part + 0.5) / (1 << evidence_part_bits));
    values[static_cast<std::size_t>(i)] = static_cast<std::int8_t>(std::clamp(static_cast<int>(std::lround(evidence_per_nat * nats)), -most_evidence, most_evidence));
  }
  return values;
}();
inline int evidence_of(double ratio) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(static_cast<float>(ratio)) >> (23 - evidence_part_bits);
  return evidence_table[static_cast<std::size_t>(std::clamp(bits - ((127 - evidence_octaves / 2) << evidence_part_bits), 0, static_cast<int>(evidence_table.size()) - 1))];
}

}  // namespace thicket

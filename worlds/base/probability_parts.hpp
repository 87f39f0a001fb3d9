// What the files of probabilities share. Not a public header.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "thicket/base/probability_file.hpp"

namespace thicket {

/// As it stands in a grid: in (0, 1).
inline float inside(double probability) { return static_cast<float>(std::clamp(probability, least_probability, 1.0 - least_probability)); }

/// Why a grid cannot be written, or nothing.
std::optional<Error> unwritable(const std::filesystem::path& file, const ProbabilityGrid& grid);

/// Bytes of a number, the least significant first, whatever the processor's own order is.
template <class Number>
void append_little(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) bytes += static_cast<char>(static_cast<std::uint8_t>(number >> (8 * i)));
}
template <class Number>
Number little(std::string_view bytes) {
  Number number = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) number = static_cast<Number>(number << 8 | static_cast<std::uint8_t>(bytes[i]));
  return number;
}

}  // namespace thicket

#include "thicket/base/random.hpp"

#include <Random123/philox.h>

#include <cmath>

#include "thicket/base/pose.hpp"

namespace thicket {

std::array<double, 4> Random::uniform(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const {
  const r123::Philox4x32::ctr_type counter = {
      {(static_cast<std::uint32_t>(use) << 24) | (index & 0xffffffu), beam, static_cast<std::uint32_t>(scan),
       (static_cast<std::uint32_t>(sensor_) << 16) | (static_cast<std::uint32_t>(scan >> 32) & 0xffffu)}};
  const r123::Philox4x32::key_type key = {{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
  const auto words = r123::Philox4x32{}(counter, key);
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = (static_cast<double>(words[i]) + 0.5) * 0x1p-32;
  return numbers;
}

std::array<double, 2> Random::normal(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const {
  const auto u = uniform(scan, beam, use, index);
  const double radius = std::sqrt(-2.0 * std::log(u[0]));
  return {radius * std::cos(2.0 * pi * u[1]), radius * std::sin(2.0 * pi * u[1])};
}

}  // namespace thicket

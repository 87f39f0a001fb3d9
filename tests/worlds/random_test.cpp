#include "thicket/base/random.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace thicket;

namespace {

constexpr std::array uses = {RandomUse::ray_choice, RandomUse::range_noise, RandomUse::sampling, RandomUse::receiver};

/// The 32 bits behind a number of (0, 1).
std::uint32_t word(double number) {
  return static_cast<std::uint32_t>(number * 0x1p32);
}

}  // namespace

TEST_CASE("Philox4x32-10 gives the numbers that its authors publish") {
  // Random123, kat_vectors: counter 0, key 0 gives 6627e8d5 e169c58d bc57ac4c 9b00dbd8.
  const auto numbers = Random(0, 0).uniform(0, 0, RandomUse::ray_choice, 0);
  CHECK(word(numbers[0]) == 0x6627e8d5u);
  CHECK(word(numbers[1]) == 0xe169c58du);
  CHECK(word(numbers[2]) == 0xbc57ac4cu);
  CHECK(word(numbers[3]) == 0x9b00dbd8u);
  // The middle of the interval that a word stands for.
  CHECK(numbers[0] == (0x6627e8d5p0 + 0.5) * 0x1p-32);
}

TEST_CASE("a number is a function of its arguments alone") {
  const Random random(7, 3);
  const auto once = random.uniform(5, 6, RandomUse::sampling, 8);
  random.normal(1, 2, RandomUse::receiver, 3);
  CHECK(random.uniform(5, 6, RandomUse::sampling, 8) == once);
  CHECK(Random(7, 3).uniform(5, 6, RandomUse::sampling, 8) == once);
}

TEST_CASE("no two arguments share their numbers") {
  std::vector<std::array<double, 4>> all;
  const auto add = [&](std::uint64_t seed, std::uint16_t sensor, std::uint64_t scan, std::uint32_t beam, RandomUse use,
                       std::uint32_t index) { all.push_back(Random(seed, sensor).uniform(scan, beam, use, index)); };
  constexpr std::uint64_t last_scan = (std::uint64_t{1} << 48) - 1;
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32, std::numeric_limits<std::uint64_t>::max()})
    for (const auto sensor : std::array<std::uint16_t, 3>{0, 1, 65535})
      for (const std::uint64_t scan : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32, last_scan})
        for (const std::uint32_t beam : {0u, 1u, 0xffffffffu})
          for (const RandomUse use : uses)
            for (const std::uint32_t index : {0u, 1u, (1u << 24) - 1u}) add(seed, sensor, scan, beam, use, index);
  const std::size_t count = all.size();
  CHECK(count == 4 * 3 * 4 * 3 * 4 * 3);
  std::sort(all.begin(), all.end());
  CHECK(std::unique(all.begin(), all.end()) == all.end());
}

TEST_CASE("uniform numbers fill the open interval evenly") {
  const Random random(42, 0);
  constexpr std::size_t count = 100000, bins = 50;
  std::array<std::size_t, bins> histogram{};
  double sum = 0.0, squares = 0.0, least = 1.0, most = 0.0;
  for (std::uint32_t i = 0; i < count / 4; ++i)
    for (const double u : random.uniform(i, 9, RandomUse::sampling, 0)) {
      sum += u;
      squares += (u - 0.5) * (u - 0.5);
      least = std::min(least, u);
      most = std::max(most, u);
      ++histogram[static_cast<std::size_t>(u * bins)];
    }
  CHECK(least > 0.0);
  CHECK(most < 1.0);
  const double n = count;
  CHECK(std::abs(sum / n - 0.5) < 4.0 * std::sqrt(1.0 / 12.0 / n));
  CHECK(std::abs(squares / n - 1.0 / 12.0) < 4.0 * std::sqrt((1.0 / 80.0 - 1.0 / 144.0) / n));
  double chi_squared = 0.0;
  for (const std::size_t in_bin : histogram) chi_squared += std::pow(static_cast<double>(in_bin) - n / bins, 2) / (n / bins);
  CHECK(std::abs(chi_squared - (bins - 1)) < 4.0 * std::sqrt(2.0 * (bins - 1)));
}

TEST_CASE("the quantile of a normal number undoes its distribution, deep into both tails") {
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  CHECK(normal_quantile(0.5) == 0.0);
  CHECK(normal_quantile(0.975) == doctest::Approx(1.959963984540054).epsilon(1e-14));
  for (double probability = 1e-15; probability < 0.5; probability *= 1.17) {
    CAPTURE(probability);
    CHECK(std::abs(below(normal_quantile(probability)) / probability - 1.0) < 1e-12);
    const double above = 1.0 - probability;  // as the machine has it
    CHECK(std::abs(below(-normal_quantile(above)) / (1.0 - above) - 1.0) < 1e-12);
  }
}

TEST_CASE("four normal numbers of one draw are normal, independent, and the quantiles of its uniform ones") {
  const Random random(44, 2);
  constexpr std::uint32_t draws = 100000;
  double sum = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0;
  std::array<double, 6> products{};
  std::size_t beyond_two = 0;
  for (std::uint32_t i = 0; i < draws; ++i) {
    const auto numbers = random.normal(i / 1000, i % 1000, RandomUse::receiver, i % 7);
    const auto u = random.uniform(i / 1000, i % 1000, RandomUse::receiver, i % 7);
    std::size_t pair = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      const double x = numbers[a];
      REQUIRE(x == normal_quantile(u[a]));
      sum += x;
      squares += x * x;
      cubes += x * x * x;
      fourths += x * x * x * x;
      beyond_two += std::abs(x) > 2.0;
      for (std::size_t b = 0; b < a; ++b) products[pair++] += x * numbers[b];
    }
  }
  const double n = 4.0 * draws;
  CHECK(std::abs(sum / n) < 4.0 * std::sqrt(1.0 / n));
  CHECK(std::abs(squares / n - 1.0) < 4.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(cubes / n) < 4.0 * std::sqrt(15.0 / n));
  CHECK(std::abs(fourths / n - 3.0) < 4.0 * std::sqrt(96.0 / n));
  for (const double product : products) CHECK(std::abs(product / draws) < 4.0 / std::sqrt(draws));
  const double chance = std::erfc(std::numbers::sqrt2);
  CHECK(std::abs(static_cast<double>(beyond_two) / n - chance) < 4.0 * std::sqrt(chance * (1.0 - chance) / n));
}

TEST_CASE("uses, beams, scans and sensors are not correlated") {
  const auto correlation = [](auto&& first, auto&& second) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 20000; ++i) sum += (first(i) - 0.5) * (second(i) - 0.5);
    return sum / 20000.0 * 12.0;  // of standard deviation 1 / sqrt(20000)
  };
  const double four_sigma = 4.0 / std::sqrt(20000.0);
  const Random random(1, 0), other_sensor(1, 1), other_seed(2, 0);
  const auto plain = [&](std::uint32_t i) { return random.uniform(i, 0, RandomUse::ray_choice, 0)[0]; };
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return random.uniform(i, 0, RandomUse::range_noise, 0)[0]; })) < four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return random.uniform(i, 0, RandomUse::ray_choice, 0)[1]; })) < four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return random.uniform(i, 0, RandomUse::ray_choice, 1)[0]; })) < four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return random.uniform(i, 1, RandomUse::ray_choice, 0)[0]; })) < four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return random.uniform(i + 1, 0, RandomUse::ray_choice, 0)[0]; })) < four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return other_sensor.uniform(i, 0, RandomUse::ray_choice, 0)[0]; })) <
        four_sigma);
  CHECK(std::abs(correlation(plain, [&](std::uint32_t i) { return other_seed.uniform(i, 0, RandomUse::ray_choice, 0)[0]; })) < four_sigma);
}

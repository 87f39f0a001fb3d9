// What the tests of map files share.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>

#include "../temporary_folder.hpp"
#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// Without the folder's name; "" if there is none.
template <class T>
std::string error_of(const Result<T>& result, const TemporaryFolder& folder) {
  if (result) return "";
  std::string message = result.error().message;
  const std::string prefix = folder.path().string() + "/";
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) message.erase(at, prefix.size());
  return message;
}

/// A few cells to a few hundred, a third of them unknown, corners known so that no border is lost; some are as sure as the clamps, some surer.
inline ProbabilityGrid random_grid(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  ProbabilityGrid grid;
  grid.width = 1 + below(40);
  grid.height = 1 + below(40);
  for (int i = 0; i < grid.width * grid.height; ++i) {
    const float any = (0.5F + static_cast<float>(below(1000))) / 1000.0F;
    const int kind = below(9);
    grid.probability.push_back(kind < 3 ? ProbabilityGrid::unknown : kind == 3 ? 0.971F : kind == 4 ? 0.1192F : any);
  }
  grid.probability.front() = grid.probability.back() = 0.25F;
  return grid;
}

/// The same cells in the same place, probabilities to within `tolerance`; nothing is sensed through in `read`.
inline void check_same(const ProbabilityGrid& read, const ProbabilityGrid& expected, double tolerance) {
  REQUIRE(read.width == expected.width);
  REQUIRE(read.height == expected.height);
  CHECK(read.resolution == expected.resolution);
  CHECK(read.origin.x == doctest::Approx(expected.origin.x).epsilon(1e-12));
  CHECK(read.origin.y == doctest::Approx(expected.origin.y).epsilon(1e-12));
  REQUIRE(read.probability.size() == expected.probability.size());
  CHECK(read.through.empty());
  std::size_t different = 0;
  for (std::size_t i = 0; i < read.probability.size(); ++i) {
    if (!expected.known(i) || !read.known(i)) {
      different += expected.known(i) != read.known(i);
    } else {
      different += !(std::abs(static_cast<double>(read.probability[i]) - static_cast<double>(expected.probability[i])) <= tolerance);
    }
  }
  CHECK(different == 0);
}

}  // namespace thicket

// Ratios with intervals, and the Pareto front.
#include <algorithm>
#include <cmath>

#include "thicket/base/random.hpp"
#include "thicket/sim/tradeoff.hpp"

namespace thicket {

Interval mean_ratio(const std::vector<double>& ratios, std::uint64_t seed) {
  constexpr std::size_t draws = 2000;
  Interval interval;
  if (ratios.empty()) return interval;
  const auto count = ratios.size();
  std::vector<double> logs(count);
  std::ranges::transform(ratios, logs.begin(), [](double ratio) { return std::log(ratio); });
  double sum = 0.0;
  for (const double one : logs) sum += one;
  interval.value = std::exp(sum / static_cast<double>(count));
  if (count < 2) return interval;
  const Random random(seed, 0);
  std::vector<double> means(draws);
  for (std::size_t d = 0; d < draws; ++d) {
    double drawn = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double share = random.uniform(d, 0, RandomUse::sampling, static_cast<std::uint32_t>(i / 4))[i % 4];
      drawn += logs[std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)))];
    }
    means[d] = std::exp(drawn / static_cast<double>(count));
  }
  std::ranges::sort(means);
  interval.low = means[draws / 40];
  interval.high = means[draws - 1 - draws / 40];
  return interval;
}

std::vector<bool> pareto_front(const std::vector<glm::dvec2>& points) {
  std::vector<bool> front(points.size(), false);
  const auto finite = [](const glm::dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!finite(points[i])) continue;
    bool beaten = false;
    for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
      if (i == j || !finite(points[j]) || points[j].x > points[i].x || points[j].y > points[i].y) continue;
      beaten = points[j] != points[i] || j < i;
    }
    front[i] = !beaten;
  }
  return front;
}

}  // namespace thicket

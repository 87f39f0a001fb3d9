#include "thicket/nav/coverage.hpp"

#include <algorithm>

namespace thicket {

bool Coverage::finish() {
  if (noted_ == last_) return false;  // beams point where they pointed before, as nearly always
  last_ = noted_;
  gaps_.clear();
  covered_.fill(1);
  constexpr double bin_size = 2.0 * pi / bins;
  std::vector<int> seen;
  for (int i = 0; i < bins; ++i)
    if (noted_[static_cast<std::size_t>(i)]) seen.push_back(i);
  if (seen.empty()) {
    gaps_.push_back({-pi, 2.0 * pi});
    covered_.fill(0);
    return true;
  }
  const double widest = std::max(radians(5.0), 1.5 * 2.0 * pi / static_cast<double>(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const int from = seen[i], to = i + 1 < seen.size() ? seen[i + 1] : seen.front() + bins;
    if ((to - from) * bin_size <= widest) continue;
    gaps_.push_back({wrap_angle((from + 0.5) * bin_size - pi), (to - from) * bin_size});
    for (int k = from + 1; k < to; ++k) covered_[static_cast<std::size_t>(k % bins)] = 0;
  }
  return true;
}

void Coverage::read(const Contour& contour) {
  begin();
  for (const ContourPoint& point : contour) note(point.bearing);
  finish();
}

double Coverage::unseen(double centre, double half_width) const {
  double sum = 0.0;
  for (const Gap& gap : gaps_) {
    // Both as intervals on a line, and the gap once more a turn farther and a turn nearer.
    const double from = wrap_angle(gap.from - (centre - half_width));
    for (const double turn : {-2.0 * pi, 0.0, 2.0 * pi}) sum += std::max(0.0, std::min(from + turn + gap.width, 2.0 * half_width) - std::max(from + turn, 0.0));
  }
  return std::min(sum, 2.0 * half_width);
}

}  // namespace thicket

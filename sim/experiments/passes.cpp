#include "passes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace thicket {

std::size_t Pass::closest() const {
  return static_cast<std::size_t>(std::min_element(y.begin(), y.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) - y.begin());
}

std::vector<double> Pass::sum() const {
  std::vector<double> total(profiles.empty() ? 0 : profiles.front().size());
  for (const std::vector<float>& profile : profiles)
    for (std::size_t bin = 0; bin < total.size(); ++bin) total[bin] += static_cast<double>(profile[bin]);
  return total;
}

Top Pass::strongest(std::size_t scan, double low, double high) const {
  Top top;
  for (std::size_t bin = 0; bin < profiles[scan].size(); ++bin)
    if (const double r = range(bin), a = static_cast<double>(profiles[scan][bin]); r >= low && r <= high && a > top.amplitude) top = {r, a};
  return top;
}

Top Pass::strongest_of_sum(double low, double high) const {
  const std::vector<double> total = sum();
  Top top;
  for (std::size_t bin = 0; bin < total.size(); ++bin)
    if (const double r = range(bin); r >= low && r <= high && total[bin] > top.amplitude) top = {r, total[bin]};
  return top;
}

double Pass::found(double x, double tolerance) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < y.size(); ++i) count += std::abs(detected[i] - std::hypot(x, y[i])) <= tolerance;
  return static_cast<double>(count) / static_cast<double>(y.size());
}

Pass fly_past(Simulation simulation) {
  Pass pass;
  std::optional<std::uint64_t> last;
  bool goes_on = true;
  while (goes_on) {
    const double y = simulation.platform().pose.position.y;  // a scan is made at the beginning of a step
    goes_on = simulation.step();
    const Scan& scan = simulation.scans().front();
    if (scan.profiles.bins == 0 || last == scan.number) continue;
    last = scan.number;
    pass.y.push_back(y);
    const auto profile = scan.profiles.amplitude_of(0), threshold = scan.profiles.threshold_of(0);
    pass.profiles.emplace_back(profile.begin(), profile.end());
    pass.threshold.assign(threshold.begin(), threshold.end());
    pass.detected.push_back(scan.echoes.empty() ? NAN : scan.echoes.front().range);
    pass.first_range = scan.profiles.first_range;
    pass.bin_size = scan.profiles.bin_size;
  }
  return pass;
}

}  // namespace thicket

// How the studies of navigation state what they found: tables in Markdown, quantiles, parts of a page, and what a run that drifted amounts to.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/sim/reachability.hpp"

namespace thicket::study {

using Row = std::vector<std::string>;

/// The first `words` columns to the left, the others, which are numbers, to the right.
inline std::string markdown(const Row& head, const std::vector<Row>& rows, std::size_t words = 1) {
  const auto line = [](const Row& row) { return fmt::format("| {} |\n", fmt::join(row, " | ")); };
  std::string text = line(head) + "|";
  for (std::size_t i = 0; i < head.size(); ++i) text += i < words ? "---|" : "---:|";
  text += "\n";
  for (const Row& row : rows) text += line(row);
  return text;
}

/// The least value that at least this share of the values do not exceed (nearest rank); NaN of none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::max(0.0, std::ceil(share * static_cast<double>(values.size())) - 1.0))];
}

inline std::string fixed(double value, int decimals = 2) { return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-"; }
inline double share(std::size_t part, std::size_t of) { return of ? static_cast<double>(part) / static_cast<double>(of) : std::numeric_limits<double>::quiet_NaN(); }
inline std::string percent(std::size_t part, std::size_t of) { return of ? fmt::format("{:.1f} %", 100.0 * share(part, of)) : "-"; }
/// "2.81 (5.91)"
inline std::string median_and_p90(const std::vector<double>& values) { return values.empty() ? "-" : fmt::format("{} ({})", fixed(quantile(values, 0.5)), fixed(quantile(values, 0.9))); }

/// A page with another text between the lines `<!-- begin NAME -->` and `<!-- end NAME -->`. Error: it has no such lines.
inline Result<std::string> with_part(const std::string& page, const std::string& name, const std::string& text) {
  const std::string begin = fmt::format("<!-- begin {} -->\n", name), end = fmt::format("<!-- end {} -->", name);
  const auto from = page.find(begin);
  const auto to = from == std::string::npos ? from : page.find(end, from);
  if (to == std::string::npos) return Error{fmt::format("the page has no lines '<!-- begin {} -->' and '<!-- end {} -->'", name, name)};
  return page.substr(0, from + begin.size()) + "\n" + text + "\n" + page.substr(to);
}

/// A way's length over another one, of runs that truly reached what can be reached. Ways from a start that is nearly at the goal have none that means anything.
enum class Over { shortest, straight };
inline std::vector<double> ratios(const std::vector<Attempt>& attempts, Over what) {
  std::vector<double> list;
  for (const Attempt& a : attempts) {
    const double base = what == Over::shortest ? a.shortest_m : a.straight_m;
    if (a.score == Score::right && a.verdict == Verdict::Kind::reached && base > 0.5 && base < infinity) list.push_back(a.path_m / base);
  }
  return list;
}

/// What runs whose odometry drifts end with.
struct DriftTally {
  std::size_t reachable = 0, runs = 0;  ///< of problems that are not ambiguous
  std::size_t success = 0;              ///< said reached, and was within `slack_m` of the goal's tolerance
  std::size_t false_failure = 0;        ///< said unreachable, or was stopped, though the goal can be reached
  std::size_t stopped = 0;              ///< those of them that were stopped
  std::size_t false_success = 0;        ///< said reached, and was farther away than that
  std::size_t collisions = 0;
};
inline DriftTally drift_tally(const std::vector<Attempt>& attempts, double goal_tolerance_m, double slack_m) {
  DriftTally tally;
  for (const Attempt& a : attempts) {
    if (a.expected == Expected::ambiguous) continue;
    const bool reachable = a.expected == Expected::reachable, near = a.goal_distance_m <= goal_tolerance_m + slack_m;
    ++tally.runs;
    tally.reachable += reachable;
    tally.collisions += a.collided();
    tally.success += reachable && a.verdict == Verdict::Kind::reached && near;
    tally.false_success += a.verdict == Verdict::Kind::reached && !near;
    tally.stopped += reachable && a.verdict == Verdict::Kind::stopped;
    tally.false_failure += reachable && (a.verdict == Verdict::Kind::unreachable || a.verdict == Verdict::Kind::stopped);
  }
  return tally;
}

}  // namespace thicket::study

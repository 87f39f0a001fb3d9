// What many runs amount to.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "thicket/sim/reachability.hpp"

namespace thicket {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The least value that at least this share of the values do not exceed (nearest rank).
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return none;
  const auto rank = static_cast<std::ptrdiff_t>(std::max(0.0, std::ceil(share * static_cast<double>(values.size())) - 1.0));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

ReachabilityTotals total_of(const std::string& planner, const std::string& family, const std::vector<const Attempt*>& attempts) {
  // Ways from a start that is nearly at the goal have no ratio that means anything.
  constexpr double shortest_way = 0.5;
  ReachabilityTotals t;
  t.planner = planner;
  t.family = family;
  std::vector<double> ratios;
  for (const Attempt* a : attempts) {
    ++t.problems;
    t.right += a->score == Score::right;
    t.wrong += a->score == Score::wrong;
    t.ambiguous += a->expected == Expected::ambiguous;
    t.unreachable += a->expected == Expected::unreachable;
    t.collisions += a->collided();
    t.over_bound += a->over_bound();
    if (a->bounded() && a->bound_m > shortest_way) t.bound_use = std::max(t.bound_use, a->path_m / a->bound_m);
    if (a->score == Score::right && a->verdict == Verdict::Kind::reached && a->shortest_m < infinity && a->shortest_m > shortest_way) ratios.push_back(a->path_m / a->shortest_m);
    t.least_clearance_m = std::min(t.least_clearance_m, a->least_clearance_m);
    t.simulated_s += a->simulated_s;
  }
  t.ratio_median = quantile(ratios, 0.5);
  t.ratio_p90 = quantile(ratios, 0.9);
  return t;
}

/// A number to a tenth of a millimetre; nothing where there is none.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : ""; }

/// A text as a field of a CSV row.
std::string field(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::vector<ReachabilityTotals> total(const std::vector<Attempt>& attempts) {
  std::vector<std::string> planners, families;
  const auto note = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const Attempt& a : attempts) {
    note(planners, a.planner);
    note(families, a.family);
  }
  std::vector<ReachabilityTotals> totals;
  for (const std::string& planner : planners) {
    std::vector<const Attempt*> all;
    std::size_t several = 0;
    for (const std::string& family : families) {
      std::vector<const Attempt*> own;
      for (const Attempt& a : attempts)
        if (a.planner == planner && a.family == family) own.push_back(&a);
      if (own.empty()) continue;
      ++several;
      totals.push_back(total_of(planner, family, own));
      all.insert(all.end(), own.begin(), own.end());
    }
    if (several > 1) totals.push_back(total_of(planner, "all", all));
  }
  return totals;
}

std::string attempts_csv(const std::vector<Attempt>& attempts) {
  std::string text =
      "family,number,planner,hand,expected,verdict,score,path_m,straight_m,shortest_m,bound_m,least_clearance_m,goal_distance_m,simulated_s,cell_m,doubt_m,reason\n";
  for (const Attempt& a : attempts) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f},{},{},{}\n", field(a.family), a.number, a.planner, a.hand, to_string(a.expected), to_string(a.verdict),
                        to_string(a.score), number(a.path_m), number(a.straight_m), number(a.shortest_m), number(a.bound_m), number(a.least_clearance_m), number(a.goal_distance_m),
                        a.simulated_s, number(a.cell_m), number(a.doubt_m), field(a.reason));
  }
  return text;
}

}  // namespace thicket

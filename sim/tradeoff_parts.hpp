// What the study of the trade is made of: runs, what they cost, and how far they are from the reference. Private to tradeoff*.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "thicket/sim/simulation.hpp"
#include "thicket/sim/tradeoff.hpp"

namespace thicket {

/// Where a run was at some time.
struct TradeMoment {
  double time = 0.0;  ///< s
  Platform platform;
};

/// A run that came to its end.
struct TradeRun {
  double simulated_s = 0.0, wall_s = 0.0, cpu_s = 0.0;  ///< stepping alone
  std::uint64_t rays = 0;
  std::size_t map_bytes = 0;
  std::optional<double> peak_mb;
  double map_f1 = TradeError::none;
  Verdict verdict;
  std::vector<TradeMoment> moments;       ///< evenly over the run
  std::vector<glm::dvec2> way;       ///< places 5 cm apart or more
};

/// Runs a mission in a scene. `interrupted` is asked now and then; a run that it ended has the verdict stopped, for the reason "interrupted". The score of the map, if it is
/// asked for, is not part of the times.
Result<TradeRun> trade_run(const Mission& mission, const Scene& scene, bool score, const std::function<bool()>& interrupted);

/// At most so many of the moments, evenly.
std::vector<TradeMoment> thinned(const std::vector<TradeMoment>& moments, std::size_t most);

/// The mission's sensors at these moments: moment by moment, sensor by sensor. Same seed, same scans.
std::vector<Scan> measured(const Mission& mission, const Scene& scene, const std::vector<TradeMoment>& moments, std::uint64_t seed);

/// Fills in what scans tell: range, amplitude, disagreement. Both have the same sensors at the same moments. Of scanning sensors each beam of the reference is held against the nearest of the other's
/// in azimuth, so that what lies between coarse beams counts as lost.
void compare_scans(const std::vector<Scan>& reference, const std::vector<Scan>& other, TradeError& error);

/// Mean distance of the places of one way from the other way, or the other way round, whichever is more, m; NaN of an empty one.
double way_distance(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b);

/// All of it: the run of a mission against the reference's.
TradeError trade_error(const TradeRun& reference, const TradeRun& run, const std::vector<Scan>& reference_scans, const std::vector<Scan>& scans);

}  // namespace thicket

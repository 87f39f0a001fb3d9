// What accuracy costs: a mission with its knobs turned, each run's cost against its error. docs/tradeoff.md explains every figure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {

/// One place of a knob: changes of a mission's keys.
struct KnobSetting {
  std::string label;  ///< "x 0.5", "quadtree"
  std::vector<Override> changes;
  bool finer = false;  ///< more accurate than the mission's own
};

/// Something that trades cost for accuracy.
struct Knob {
  std::string name, help;
  bool accuracy = false;  ///< the reference run has it at its first setting, if that is finer than the mission's own; else as the mission has it
  /// From the most accurate to the cheapest, the mission's own one left out; empty where the mission has nothing to turn. A value that is out of its key's range is sorted out later.
  std::vector<KnobSetting> (*settings)(const Mission& mission) = nullptr;
};

/// All knobs. To add one is to add a row to the table in sim/tradeoff_knobs.cpp.
const std::vector<Knob>& tradeoff_knobs();

/// Those of these names ("rays,bounces"), in the order of the table; all for an empty text. Error: an unknown name, with the nearest known one.
Result<std::vector<const Knob*>> chosen_knobs(const std::string& names);

/// How far a run is from the reference run. NaN where there is nothing to compare (no map, no echoes).
struct TradeError {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double range_rmse_m = none;      ///< first echoes of both, beam by beam of the reference, seen from its poses
  double amplitude_db = none;      ///< median of the absolute differences of the same echoes
  double disagreement = none;      ///< share of beams in which one detects something and the other does not
  double map_f1 = none;            ///< of its own run, against the world
  double map_f1_loss = none;       ///< by how much that is less than the reference's; 0 if it is more
  double path_m = none;            ///< mean distance of its way from the reference's, or of that from its own, whichever is more
  bool same_verdict = false;       ///< as the reference; what ran until its time was over is not as what stopped by itself

  /// One number of all: root mean square of range, amplitude, disagreement, loss of F1 and path, each over its tolerance (`trade_tolerances`). At 1 a run is on average just as far off as the tolerances allow.
  double total() const;
};
/// What total() divides by: 0.05 m, 0.5 dB, 1 %, 0.01, 0.1 m.
struct TradeTolerances {
  double range_m = 0.05, amplitude_db = 0.5, disagreement = 0.01, map_f1 = 0.01, path_m = 0.1;
};
inline constexpr TradeTolerances trade_tolerances{};

/// A number with the interval that holds it in 95 of 100 cases; both ends are NaN where fewer than two pairs were run.
struct Interval {
  double value = std::numeric_limits<double>::quiet_NaN(), low = value, high = value;
};
/// Geometric mean of ratios > 0, and its interval by bootstrap (Efron 1979): quantiles 2.5 % and 97.5 % of the means of 2000 draws with replacement. The same for the same seed.
Interval mean_ratio(const std::vector<double>& ratios, std::uint64_t seed);

/// Settings, what they cost, and what they lose.
struct TradePoint {
  std::string name;  ///< "rays x 0.5, bounces 3"; "as it is": the mission itself; "reference"
  std::vector<std::string> knobs;
  std::vector<Override> changes;
  std::size_t repeats = 0;  ///< runs, each paired with one of the mission as it is
  Interval cpu, wall;       ///< cost per simulated second over that of the paired runs
  double cpu_s = 0.0, wall_s = 0.0;       ///< per simulated second, medians
  double rays_per_s = 0.0;                ///< per simulated second
  std::size_t map_bytes = 0;              ///< at the end
  std::optional<double> peak_mb;          ///< most memory of the process during the run (Linux); nothing: not known
  double simulated_s = 0.0;
  std::string verdict;
  TradeError error;
  bool on_front = false;
};

/// Which points are on the Pareto front: no other one is at most as high in both coordinates and lower in one. Points that are not finite are not; of equal ones the first is.
std::vector<bool> pareto_front(const std::vector<glm::dvec2>& points);

/// A mission file that the study recommends, and the run that verified it.
struct Recommendation {
  std::string name;  ///< fast, balanced, exact
  std::size_t point = 0;        ///< of Tradeoff::points
  std::filesystem::path file;
  bool verified = false;   ///< the file, read back, ended with the verdict of the reference
  std::string verdict;
  double cpu_ratio = 0.0;  ///< of the verifying run and a run of the mission as it is beside it
  TradeError error;
};

struct TradeoffOptions {
  std::string knobs;              ///< names, separated by commas; empty: all
  double budget_s = 120.0;        ///< wall time of everything, > 0
  std::size_t repeats = 5;        ///< at most, >= 1
  std::uint64_t seed = 1;         ///< of the order of runs and of the bootstrap
  std::optional<double> seconds;  ///< simulated; nothing: as long as the budget lets it be
  std::vector<Override> overrides;  ///< of the mission, before any knob is turned
  std::filesystem::path out;      ///< folder of the recommended missions
  std::function<bool()> interrupted;
  std::function<void(const std::string&)> progress;  ///< a line at a time
};

struct Tradeoff {
  std::string mission;
  std::string reference;       ///< what the reference run is, in words
  std::string reference_verdict;  ///< with its reason
  TradeError floor;            ///< the reference's sensors against themselves with another seed: what noise alone makes
  double simulated_s = 0.0;    ///< of the reference run
  std::optional<double> cut_s;  ///< where all runs were cut short
  double budget_s = 0.0, spent_s = 0.0;
  std::vector<TradePoint> points;  ///< the mission as it is first, the reference second
  std::vector<Recommendation> recommended;
  std::vector<std::string> left_out;  ///< what the budget or the keys' ranges did not let be, a sentence each
};

/// The study. fast.toml, balanced.toml and exact.toml are written into `options.out`, read back and run. Errors: the mission cannot be read, an unknown knob, or the folder cannot be written to.
Result<Tradeoff> run_tradeoff(const std::filesystem::path& mission, const TradeoffOptions& options);

std::string tradeoff_csv(const Tradeoff& study);
std::string tradeoff_json(const Tradeoff& study);
/// The front, what was left out and what is recommended, for a person.
std::string tradeoff_text(const Tradeoff& study);
/// tradeoff.csv, tradeoff.json, tradeoff.png and tradeoff.svg.
Result<Done> write_tradeoff(const std::filesystem::path& folder, const Tradeoff& study);

}  // namespace thicket

// What the studies of navigation share: which problems, how they are run, and where the results go.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "or_exit.hpp"
#include "study_tables.hpp"
#include "thicket/sim/reachability.hpp"

namespace thicket::study {

/// As the command line gives them.
struct Options {
  std::filesystem::path maps;         ///< of the study "maps": a folder of maps, or one map
  std::size_t problems = 0;           ///< per map or family; of rooms, those whose goal can be reached
  std::size_t closed = 0;             ///< rooms whose goal cannot be reached
  std::vector<std::string> planners;
  int jobs = 1;                       ///< threads; 0: as many as there are cores
  std::filesystem::path into;         ///< folder of tables and plots
  std::filesystem::path page;         ///< whose part of the study's name is replaced; empty: none
  std::string command;                ///< that makes it, for the page
};

void study_maps(const Options& options);
void study_rooms(const Options& options);
void study_drift(const Options& options);
void study_trade(const Options& options);
void study_cost(const Options& options);

/// A generated problem with what its world says of it.
struct Judged {
  Problem problem;
  Judgement judgement;
};
/// The first `count` problems of a family that `wants` says yes to; it is asked in the order of their numbers. `looked_at`: how many that took.
std::vector<Judged> choose(const std::string& family, std::size_t count, const Mission& lean, int jobs, const std::function<bool(Expected)>& wants, std::size_t* looked_at = nullptr);
/// The first `count` of each of the ten families that are not ambiguous.
std::vector<Judged> choose_of_all(std::size_t count, const Mission& lean, int jobs);

/// One way to run a problem.
struct Variant {
  Mission lean;
  std::string planner;
};
/// Runs every problem in every way, the hand by turns left and right; planners without a theorem are stopped after 3 x the bound of Bug1 + 100 m. The attempts of each
/// variant, in the order of the problems, the same for any number of jobs (wall times apart).
std::vector<std::vector<Attempt>> run_variants(const std::vector<Judged>& problems, const std::vector<Variant>& variants, int jobs);

/// Tells on stderr how far a study has come: "37 of 200 problems, 612 x real time".
class Progress {
 public:
  Progress();
  /// `simulated_s` in all, so far.
  void show(std::size_t problems, std::size_t of, double simulated_s);
  void end(std::size_t runs, double simulated_s) const;

 private:
  double start_, shown_;
};

/// Writes `into`/NAME.md, and the text into the part NAME of the page.
void publish(const Options& options, const std::string& name, const std::string& text);
/// "Made by ...", the first paragraph of every part.
std::string made_by(const Options& options, const std::string& what);
/// Hours of simulated time.
double hours(const std::vector<std::vector<Attempt>>& attempts);

}  // namespace thicket::study

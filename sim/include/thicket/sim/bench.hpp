// What `thicket bench` is made of: the standard set, what was measured as a file, and whether two files differ.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket {

/// One thing, measured several times.
struct Measured {
  std::string name;            ///< kind/what/.../peer; those that differ only in the peer are a group, and are related to its first
  std::string unit;            ///< "ns per ray"; of "s simulated per CPU s" more is better, of all others less
  bool foreign = false;        ///< a peer that has nothing of Thicket in it: what the machine gave at that time
  std::vector<double> values;  ///< one a repetition
  std::vector<double> beside = {};  ///< of missions: what the plain loop took just before and after each of them, ns a step
  double median() const;       ///< NaN of none
};

/// What one call measured.
struct BenchReport {
  std::string version, processor;
  unsigned threads = 0;                         ///< of the machine
  double load_before = 0.0, load_after = 0.0;   ///< load averages of a minute
  bool brief = false;                           ///< made with --short: other work, other numbers
  std::vector<Measured> list;
};

/// As a file, and from it. Errors: no such file, or one of another format.
std::string bench_json(const BenchReport& report);
Result<BenchReport> read_bench(const std::filesystem::path& file);

/// The repetitions in a file of Google Benchmark, by name. Errors: as above, and what a measurement failed with.
Result<std::vector<Measured>> read_google_benchmark(const std::filesystem::path& file);

/// How one thing differs between two reports. Costs are times or bytes; of a rate, its inverse.
struct BenchChange {
  std::string name, unit;
  double before = 0.0, now = 0.0;            ///< medians; NaN: not measured
  double cost = 0.0;                         ///< now over before
  std::string yardstick;                     ///< what had to do the same work both times, and by whose change `related` is divided; empty: none
  double related = 0.0, low = 0.0, high = 0.0;  ///< now over before against the yardstick, and its interval of 95 %
  std::string verdict;                       ///< faster, slower, less, more, same; "too few" repetitions (< 5); "only before", "only now"
};

/// The interval is that of a bootstrap over the repetitions (Efron 1979: 4000 draws of the medians, percentiles 2.5 and 97.5). Costs are held against a yardstick, so that a machine that was slower as a whole makes nothing slower:
/// a mission's repetition against the plain loop beside it; a kernel against the foreign peer of its group, else the first foreign one of all. Faster or slower is what has an interval without 1 and differs by 1 % at least: less
/// comes of where the linker puts a function. Two calls give the same numbers. Error: one of the two is a short version and the other is not.
Result<std::vector<BenchChange>> compare_benches(const BenchReport& before, const BenchReport& now);

/// A loop of arithmetic and memory that no change of Thicket concerns.
inline constexpr const char* machine_loop = "machine/plain loop";

/// What is measured.
struct BenchEntry {
  std::string name;
  bool foreign = false;
  bool kernel = false;  ///< by the program of tests/bench, under this name; else here
};
/// All of it, a group after another, the first of a group first.
const std::vector<BenchEntry>& standard_bench();

struct BenchOptions {
  int repetitions = 7;
  bool brief = false;  ///< missions end after 5 s
  std::function<void(const std::string&)> progress;  ///< called with a name before it is measured
};
/// Whole missions, memory and the plain loop, of those that are wanted: each once in every round, on one thread. Errors: as of missions and worlds.
Result<std::vector<Measured>> measure_missions(const std::function<bool(const std::string& name)>& wanted, const BenchOptions& options);

}  // namespace thicket

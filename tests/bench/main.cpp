// Runs the measurements and prints their medians as the table of docs/performance.md.
//
// A name is `room/what/.../peer`. Measurements that differ only in the peer stand side by side, and each is related to the first of them. All options of Google
// Benchmark work; --benchmark_out=FILE writes everything that was measured as JSON.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench_worlds.hpp"

namespace {

class Table final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override {
    PrintBasicContext(&GetErrorStream(), context);
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const std::string name = run.run_name.function_name;
      if (run.error_occurred) {
        failed_ = true;
        fmt::print(stderr, "\n{}: {}\n", name, run.error_message);
        continue;
      }
      // One repetition has no median: it is its own.
      const bool single = run.run_type == Run::RT_Iteration && run.repetitions == 1;
      if (!single && run.aggregate_name != "median") continue;
      for (const auto& [unit, counter] : run.counters) rows_.push_back({run.family_index, name, unit, counter.value});
    }
    std::fputc('.', stderr);
    std::fflush(stderr);
  }

  void Finalize() override {
    std::fputc('\n', stderr);
    std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.order < b.order; });
    fmt::print("| measured | median | unit | against the first |\n|---|---:|---|---:|\n");
    for (const Row& row : rows_) {
      const auto group = [](const std::string& name) { return name.substr(0, name.rfind('/')); };
      const auto first = std::find_if(rows_.begin(), rows_.end(), [&](const Row& other) { return group(other.name) == group(row.name) && other.unit == row.unit; });
      const bool alone = &*first == &row;
      fmt::print("| {} | {} | {} | {} |\n", row.name, digits(row.value), row.unit, alone ? "" : fmt::format("{:.2f}", row.value / first->value));
    }
  }

  bool failed() const { return failed_; }

 private:
  struct Row {
    std::int64_t order;
    std::string name, unit;
    double value;
  };
  /// Three significant digits, without an exponent.
  static std::string digits(double value) { return value >= 100.0 ? fmt::format("{:.0f}", value) : value >= 10.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.2f}", value); }

  std::vector<Row> rows_;
  bool failed_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  // The caller's options come later and win. Repetitions are interleaved, so that what else the machine does hits all peers alike.
  std::vector<std::string> defaults = {"--benchmark_repetitions=3", "--benchmark_min_time=0.2", "--benchmark_enable_random_interleaving=true"};
  std::vector<char*> arguments = {argv[0]};
  for (std::string& option : defaults) arguments.push_back(option.data());
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  thicket::bench::register_scene();
  thicket::bench::register_radar();
  thicket::bench::register_lobes();
  thicket::bench::register_nav();
  thicket::bench::register_mapping();
  thicket::bench::register_sar();
  thicket::bench::register_snapshots();
  thicket::bench::register_missions();
  thicket::bench::register_worlds();
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  return table.failed() ? 1 : 0;
}

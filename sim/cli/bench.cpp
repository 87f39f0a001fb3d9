// `thicket bench`: the standard set as one table; the kernels are measured by the program of tests/bench, which is the one that knows Embree and other peers.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <thread>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/bench.hpp"
#include "thicket/sim/outputs.hpp"

extern char** environ;

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

/// Those of the standard set that --filter names.
Result<std::vector<BenchEntry>> chosen(const std::string& filter) {
  std::regex pattern;
  try {
    pattern = std::regex(filter);
  } catch (const std::regex_error& fault) {
    return Error{fmt::format("--filter is '{}', which is no regular expression: {}", filter, fault.what())};
  }
  std::vector<BenchEntry> list;
  for (const BenchEntry& entry : standard_bench())
    if (std::regex_search(entry.name, pattern)) list.push_back(entry);
  if (list.empty()) return Error{fmt::format("--filter '{}' names nothing of the standard set; `thicket bench --list` lists it", filter)};
  // Whatever is measured, what the machine gave at that time is told.
  if (list.front().name != machine_loop) list.insert(list.begin(), standard_bench().front());
  return list;
}

bool has_name(const std::vector<BenchEntry>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const BenchEntry& entry) { return entry.name == name; });
}

/// The program of tests/bench in the folder of this one's build. Error: how to build it.
Result<fs::path> bench_program() {
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path(), program = here / "tests" / "bench" / "bench";
  if (!failed && access(program.c_str(), X_OK) == 0) return program;
  return Error{
      "the kernels are measured by another program, tests/bench/bench in the folder of the build, and it is not there. In the source tree:\n"
      "  cmake --build --preset release --target bench && build/release/thicket bench\n"
      "`thicket bench --filter '^(whole mission|memory)'` does without it"};
}

/// A program to its end, its output thrown away. Returns its exit code; -1 if it did not come to one.
int call(const fs::path& program, const std::vector<std::string>& options) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failed != 0 || waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A name as a regular expression that means nothing else.
std::string literally(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (std::string_view(R"(\^$.|?*+()[]{})").find(c) != std::string_view::npos) text += '\\';
    text += c;
  }
  return text;
}

Result<std::vector<Measured>> measure_kernels(const std::vector<BenchEntry>& entries, int repetitions, bool brief) {
  std::string names;
  for (const BenchEntry& entry : entries)
    if (entry.kernel) names += (names.empty() ? "" : "|") + literally(entry.name);
  if (names.empty()) return std::vector<Measured>{};
  const auto program = bench_program();
  if (!program) return program.error();
  const fs::path file = fs::temp_directory_path() / fmt::format("thicket-bench-{}.json", getpid());
  const int code = call(*program, {"--benchmark_filter=^(" + names + ")(/real_time)?$", fmt::format("--benchmark_repetitions={}", repetitions), fmt::format("--benchmark_min_time={}", brief ? "0.005" : "0.1"),
                                   "--benchmark_enable_random_interleaving=true", "--benchmark_out=" + file.string(), "--benchmark_out_format=json"});
  auto read = read_google_benchmark(file);
  std::error_code ignored;
  fs::remove(file, ignored);
  if (code != 0) return Error{fmt::format("{} ended with {}: call it yourself to see why", program->string(), code)};
  if (!read) return read.error();
  std::vector<Measured> list;
  for (const BenchEntry& entry : entries) {
    const auto count = list.size();
    for (const Measured& m : *read)
      if (m.name == entry.name && m.unit != "ms in all") list.push_back({m.name, m.unit, entry.foreign, m.values, {}});  // (That says the same again.)
    if (entry.kernel && list.size() == count) return Error{fmt::format("{} did not measure '{}': it was built from other sources; build it again", program->string(), entry.name)};
  }
  return list;
}

double load() {
  double averages[1] = {0.0};
  return getloadavg(averages, 1) == 1 ? averages[0] : 0.0;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

Result<BenchReport> measure(const BenchArguments& a, const std::vector<BenchEntry>& entries) {
  BenchReport report;
  report.version = version();
  report.processor = processor();
  report.threads = std::max(1u, std::thread::hardware_concurrency());
  report.brief = a.brief;
  report.load_before = load();
  BenchOptions options;
  options.brief = a.brief;
  options.repetitions = a.repetitions.value_or(a.brief ? 3 : 7);
  const auto kernels = measure_kernels(entries, options.repetitions, a.brief);
  if (!kernels) return kernels.error();
  const auto missions = measure_missions([&](const std::string& name) { return has_name(entries, name); }, options);
  if (!missions) return missions.error();
  report.load_after = load();
  for (const BenchEntry& entry : entries)
    for (const std::vector<Measured>* part : {&*kernels, &*missions})
      for (const Measured& m : *part)
        if (m.name == entry.name) report.list.push_back(m);
  return report;
}

/// Three significant digits, without an exponent.
std::string digits(double value) { return !std::isfinite(value) ? "-" : value >= 100.0 ? fmt::format("{:.0f}", value) : value >= 10.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.2f}", value); }

std::string table_of(const BenchReport& report) {
  std::vector<Row> rows = {{"measured", "median", "least", "most", "unit", "against the first"}};
  for (const Measured& m : report.list) {
    const auto group = [](const std::string& name) { return name.substr(0, name.rfind('/')); };
    const auto first = std::find_if(report.list.begin(), report.list.end(), [&](const Measured& other) { return group(other.name) == group(m.name) && other.unit == m.unit; });
    const auto [least, most] = std::minmax_element(m.values.begin(), m.values.end());
    rows.push_back({m.name, digits(m.median()), digits(*least), digits(*most), m.unit, &*first == &m ? "" : digits(m.median() / first->median())});
  }
  return aligned(rows, {"unit"});
}

std::string table_of(const std::vector<BenchChange>& changes) {
  std::vector<Row> rows = {{"measured", "before", "now", "unit", "cost now / before", "against the yardstick", "95 %", "verdict"}};
  for (const BenchChange& c : changes)
    rows.push_back({c.name, digits(c.before), digits(c.now), c.unit, digits(c.cost), digits(c.related), std::isfinite(c.low) ? fmt::format("{:.3f} to {:.3f}", c.low, c.high) : "-", c.verdict});
  return aligned(rows, {"unit", "verdict"});
}

void print_machine(const char* what, const BenchReport& report) {
  const auto repetitions = report.list.empty() ? 0 : report.list.front().values.size();
  fmt::print("{}Thicket {} on {}, {} threads; load {:.1f} before and {:.1f} after; {} repetitions{}\n", what, report.version, report.processor, report.threads, report.load_before, report.load_after, repetitions,
             report.brief ? ", the short version" : "");
}

int print_changes(const BenchReport& before, const BenchReport& now) {
  const auto changes = compare_benches(before, now);
  if (!changes) return complain(changes.error());
  fmt::print("\n{}\n", table_of(*changes));
  print_machine("before: ", before);
  print_machine("now:    ", now);
  if (before.processor != now.processor) fmt::print("These are two machines: only what is held against a peer of its own group means something.\n");
  std::size_t judged = 0, differ = 0;
  for (const BenchChange& c : *changes) {
    judged += std::isfinite(c.low) && c.verdict != "too few";
    differ += c.verdict == "faster" || c.verdict == "slower" || c.verdict == "less" || c.verdict == "more";
  }
  fmt::print("{} of {} differ; one of twenty would by chance, and more where other programs came and went between the repetitions.\n", differ, judged);
  return done;
}

}  // namespace

int measure_speed(const BenchArguments& a) {
  if (a.list) {
    for (const BenchEntry& entry : standard_bench()) fmt::print("{}\n", entry.name);
    return done;
  }
  // What may be wrong with files is told before minutes of measuring.
  std::optional<BenchReport> before;
  if (!a.compare.empty()) {
    auto read = read_bench(a.compare);
    if (!read) return complain(read.error());
    before = std::move(*read);
  }
  if (!a.with.empty()) {
    const auto read = read_bench(a.with);
    if (!read) return complain(read.error());
    return print_changes(*before, *read);
  }
  const auto entries = chosen(a.filter);
  if (!entries) return complain(entries.error());
  if (before && before->brief != a.brief) return complain({fmt::format("{} was measured {} --short: measure now {} it, too", a.compare, before->brief ? "with" : "without", before->brief ? "with" : "without")});
  if (before) std::erase_if(before->list, [&](const Measured& m) { return !has_name(*entries, m.name); });
  if (!a.quiet) fmt::print(stderr, "measuring {} things, {} ...\n", entries->size(), a.brief ? "in short" : "a few minutes");
  const auto report = measure(a, *entries);
  if (!report) return complain(report.error());
  if (!a.json.empty())
    if (const auto written = write_file(a.json, bench_json(*report)); !written) return complain(written.error());
  fmt::print("{}\n", table_of(*report));
  if (before) return print_changes(*before, *report);
  print_machine("", *report);
  return done;
}

}  // namespace thicket::cli

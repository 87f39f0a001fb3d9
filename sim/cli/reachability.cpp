#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/reachability.hpp"

namespace thicket::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;
void on_interrupt(int) { interrupted = 1; }

/// A bar that is written over on a terminal, plain lines in a log.
class Bar {
 public:
  explicit Bar(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), shown_(start_) {}

  void show(const ReachabilityProgress& p) {
    const auto now = Clock::now();
    if (quiet_ || now - shown_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000))) return;
    shown_ = now;
    const std::string line = fmt::format("{} of {} problems, {} wrong, {:.0f} x real time", p.problems, p.of, p.wrong, p.simulated_s / elapsed());
    if (terminal_) {
      const std::size_t done = 30 * p.problems / std::max<std::size_t>(p.of, 1);
      fmt::print(stderr, "\r\033[K[{}{}] {}", std::string(done, '#'), std::string(30 - done, '.'), line);
    } else {
      fmt::print(stderr, "{}\n", line);
    }
    std::fflush(stderr);
  }
  void end() const {
    if (!quiet_ && terminal_) fmt::print(stderr, "\r\033[K");
  }
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_;
  Clock::time_point start_, shown_;
};

/// The flags that stand for keys of the mission, in the order that lets --set have the last word.
Result<std::vector<Override>> changes_of(const ReachabilityArguments& a) {
  std::vector<Override> list;
  const auto number = [&](const char* key, const std::optional<double>& value, const char* flag) {
    if (value) list.push_back({key, to_toml(*value), flag});
  };
  if (!a.vehicle.empty()) list.push_back({"vehicle.preset", toml_string(a.vehicle), "--vehicle"});
  number("vehicle.radius_m", a.radius, "--radius");
  number("planner.clearance_m", a.clearance, "--clearance");
  number("sensor.range_noise_m", a.noise, "--noise");
  number("limits.time_s", a.time_limit, "--time-limit");
  if (a.rays) list.push_back({"sensor.step_deg", to_toml(360.0 / *a.rays), "--rays"});
  for (const std::string& set : a.sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos) return Error{"--set is '" + set + "', expected KEY=VALUE, for example planner.speed_m_s=0.35"};
    list.push_back({set.substr(0, equals), set.substr(equals + 1), "--set " + set.substr(0, equals)});
  }
  return list;
}

/// --world, --start and --goal.
Result<ProblemList> one_problem(const ReachabilityArguments& a) {
  const auto file = find_world(a.world);
  if (!file) return file.error();
  auto start = numbers<3>(a.start);
  if (const auto place = numbers<2>(a.start)) start = {(*place)[0], (*place)[1], 0.0};
  if (!start) return Error{fmt::format("--start is '{}', expected X,Y,YAW_DEG, for example 1.5,-2,90", a.start)};
  const auto goal = numbers<2>(a.goal);
  if (!goal) return Error{fmt::format("--goal is '{}', expected X,Y, for example 8,0", a.goal)};
  MapOptions options;
  options.cell_size = a.cell_size;
  auto world = read_world(*file, options);
  if (!world) return world.error();
  Problem problem{file->stem().string(), 0, std::make_shared<const World>(std::move(*world)), *file, 0.0, {{(*start)[0], (*start)[1]}, radians((*start)[2])}, {(*goal)[0], (*goal)[1]}};
  if (file->extension() == ".map") problem.cell_size_m = a.cell_size.value_or(1.0);
  return listed_problems({std::move(problem)});
}

Result<ProblemList> problems_of(const ReachabilityArguments& a, const Robot& robot) {
  if (!a.world.empty()) return one_problem(a);
  if (!a.maps.empty()) {
    MapProblems how;
    how.problems_per_map = static_cast<std::size_t>(a.per_map);
    how.cell_size_m = a.cell_size.value_or(how.cell_size_m);
    auto read = read_problems(a.maps, how, robot);
    if (!read) return read.error();
    if (!a.quiet)
      for (const std::string& notice : read->notices) fmt::print(stderr, "{}\n", notice);
    return listed_problems(std::move(read->problems));
  }
  const auto count = static_cast<std::size_t>(a.rooms ? *a.rooms : a.problems);
  return generated_problems(a.rooms ? std::vector<std::string>{"rooms2019"} : a.families.empty() ? problem_families() : a.families, static_cast<std::uint64_t>(a.first), count, robot);
}

std::string hundredths(double value) { return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-"; }

std::string table_of(const std::vector<Attempt>& attempts) {
  std::vector<Row> rows = {{"planner", "family", "problems", "right", "wrong", "ambiguous", "collisions", "unreachable", "length/shortest", "p90", "length/bound", "over", "clearance", "simulated"}};
  for (const ReachabilityTotals& t : total(attempts))
    rows.push_back({t.planner, t.family, std::to_string(t.problems), std::to_string(t.right), std::to_string(t.wrong), std::to_string(t.ambiguous), std::to_string(t.collisions),
                    std::to_string(t.unreachable), hundredths(t.ratio_median), hundredths(t.ratio_p90), t.bound_use > 0.0 ? hundredths(t.bound_use) : "-", std::to_string(t.over_bound),
                    fmt::format("{:.3f} m", t.least_clearance_m), fmt::format("{:.0f} s", t.simulated_s)});
  return aligned(rows, {"family"});
}

/// The first wrong runs of each planner, collisions before the others, and how to run them again.
std::string wrong_ones(const std::vector<Attempt>& attempts, const ReachabilityArguments& a) {
  constexpr std::size_t most = 20;
  std::vector<const Attempt*> wrong;
  for (const Attempt& one : attempts)
    if (one.score == Score::wrong || one.over_bound()) wrong.push_back(&one);
  std::stable_sort(wrong.begin(), wrong.end(), [](const Attempt* x, const Attempt* y) {
    const auto rank = [](const Attempt* t) { return t->collided() ? 0 : t->score == Score::wrong ? 1 : 2; };
    return rank(x) < rank(y);
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(most, wrong.size()); ++i) {
    const Attempt& w = *wrong[i];
    text += fmt::format("{} {}, {}, {} hand: {}, but {}{}: {}\n", w.family, w.number, w.planner, w.hand, to_string(w.expected), to_string(w.verdict),
                        w.score == Score::wrong ? "" : fmt::format(", {:.1f} m long where the bound is {:.1f} m", w.path_m, w.bound_m), w.reason);
    if (a.maps.empty() && a.world.empty())
      text += fmt::format("  thicket reachability {} --first {} --problems 1 --planners {} --hand {} --keep-failures DIR\n", "--families " + w.family, w.number, w.planner, w.hand);
  }
  if (wrong.size() > most) text += fmt::format("... and {} more (--csv has them all)\n", wrong.size() - most);
  return text;
}

}  // namespace

int study_reachability(const ReachabilityArguments& arguments) {
  const auto changes = changes_of(arguments);
  if (!changes) return complain(changes.error());
  const auto lean = lean_mission(*changes);
  if (!lean) return complain(lean.error());
  const auto problems = problems_of(arguments, robot_of(*lean));
  if (!problems) return complain(problems.error());
  ReachabilityOptions options;
  if (!arguments.planners.empty()) options.planners = arguments.planners;
  options.hand = arguments.hand;
  // Who asks for rays, or for another sensor, gets them.
  options.finer_for_narrow = std::none_of(changes->begin(), changes->end(), [](const Override& change) { return change.key == "sensor.step_deg" || change.key == "sensor.preset"; });
  options.jobs = arguments.jobs;
  options.keep_failures = arguments.keep_failures;
  Bar bar(arguments.quiet);
  options.progress = [&bar](const ReachabilityProgress& p) { bar.show(p); };
  options.interrupted = [] { return interrupted != 0; };
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  const auto attempts = run_reachability(*problems, *lean, options);
  bar.end();
  if (!attempts) return complain(attempts.error());

  if (!arguments.csv.empty()) {
    if (arguments.csv == "-") fmt::print("{}", attempts_csv(*attempts));
    else if (const auto written = write_file(arguments.csv, attempts_csv(*attempts)); !written) return complain(written.error());
  }
  const std::string rest = wrong_ones(*attempts, arguments);
  if (arguments.csv != "-") fmt::print("{}{}{}", table_of(*attempts), rest.empty() ? "" : "\n", rest);
  double simulated = 0.0;
  for (const Attempt& a : *attempts) simulated += a.simulated_s;
  if (!arguments.quiet) fmt::print(stderr, "{} runs, {:.0f} s simulated in {:.1f} s ({:.0f} x real time)\n", attempts->size(), simulated, bar.elapsed(), simulated / bar.elapsed());
  if (interrupted) {
    fmt::print(stderr, "interrupted: what was not begun is left out\n");
    return stopped;
  }
  const bool any = std::any_of(attempts->begin(), attempts->end(), [](const Attempt& a) { return a.score == Score::wrong || a.over_bound(); });
  return any ? wrong : done;
}

}  // namespace thicket::cli

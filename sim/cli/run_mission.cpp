#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>

#include <glm/geometric.hpp>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/check.hpp"
#include "thicket/sim/fidelity.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"
#include "thicket/sim/sar.hpp"

namespace thicket::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;
void on_interrupt(int) { interrupted = 1; }

/// One line that is written over on a terminal, plain lines in a log.
class Progress {
 public:
  explicit Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()) {}

  void show(const Simulation& simulation) {
    if (quiet_) return;
    const auto now = Clock::now();
    if (terminal_) {
      if (now - shown_ < std::chrono::milliseconds(100)) return;
      fmt::print(stderr, "\r\033[K{}", line(simulation, now));
    } else {
      if (now - shown_ < std::chrono::seconds(5)) return;
      if (shown_ != Clock::time_point{}) fmt::print(stderr, "{}\n", line(simulation, now));
    }
    std::fflush(stderr);
    shown_ = now;
  }
  void end() const {
    if (!quiet_ && terminal_) fmt::print(stderr, "\r\033[K");
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(const Simulation& simulation, Clock::time_point now) const {
    const double wall = std::chrono::duration<double>(now - start_).count();
    const auto& goal = simulation.mission().planner.goal_m;
    const std::string distance = goal ? fmt::format(", {:.1f} m to the goal", glm::distance(simulation.vehicle().pose.position, *goal)) : "";
    return fmt::format("{:8.1f} s simulated, {:.0f} x real time{}, {}", simulation.time(), wall > 0.0 ? simulation.time() / wall : 0.0, distance, simulation.decision().state);
  }

  bool quiet_, terminal_;
  Clock::time_point start_, shown_{};
};

int exit_code(const Verdict& verdict) {
  switch (verdict.kind) {
    case Verdict::Kind::reached: return done;
    case Verdict::Kind::unreachable: return unreachable;
    case Verdict::Kind::stopped: return stopped;
    case Verdict::Kind::collided: return collided;
  }
  return internal_error;
}

/// The folder of a run that names none: its name, without anything that would lead elsewhere.
std::filesystem::path standard_folder(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || (c == '.' && !plain.empty()) ? c : '_';
  return std::filesystem::path("thicket-out") / (plain.empty() ? "mission" : plain);
}

/// What would keep the outputs from being written, found before the run and not after it.
std::optional<Error> folder_fault(const std::filesystem::path& folder, const std::filesystem::path& mission_file, const Mission& mission) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault || !std::filesystem::is_directory(folder, fault) || access(folder.c_str(), W_OK) != 0)
    return Error{fmt::format("--out: the folder '{}' cannot be written to, expected one that can", folder.string())};
  for (const auto& input : {mission_file, mission.world_file, mission.image_file})
    for (const char* output : {"mission.toml", "map.yaml", "map.pgm", "map.png", "path.png", "sar.png"})
      if (!input.empty() && std::filesystem::equivalent(input, folder / output, fault))
        return Error{fmt::format("--out: '{}' is read by this run and would be overwritten, expected another folder", (folder / output).string())};
  return std::nullopt;
}

std::string summary(const Simulation& simulation, double wall, const std::filesystem::path& folder) {
  const RunTotals& totals = simulation.totals();
  return fmt::format("{}: {}\n  {:.1f} s simulated in {:.2f} s ({:.0f} x real time), path {:.1f} m, least clearance {:.2f} m, {} scans\n  written to {}\n",
                     to_string(simulation.verdict()->kind), simulation.verdict()->reason, simulation.time(), wall, wall > 0.0 ? simulation.time() / wall : 0.0,
                     totals.path_length, totals.least_clearance, totals.scans, folder.string());
}

std::string headline(const RunScore& score) {
  const MapScore& m = score.map;
  const auto figure = [](double value, int digits) { return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-"; };
  return fmt::format("  map: F1 {} within {:g} m (precision {}), NLL of claimed cells {}, coverage {} %, by {}\n", figure(m.f1, 3), m.tolerance_m, figure(m.precision, 3), figure(m.claimed_nll, 3),
                     figure(100.0 * m.coverage, 1), to_string(score.convention));
}

}  // namespace

int run_mission(const RunArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  std::filesystem::path file;
  if (!arguments.mission.empty()) {
    file = find_input(arguments.mission);
    if (file.empty()) return complain({fmt::format("there is no mission '{}'; shipped ones are listed by `thicket worlds`", arguments.mission)});
  }
  const auto mission = read_mission(file, arguments.overrides);
  if (!mission) return complain(mission.error());
  std::optional<tbb::global_control> control;
  if (arguments.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(arguments.threads));
  auto simulation = Simulation::create(*mission);
  if (!simulation) return complain(simulation.error());
  if (!arguments.quiet)
    for (const std::string& warning : mission_warnings(*simulation)) fmt::print(stderr, "warning: {}\n", warning);
  if (!arguments.quiet && !arguments.json) fmt::print("{}\n", describe(model_of(*simulation)));
  const std::filesystem::path folder = arguments.out.empty() ? standard_folder(mission->name) : std::filesystem::path(arguments.out);
  if (const auto fault = folder_fault(folder, file, *mission)) return complain(*fault);

  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  Progress progress(arguments.quiet);
  Trajectory trajectory;
  RunOptions options;
  options.realtime_factor = arguments.realtime_factor;
  options.interrupted = [] { return interrupted != 0; };
  UpdateMeter updates;
  const auto note = [&](const Simulation& s) {
    if (mission->output.score) updates.note(s);
  };
  options.progress = [&](const Simulation& s) {
    progress.show(s);
    note(s);
  };
  note(*simulation);
  const double wall_start = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double wall_run = run(*simulation, trajectory, options);
  progress.end();
  note(*simulation);

  // What cannot be scored is still a run: its files are written.
  std::optional<RunScore> score;
  if (mission->output.score) {
    const auto judged = score_run(*simulation);
    if (judged) (score = *judged)->updates = updates.updates();
    else fmt::print(stderr, "warning: no score.json: {}\n", judged.error().message);
  }
  const auto written = write_outputs(folder, *simulation, trajectory, wall_start, wall_run, score);
  if (!written) return complain(written.error());
  if (arguments.json) {
    fmt::print("{}", result_json(*simulation, score));
  } else if (!arguments.quiet) {
    fmt::print("{}{}", summary(*simulation, wall_run, folder), score ? headline(*score) : "");
    if (mission->sar.enabled) {
      const auto report = report_sar(*simulation);
      fmt::print("{}", report ? sar_text(*simulation, *report) : "no image: " + report.error().message + "\n");
    }
  }
  return exit_code(*simulation->verdict());
}

}  // namespace thicket::cli

// How good the map of a run is.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/map_file.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

/// What a folder tells of the run that wrote it.
struct Told {
  std::string version;
  std::optional<std::uint64_t> interrupted_after;  ///< steps, of a run that a person ended
};
Told read_result(const fs::path& folder) {
  Told told;
  const auto text = read_text_file(folder / "result.json");
  const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
  if (!json.is_object()) return told;
  told.version = json.value("version", "");
  if (json.value("reason", "") == "interrupted") told.interrupted_after = json.value("steps", std::uint64_t{0});
  return told;
}

/// Why the folder cannot be scored; nothing if it can.
std::optional<Error> fault_of(const fs::path& folder) {
  std::error_code none;
  if (!fs::exists(folder, none)) return Error{fmt::format("there is no folder '{}', expected one that `thicket run` has written", folder.string())};
  if (!fs::is_directory(folder, none)) return Error{fmt::format("'{}' is not a folder, expected the folder that `thicket run` has written (its --out, else thicket-out/NAME)", folder.string())};
  if (!fs::exists(folder / "mission.toml", none))
    return Error{fmt::format("'{}' has no mission.toml, expected a folder that `thicket run` has written (its --out, else thicket-out/NAME)", folder.string())};
  return std::nullopt;
}

bool same(const GridMap& a, const GridMap& b) {
  return a.width == b.width && a.height == b.height && a.resolution == b.resolution && a.origin == b.origin && a.cells == b.cells;
}

enum class Written { same, other, absent };
Result<Written> compare_with_written(const fs::path& folder, const OccupancyMap& map) {
  std::error_code none;
  if (!fs::exists(folder / "map.yaml", none)) return Written::absent;
  const auto written = read_map_file(folder / "map.yaml");
  if (!written) return written.error();
  return same(*written, map.to_grid()) ? Written::same : Written::other;
}

/// Not part of the score: it is another one each time.
std::string map_time(const Simulation& simulation) {
  const double s = simulation.phase_times().map;
  const std::uint64_t cells = simulation.map().cells_updated(), scans = simulation.totals().scans;
  if (cells == 0) return "-";  // all that is known was known before
  return fmt::format("{:.2f} ns a cell, {:.3f} ms a scan, {:.2f} s in all", 1e9 * s / static_cast<double>(cells), 1e3 * s / static_cast<double>(scans), s);
}

}  // namespace

int score_folder(const ScoreArguments& a) {
  if (a.truth != "cell_centre" && a.truth != "any_overlap") return complain({fmt::format("--truth is '{}', expected cell_centre or any_overlap", a.truth)});
  if (!std::isfinite(a.tolerance)) return complain({fmt::format("--tolerance is {}, expected metres, a finite number of at least 0", a.tolerance)});
  const fs::path folder = a.folder;
  if (const auto fault = fault_of(folder)) return complain(*fault);
  const auto mission = read_mission(folder / "mission.toml", {});
  if (!mission) return complain(mission.error());
  if (!mission->map.enabled) return complain({fmt::format("'{}' is a run without a map; run its mission.toml again with --set map.enabled=true", a.folder)});
  auto simulation = Simulation::create(*mission);
  if (!simulation) return complain(simulation.error());

  const Told told = read_result(folder);
  Trajectory trajectory;
  RunOptions options;
  if (told.interrupted_after) options.interrupted = [&simulation, &told] { return simulation->steps() >= *told.interrupted_after; };
  UpdateMeter updates;
  options.progress = [&updates](const Simulation& s) { updates.note(s); };
  updates.note(*simulation);
  const double run_s = run(*simulation, trajectory, options);
  updates.note(*simulation);
  const auto written = compare_with_written(folder, simulation->map());
  if (!written) return complain(written.error());

  const auto start = std::chrono::steady_clock::now();
  auto score = score_run(*simulation, a.truth == "cell_centre" ? Convention::cell_centre : Convention::any_overlap, a.tolerance);
  if (!score) return complain(score.error());
  score->updates = updates.updates();
  const double score_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (*written == Written::other) {
    const std::string by = told.version.empty() ? "result.json is missing" : told.version == version() ? "version " + told.version + ", as this one" : "version " + told.version + ", this one is " + version();
    fmt::print(stderr, "the run gives another map than {}: what follows is of the new one. The program has changed since (the folder's is {}), or a file of the mission or its world has; `thicket run` it again\n",
               (folder / "map.pgm").string(), by);
  }
  if (a.json) {
    fmt::print("{}", score_json(*score));
  } else {
    fmt::print("simulated again   {:.1f} s in {:.2f} s, {}; judged in {:.2f} s\n{}", simulation->time(), run_s,
               *written == Written::same ? "the map is that of map.pgm" : *written == Written::other ? "the map is NOT that of map.pgm" : "there is no map.pgm to compare with", score_s, score_text(*score));
    fmt::print("time of the map   {}\n", map_time(*simulation));
  }
  return *written == Written::other ? wrong : done;
}

}  // namespace thicket::cli

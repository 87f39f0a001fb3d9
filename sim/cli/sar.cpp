// The image of synthetic aperture of a run.
#include <fmt/format.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/sim/run.hpp"
#include "thicket/sim/sar.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

/// A run's folder, or a mission.
struct Source {
  fs::path mission, out;
  std::optional<std::uint64_t> interrupted_after;  ///< steps, of a run that a person ended
};

Result<Source> source_of(const SarArguments& a) {
  Source source;
  source.out = a.out;
  std::error_code none;
  if (fs::is_directory(a.input, none)) {
    const fs::path folder = a.input;
    source.mission = folder / "mission.toml";
    if (!fs::exists(source.mission, none)) return Error{fmt::format("'{}' has no mission.toml, expected a folder that `thicket run` has written (its --out, else thicket-out/NAME), or a mission file", a.input)};
    if (a.out.empty()) source.out = folder;
    const auto text = read_text_file(folder / "result.json");
    const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    if (json.is_object() && json.value("reason", "") == "interrupted") source.interrupted_after = json.value("steps", std::uint64_t{0});
    return source;
  }
  source.mission = find_input(a.input);
  if (source.mission.empty()) return Error{missing_input(a.input)};
  if (a.out.empty()) source.out = fs::path("thicket-out") / source.mission.stem();
  return source;
}

std::vector<Override> overrides_of(const SarArguments& a) {
  std::vector<Override> list = {{"sar.enabled", "true", "thicket sar"}};
  const auto text = [&](const char* key, const std::string& value, const char* flag) {
    if (!value.empty()) list.push_back({key, toml_string(value), flag});
  };
  const auto number = [&](const char* key, const std::optional<double>& value, const char* flag) {
    if (value) list.push_back({key, to_toml(*value), flag});
  };
  text("sar.method", a.method, "--method");
  text("sar.sensor", a.sensor, "--sensor");
  text("sar.frame", a.frame, "--frame");
  if (!a.bounds.empty()) list.push_back({"sar.bounds_m", "[" + a.bounds + "]", "--bounds"});
  number("sar.resolution_m", a.resolution, "--resolution");
  number("sar.floor_db", a.floor_db, "--floor-db");
  if (a.fuse) list.push_back({"sar.fuse", "true", "--fuse"});
  list.insert(list.end(), a.overrides.begin(), a.overrides.end());
  return list;
}

}  // namespace

int image_run(const SarArguments& a) {
  const auto source = source_of(a);
  if (!source) return complain(source.error());
  const auto mission = read_mission(source->mission, overrides_of(a));
  if (!mission) return complain(mission.error());
  auto simulation = Simulation::create(*mission);
  if (!simulation) return complain(simulation.error());
  Trajectory trajectory;
  RunOptions options;
  if (source->interrupted_after) options.interrupted = [&] { return simulation->steps() >= *source->interrupted_after; };
  const double run_s = run(*simulation, trajectory, options);
  const auto report = report_sar(*simulation);
  if (!report) return complain(report.error());
  const auto written = write_sar(source->out, *simulation, *report);
  if (!written) return complain(written.error());
  if (a.json) fmt::print("{}", sar_json(*simulation, *report));
  else fmt::print("simulated {:.1f} s in {:.2f} s, {:.2f} s of that for the image\n{}written to {}\n", simulation->time(), run_s, simulation->phase_times().sar, sar_text(*simulation, *report), source->out.string());
  return done;
}

}  // namespace thicket::cli

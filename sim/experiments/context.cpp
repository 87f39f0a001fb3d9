#include "context.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

#include "thicket/base/files.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"

namespace thicket {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The peak begins anew, where the system lets it (Linux); else it is that of the whole program.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024.0 / 1e6;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

/// "key=value"
std::vector<Override> overrides_of(const std::vector<std::string>& sets) {
  std::vector<Override> list;
  for (const std::string& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos) throw ExperimentFailure(fmt::format("'{}' is no change of a key, expected KEY=VALUE", set));
    list.push_back({set.substr(0, equals), set.substr(equals + 1), "--set " + set.substr(0, equals)});
  }
  return list;
}

}  // namespace

std::string table(const TableRow& head, const std::vector<TableRow>& rows, std::size_t words) {
  const auto line = [](const TableRow& row) { return fmt::format("| {} |\n", fmt::join(row, " | ")); };
  std::string text = line(head) + "|";
  for (std::size_t i = 0; i < head.size(); ++i) text += i < words ? "---|" : "---:|";
  text += "\n";
  for (const TableRow& row : rows) text += line(row);
  return text + "\n";
}

std::string fixed(double value, int decimals) { return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-"; }

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "-"; }

std::string measured(const std::string& text) { return fmt::format("<!-- measured -->\n*Measured on the machine that made this page; another time, other numbers:*\n\n{}<!-- end measured -->\n\n", text); }

std::string cost_table(const TableRow& names, const std::vector<std::pair<TableRow, const FinishedRun*>>& runs) {
  TableRow head = names;
  head.insert(head.end(), {"simulated, s", "wall, s", "× real time", "CPU, %", "map's share of the wall time", "peak memory, MB"});
  std::vector<TableRow> rows;
  for (const auto& [name, run] : runs) {
    const RunCost& c = run->cost;
    TableRow row = name;
    row.insert(row.end(), {fixed(run->simulation.time(), 1), fixed(c.wall_s), fixed(run->simulation.time() / c.wall_s, 0), fixed(100.0 * c.cpu_s / c.wall_s, 0), percent(c.map_s / c.wall_s), fixed(c.peak_mb, 0)});
    rows.push_back(std::move(row));
  }
  return measured(table(head, rows, names.size()));
}

ExperimentContext::ExperimentContext(const Experiment& experiment, const ExperimentOptions& options) : stem_(experiment.name), options_(options) {
  std::replace(stem_.begin(), stem_.end(), '/', '_');
}

Simulation ExperimentContext::prepare(const std::string& mission, const std::vector<std::string>& sets) const {
  const auto file = find_input(mission);
  if (file.empty()) throw ExperimentFailure(fmt::format("there is no mission '{}'", mission));
  return or_fail(Simulation::create(or_fail(read_mission(file, overrides_of(sets)))));
}

FinishedRun ExperimentContext::run(const std::string& mission, const std::vector<std::string>& sets) const {
  FinishedRun done{prepare(mission, sets), {}, {}};
  reset_peak();
  const double cpu = cpu_seconds();
  done.cost.wall_s = thicket::run(done.simulation, done.trajectory, {});
  done.cost.cpu_s = cpu_seconds() - cpu;
  done.cost.peak_mb = peak_mb();
  done.cost.map_s = done.simulation.phase_times().map;
  return done;
}

SensorScans ExperimentContext::sensor(const std::string& title, const std::string& preset, const std::vector<std::string>& sets) const {
  return {title, or_fail(find_sensor(preset, "experiment", overrides_of(sets))), {}};
}

Scene ExperimentContext::scene(const std::string& world) const {
  const auto file = find_input(world);
  if (file.empty()) throw ExperimentFailure(fmt::format("there is no world '{}'", world));
  return or_fail(Scene::build(or_fail(read_world(file))));
}

std::vector<Scan> ExperimentContext::look(const Scene& scene, const SensorSpec& spec, const ScanPose& pose, int count) const {
  ScanReport report;
  report.poses.assign(static_cast<std::size_t>(count), pose);
  report.sensors.push_back({"", spec, {}});
  measure(scene, report);
  return std::move(report.sensors[0].scans);
}

std::filesystem::path ExperimentContext::file(const std::string& name) const {
  std::error_code fault;
  std::filesystem::create_directories(options_.pictures, fault);
  if (fault) throw ExperimentFailure(fmt::format("the folder '{}' cannot be made: {}", options_.pictures.string(), fault.message()));
  return options_.pictures / (stem_ + "_" + name + ".png");
}

std::string ExperimentContext::picture(const std::string& name, const std::string& caption) const {
  return fmt::format("![{}]({}{})\n\n*{}*\n\n", name, options_.link, file(name).filename().string(), caption);
}

std::string ExperimentContext::map_picture(const std::string& name, const FinishedRun& run, const std::string& caption) const {
  or_fail(write_map_picture(file(name), run.simulation, run.trajectory));
  return picture(name, caption);
}

std::string ExperimentContext::path_picture(const std::string& name, const FinishedRun& run, const std::string& caption) const {
  or_fail(write_path_picture(file(name), run.simulation, run.trajectory));
  return picture(name, caption);
}

std::string ExperimentContext::ray_picture(const std::string& name, const RayPicture& picture, const std::string& caption) const {
  or_fail(write_ray_picture(file(name), picture));
  return this->picture(name, caption);
}

std::string ExperimentContext::scan_picture(const std::string& name, const ScanReport& report, const std::string& caption) const {
  or_fail(draw_scans(report, file(name)));
  return picture(name, caption);
}

std::string ExperimentContext::world_picture(const std::string& name, const Scene& scene, const PictureView& view, const std::string& caption) const {
  PictureView drawn = view;
  if (options_.brief) drawn.width = std::max(1, view.width / 4), drawn.height = std::max(1, view.height / 4);
  or_fail(draw_world(scene, drawn, file(name)));
  return picture(name, caption);
}

}  // namespace thicket

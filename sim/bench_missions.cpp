// The standard set, and the part of it that needs no other program: whole missions, memory, and a plain loop.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>

#include "thicket/base/files.hpp"
#include "thicket/sim/bench.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

struct MissionBench {
  const char* file;
  const char* peer;        ///< "as shipped"
  const char* change = nullptr;  ///< a key that is false
  double limit_s = infinity;     ///< simulated
  std::string name() const { return fmt::format("whole mission/{}/{}", file, peer); }
};

const std::vector<MissionBench>& missions() {
  static const std::vector<MissionBench> list = {
      {"foliage_wall/bug2", "as shipped"}, {"foliage_wall/bug2", "no map", "map.enabled"}, {"foliage_wall/map_radar", "as shipped"}, {"foliage_wall/map_radar", "no map", "map.enabled"},
      {"rooms/u", "as shipped"},           {"rooms/u", "no map", "map.enabled"},           {"findings/lobes", "as shipped"},         {"thicket/look_through", "as shipped"},
      {"quadrotor/waypoints", "the first 10 s", nullptr, 10.0}};
  return list;
}

/// Missions whose memory is told, of those above.
constexpr const char* remembered[] = {"foliage_wall/map_radar", "findings/lobes"};
std::string memory_name(const std::string& file, const char* peer) { return fmt::format("memory/{}/{}", file, peer); }
constexpr const char* grid_peer = "dense grid of two bytes a cell, reckoned";
constexpr const char* map_peer = "map";
constexpr const char* peak_peer = "peak of the program, scene included";

/// Of all threads, s.
double cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The peak begins anew, where the system lets it (Linux); else it is that of the whole call.
void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }
std::optional<double> peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024.0 / 1e6;
  return std::nullopt;
}

/// About 15 ms: numbers that depend on each other, and places of 256 kB in an order that nothing foresees. Returns ns a step.
double plain_loop() {
  constexpr std::size_t size = 1 << 15, steps = 4'000'000;
  static std::vector<double> memory(size, 1.0);
  const double begin = cpu_now();
  std::uint64_t state = 1;
  double sum = 0.0;
  for (std::size_t i = 0; i < steps; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    double& place = memory[(state >> 40) % size];
    sum = 0.5 * sum + place;
    place = 1.0 + 0x1p-20 * sum;
  }
  const double time = cpu_now() - begin;
  // (Never so: the compiler does not know.)
  return sum < 0.0 ? 0.0 : 1e9 * time / static_cast<double>(steps);
}

/// Adds repetitions in the order of the standard set.
class Notes {
 public:
  void add(const std::string& name, const std::string& unit, double value, std::optional<double> beside = std::nullopt) {
    auto& [values, besides] = notes_[{name, unit}];
    values.push_back(value);
    if (beside) besides.push_back(*beside);
  }
  std::vector<Measured> in_order() const {
    std::vector<Measured> list;
    for (const BenchEntry& entry : standard_bench())
      for (const auto& [key, values] : notes_)
        if (key.first == entry.name) list.push_back({key.first, key.second, entry.foreign, values.first, values.second});
    return list;
  }

 private:
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<double>, std::vector<double>>> notes_;
};

void note_memory(const std::string& file, const Simulation& simulation, Notes& notes, const std::function<bool(const std::string&)>& wanted) {
  const OccupancyMap& map = simulation.map();
  const auto extent = map.extent();
  if (!extent) return;
  const auto& [first, end] = *extent;
  const double cells = static_cast<double>((end.column - first.column) * (end.row - first.row)), known = static_cast<double>(map.known_cells());
  if (const std::string name = memory_name(file, grid_peer); wanted(name)) notes.add(name, "bytes per known cell", 2.0 * cells / known);
  if (const std::string name = memory_name(file, map_peer); wanted(name)) notes.add(name, "bytes per known cell", static_cast<double>(map.memory_bytes()) / known);
}

/// Once, from its start on, between two plain loops, of which the first is done already. Returns the second.
double run_once(const MissionBench& what, const Simulation& start, double loop_before, const BenchOptions& options, Notes& notes, const std::function<bool(const std::string&)>& wanted) {
  const double limit = options.brief ? std::min(5.0, what.limit_s) : what.limit_s;
  Simulation simulation = start;
  const double begin = cpu_now();
  while (simulation.step() && simulation.time() < limit) {
  }
  const double time = cpu_now() - begin;
  const double loop_after = plain_loop();
  if (wanted(what.name())) notes.add(what.name(), "s simulated per CPU s", simulation.time() / time, 0.5 * (loop_before + loop_after));
  if (what.change == nullptr && std::find(std::begin(remembered), std::end(remembered), std::string(what.file)) != std::end(remembered)) note_memory(what.file, simulation, notes, wanted);
  return loop_after;
}

bool concerns(const MissionBench& what, const std::function<bool(const std::string&)>& wanted) {
  if (wanted(what.name())) return true;
  if (what.change != nullptr || std::find(std::begin(remembered), std::end(remembered), std::string(what.file)) == std::end(remembered)) return false;
  return wanted(memory_name(what.file, grid_peer)) || wanted(memory_name(what.file, map_peer));
}

}  // namespace

const std::vector<BenchEntry>& standard_bench() {
  static const std::vector<BenchEntry> list = [] {
    std::vector<BenchEntry> all = {{machine_loop, true}};
    const auto kernels = [&all](const std::string& group, std::initializer_list<const char*> foreign, std::initializer_list<const char*> own) {
      for (const char* peer : foreign) all.push_back({group + "/" + peer, true, true});
      for (const char* peer : own) all.push_back({group + "/" + peer, false, true});
    };
    // Rays and scans, against bare Embree.
    for (const char* place : {"200 boxes", "office map"}) kernels(fmt::format("closest/{}/58 x 58 fan", place), {"Embree triangles"}, {"Thicket"});
    kernels("closest/100 spheres/58 x 58 fan", {"Embree triangles", "Embree float spheres"}, {"Thicket"});
    kernels("all surfaces/80 bushes/58 x 58 fan", {"Embree triangles, by 8"}, {"Thicket", "Thicket, 10 dB"});
    kernels("lobe/200 boxes, first surface", {"Embree triangles"}, {"lobe"});
    kernels("lobe/80 bushes, all surfaces", {"Embree triangles"}, {"lobe"});
    kernels("radar/scan of 360", {}, {"tracing alone", "radar", "lidar"});
    kernels("contact/clearance, 1 m", {}, {"200 boxes", "office map"});
    // Maps, against plain grids.
    kernels("map/map_radar/0.1 m", {"dense grid"}, {"Thicket"});
    kernels("map/map_radar/0.05 m", {"dense grid"}, {"Thicket"});
    kernels("map/open field of 30 m/0.05 m", {"dense grid"}, {"Thicket"});
    kernels("mapping/lidar360/0.05 m", {"u8 overwrite (nav2)", "int8 log-odds and epoch"}, {"Thicket"});
    kernels("mapping/lobe58/0.05 m", {"atan2 a cell"}, {"Thicket"});
    // Decisions.
    kernels("plan/bug2", {}, {"contour and bumpers", "and the decision"});
    for (const MissionBench& m : missions()) all.push_back({m.name()});
    for (const char* file : remembered) {
      all.push_back({memory_name(file, grid_peer), true});
      all.push_back({memory_name(file, map_peer)});
    }
    all.push_back({memory_name("missions above", peak_peer)});
    return all;
  }();
  return list;
}

Result<std::vector<Measured>> measure_missions(const std::function<bool(const std::string& name)>& wanted, const BenchOptions& options) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::string peak_name = memory_name("missions above", peak_peer);
  reset_peak();
  std::vector<std::pair<MissionBench, Simulation>> ready;
  for (const MissionBench& what : missions()) {
    if (!concerns(what, wanted)) continue;
    std::vector<Override> changes;
    if (what.change != nullptr) changes.push_back({what.change, "false", "bench"});
    const auto mission = read_mission(find_shipped(what.file), changes);
    if (!mission) return mission.error();
    auto simulation = Simulation::create(*mission);
    if (!simulation) return simulation.error();
    ready.emplace_back(what, std::move(*simulation));
  }
  Notes notes;
  plain_loop();  // The first one also makes its memory.
  for (int round = 0; round < options.repetitions; ++round) {
    double loop = plain_loop();
    if (wanted(machine_loop)) notes.add(machine_loop, "ns per step", loop);
    for (const auto& [what, start] : ready) {
      if (options.progress) options.progress(what.name());
      loop = run_once(what, start, loop, options, notes, wanted);
    }
    // The peak of a round holds that of all before it, where it cannot begin anew.
    if (wanted(peak_name) && !ready.empty())
      if (const auto peak = peak_megabytes()) notes.add(peak_name, "MB", *peak);
    reset_peak();
  }
  return notes.in_order();
}

}  // namespace thicket

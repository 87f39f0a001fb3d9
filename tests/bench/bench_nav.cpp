// Mapping and deciding, on what shipped missions sensed.
#include <chrono>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "bench_worlds.hpp"

namespace thicket::bench {
namespace {

/// A moment of a mission: what the planner and the map got.
struct Moment {
  double time = 0.0;
  Pose2 pose;
  double speed = 0.0, turn_rate = 0.0;
  Scan scan;

  Pose pose_in_space() const { return Pose::planar(pose.position.x, pose.position.y, 0.0, pose.yaw); }
};

std::vector<Moment> record(const char* mission, std::vector<Override> changes = {}) {
  changes.push_back({"map.enabled", "false", "bench"});
  Simulation simulation = or_exit(Simulation::create(shipped_mission(mission, changes)));
  std::vector<Moment> moments;
  for (bool goes_on = true; goes_on;) {
    const std::uint64_t decisions = simulation.totals().decisions;
    const DifferentialDrive before = simulation.vehicle();
    const double time = simulation.time();
    goes_on = simulation.step();
    if (simulation.totals().decisions > decisions) moments.push_back({time, before.pose, before.speed, before.turn_rate, simulation.scans().front()});
  }
  return moments;
}

/// A field without anything: every beam is open.
std::vector<Moment> open_field() {
  const auto sensor = make_sensor(ScanningRadarSpec{}, 0);
  const Scene nothing = or_exit(Scene::build(empty_world()));
  std::vector<Moment> moments;
  for (int i = 0; i < 20; ++i) {
    Moment moment;
    moment.pose = {{0.07 * i, 0.0}, 0.1 * i};
    sensor->measure(nothing, moment.pose_in_space(), 0.0, 0, Random(1, 0), moment.scan);
    moments.push_back(std::move(moment));
  }
  return moments;
}

/// What a mapper is usually made of: a grid that holds the whole world from the start, in which every beam is walked cell by cell, first the free cells and then those with
/// an echo, a byte of log-odds and a byte that tells in which scan the cell was last updated, so that a scan updates it once. First echo only, one layer.
class DenseGrid {
 public:
  explicit DenseGrid(double resolution) : resolution_(resolution), edge_(static_cast<std::int64_t>(std::ceil(80.0 / resolution))) {
    cells_.resize(static_cast<std::size_t>(edge_ * edge_));
  }

  void integrate(const Scan& scan, const Pose& vehicle) {
    const Pose sensor = vehicle * Pose{scan.mount_position, scan.mount_orientation};
    const glm::dvec2 from = glm::dvec2(sensor.position) / resolution_ + 0.5 * static_cast<double>(edge_);
    if (++epoch_ == 0) ++epoch_;
    for (const Beam& beam : scan.beams)
      if (beam.echo_count > 0) update(cell_at(from, sensor, beam, scan.echoes_of(beam).front().range), 27);
    for (const Beam& beam : scan.beams) walk(from, sensor, beam, beam.echo_count > 0 ? scan.echoes_of(beam).front().range : beam.sensed_range);
  }

  /// Cells that the last scan updated.
  std::size_t touched() const {
    return static_cast<std::size_t>(std::count_if(cells_.begin(), cells_.end(), [&](const Cell& c) { return c.epoch == epoch_; }));
  }

 private:
  struct Cell {
    std::int8_t log_odds = 0;
    std::uint8_t epoch = 0;
  };
  std::int64_t cell_at(const glm::dvec2& from, const Pose& sensor, const Beam& beam, double range) const {
    const glm::dvec2 p = from + glm::dvec2(sensor.orientation * beam.direction) * (range / resolution_);
    return static_cast<std::int64_t>(p.y) * edge_ + static_cast<std::int64_t>(p.x);
  }
  void update(std::int64_t index, int change) {
    Cell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.epoch == epoch_) return;
    cell.epoch = epoch_;
    cell.log_odds = static_cast<std::int8_t>(std::clamp(cell.log_odds + change, -64, 112));
  }
  void walk(const glm::dvec2& from, const Pose& sensor, const Beam& beam, double range) {
    const glm::dvec2 d(sensor.orientation * beam.direction);
    constexpr double never = std::numeric_limits<double>::infinity();
    const double step_x = d.x != 0.0 ? std::abs(1.0 / d.x) : never, step_y = d.y != 0.0 ? std::abs(1.0 / d.y) : never;
    const auto to_edge = [](double at, double towards) { return towards > 0.0 ? std::floor(at) + 1.0 - at : at - std::floor(at); };
    double next_x = d.x != 0.0 ? to_edge(from.x, d.x) * step_x : never, next_y = d.y != 0.0 ? to_edge(from.y, d.y) * step_y : never;
    std::int64_t cell = static_cast<std::int64_t>(from.y) * edge_ + static_cast<std::int64_t>(from.x);
    const double end = range / resolution_;
    for (double at = 0.0; at < end;) {
      update(cell, -13);
      if (next_x < next_y) {
        at = next_x;
        next_x += step_x;
        cell += d.x > 0.0 ? 1 : -1;
      } else {
        at = next_y;
        next_y += step_y;
        cell += d.y > 0.0 ? edge_ : -edge_;
      }
    }
  }

  double resolution_;
  std::int64_t edge_;
  std::uint8_t epoch_ = 0;
  std::vector<Cell> cells_;
};

void map_thicket(benchmark::State& state, const std::vector<Moment>& moments, double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  double touched = 0.0;
  for (const Moment& m : moments) {
    OccupancyMap one(spec);
    one.integrate(m.scan, m.pose_in_space());
    touched += static_cast<double>(one.known_cells());
  }
  OccupancyMap map(spec);
  for (auto _ : state)
    for (const Moment& m : moments) map.integrate(m.scan, m.pose_in_space());
  per_item(state, "touched cell", touched);
}

void map_dense(benchmark::State& state, const std::vector<Moment>& moments, double resolution) {
  DenseGrid map(resolution);
  double touched = 0.0;
  for (const Moment& m : moments) {
    map.integrate(m.scan, m.pose_in_space());
    touched += static_cast<double>(map.touched());
  }
  for (auto _ : state)
    for (const Moment& m : moments) map.integrate(m.scan, m.pose_in_space());
  per_item(state, "touched cell", touched);
}

/// A whole mission's decisions again: from the scan to the contour, the bumpers and, if wanted, the command.
void decisions(benchmark::State& state, const std::vector<Moment>& moments, const char* mission, bool plan) {
  const Simulation simulation = or_exit(Simulation::create(shipped_mission(mission)));
  const Mission& m = simulation.mission();
  const VehicleLimits limits = m.vehicle.limits(0.1);
  const auto planner = or_exit(make_planner(m.planner, limits, simulation.vehicle().pose));
  Contour contour;
  ContourReader reader;
  for (auto _ : state) {
    const auto fresh = planner->clone();
    BumperRing bumpers = simulation.bumpers();
    for (const Moment& moment : moments) {
      contour.clear();
      reader.add(moment.scan, contour);
      bumpers.read(contour);
      benchmark::DoNotOptimize(bumpers.any_pressed());
      if (plan) benchmark::DoNotOptimize(fresh->decide({moment.time, moment.pose, moment.speed, moment.turn_rate, contour, bumpers}));
    }
  }
  per_item(state, "decision", static_cast<double>(moments.size()));
}

/// The decisions of one planner along a wall, from the scan to the command: 8 bumpers, 180 rays, and only those made while it follows the boundary, from the contact on.
void following(benchmark::State& state, const std::vector<Moment>& moments, const Mission& mission) {
  const Simulation simulation = or_exit(Simulation::create(mission));
  const auto planner = or_exit(make_planner(mission.planner, mission.vehicle.limits(0.1), simulation.vehicle().pose));
  using Clock = std::chrono::steady_clock;
  Contour contour;
  ContourReader reader;
  // Of each decision the least time of all repetitions: others may use the cores too.
  std::vector<double> least(moments.size(), std::numeric_limits<double>::infinity());
  for (auto _ : state) {
    const auto fresh = planner->clone();
    BumperRing bumpers = simulation.bumpers();
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const Moment& moment = moments[i];
      const auto begin = Clock::now();
      contour.clear();
      reader.add(moment.scan, contour);
      bumpers.read(contour);
      const Decision decision = fresh->decide({moment.time, moment.pose, moment.speed, moment.turn_rate, contour, bumpers});
      const auto end = Clock::now();
      if (decision.state.find("hand") == std::string::npos) continue;
      least[i] = std::min(least[i], std::chrono::duration<double, std::nano>(end - begin).count());
    }
  }
  std::erase_if(least, [](double ns) { return !(ns < std::numeric_limits<double>::infinity()); });
  state.counters["following decisions"] = static_cast<double>(least.size());
  state.counters["ns per following decision"] = std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, least.size()));
}

}  // namespace

void register_nav() {
  constexpr const char* bug2 = "worlds/data/foliage_wall/bug2.toml";
  struct Source {
    const char* name;
    std::vector<Moment> moments;
  };
  std::vector<Moment> drive = record("worlds/data/foliage_wall/map_radar.toml");
  std::erase_if(drive, [i = 0](const Moment&) mutable { return i++ % 20 != 0; });
  const std::vector<Source> sources = {{"map_radar", std::move(drive)}, {"open field of 30 m", open_field()}};
  for (const auto& [name, moments] : sources) {
    for (const char* resolution : {"0.1", "0.05"}) {
      const std::string what = std::string("map/") + name + "/" + resolution + " m/";
      measure(what + "Thicket", [=](benchmark::State& s) { map_thicket(s, moments, std::stod(resolution)); });
      measure(what + "dense grid", [=](benchmark::State& s) { map_dense(s, moments, std::stod(resolution)); });
    }
  }
  const std::vector<Moment> moments = record(bug2);
  measure("plan/bug2/contour and bumpers", [=](benchmark::State& s) { decisions(s, moments, bug2, false); });
  measure("plan/bug2/and the decision", [=](benchmark::State& s) { decisions(s, moments, bug2, true); });
  for (const char* name : {"bug1", "bug2", "tangent_bug", "dist_bug", "alg1", "alg2", "i_bug", "com"}) {
    const std::vector<Override> changes = {{"planner.name", fmt::format("\"{}\"", name), "bench"}, {"sensor.step_deg", "2.0", "bench"}, {"sensor.range_max_m", "5.0", "bench"}};
    Mission mission = shipped_mission(bug2, changes);
    const std::vector<Moment> along = record(bug2, changes);
    measure(fmt::format("plan/{}/following a wall, contour, bumpers and decision", name), [=](benchmark::State& s) { following(s, along, mission); });
  }
}

}  // namespace thicket::bench

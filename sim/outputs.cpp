#include "thicket/sim/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "thicket/base/files.hpp"
#include "thicket/base/probability_file.hpp"
#include "thicket/sim/fidelity.hpp"
#include "thicket/sim/probability_picture.hpp"
#include "thicket/sim/sar.hpp"
#include "thicket/sim/travel.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: what is not finite is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Of a score what a person compares runs by; score.json has the rest.
Json headline(const RunScore& score) {
  const MapScore& m = score.map;
  return {{"truth", to_string(score.convention)},     {"tolerance_m", m.tolerance_m},
          {"f1", number(m.f1)},                       {"precision", number(m.precision)},
          {"strict_precision", number(m.strict_precision)}, {"claimed_nll", number(m.claimed_nll)},
          {"coverage", number(m.coverage)},           {"edge_error_m", number(m.edge_error_m)}};
}

Json map_summary(const Simulation& simulation, const std::optional<RunScore>& score) {
  const OccupancyMap& map = simulation.map();
  Json json;
  json["resolution_m"] = map.resolution();
  json["known_cells"] = map.known_cells();
  json["memory_bytes"] = map.memory_bytes();
  if (const auto& region = simulation.mission().output.observed_region_m) {
    const auto share = observed_share(simulation, *region);
    json["observed_share_of_free_area"] = share ? Json(*share) : Json(nullptr);
  }
  if (score) json["score"] = headline(*score);
  return json;
}

/// A further format of the map, and the files that it makes.
struct MapFormat {
  const char* name;
  std::vector<std::string> files;
  Result<Done> (*write)(const std::filesystem::path& folder, const ProbabilityGrid& grid, const Simulation& simulation);
};

/// The first sensor's, above the world's zero, where the vehicle travels (first), m.
double sensor_height(const Mission& mission) { return travel_heights(mission).front() + mounted(mission.sensors.front()).position_m.z; }

const std::vector<MapFormat>& further_formats() {
  using Path = std::filesystem::path;
  static const std::vector<MapFormat> list = {
      {"scale", {"map_scale.png", "map_scale.yaml"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation&) { return write_map_server(folder / "map_scale", grid, MapMode::scale); }},
      {"raw", {"map_raw.pgm", "map_raw.yaml"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation&) { return write_map_server(folder / "map_raw", grid, MapMode::raw); }},
      {"npy", {"map.npy"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation&) { return write_npy(folder / "map.npy", grid); }},
      {"ot", {"map.ot"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation& simulation) { return write_octomap(folder / "map.ot", grid, sensor_height(simulation.mission())); }},
      {"bt", {"map.bt"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation& simulation) { return write_octomap(folder / "map.bt", grid, sensor_height(simulation.mission())); }},
      {"picture", {"map_probability.png"}, [](const Path& folder, const ProbabilityGrid& grid, const Simulation& simulation) {
         return write_probability_picture(folder / "map_probability.png", grid, fmt::format("{}: map after {:.1f} s", simulation.mission().name, simulation.time()));
       }}};
  return list;
}

}  // namespace

const char* version() { return THICKET_VERSION; }

std::optional<double> observed_share(const Simulation& simulation, const glm::dvec4& region) {
  const World& world = simulation.stage().scene.world();
  const OccupancyMap& map = simulation.map();
  const double height = sensor_height(simulation.mission());
  const CellIndex first = map.cell_at({region.x, region.y}), last = map.cell_at({region.z, region.w});
  // The truth at the cells' own centres, at the sensor's height.
  const glm::dvec2 low = glm::dvec2(static_cast<double>(first.column), static_cast<double>(first.row)) * map.resolution();
  const glm::dvec2 high = glm::dvec2(static_cast<double>(last.column + 1), static_cast<double>(last.row + 1)) * map.resolution();
  const auto truth = occupancy(world_at(world, simulation.time()), low, high, map.resolution(), height, height, Convention::cell_centre);
  if (!truth) return std::nullopt;
  std::size_t free = 0, observed = 0;
  for (std::int64_t row = first.row; row <= last.row; ++row) {
    for (std::int64_t column = first.column; column <= last.column; ++column) {
      const glm::dvec2 centre = glm::dvec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5) * map.resolution();
      if (centre.x < region.x || centre.y < region.y || centre.x > region.z || centre.y > region.w) continue;
      if (truth->blocked[truth->index_at(centre)]) continue;
      ++free;
      observed += map.view({column, row}).known;
    }
  }
  if (free == 0) return std::nullopt;
  return static_cast<double>(observed) / static_cast<double>(free);
}

std::string result_json(const Simulation& simulation, const std::optional<RunScore>& score) {
  const Mission& mission = simulation.mission();
  const RunTotals& totals = simulation.totals();
  const Pose2& pose = simulation.vehicle().pose;
  const auto& verdict = simulation.verdict();
  Json json;
  json["mission"] = mission.name;
  json["world"] = simulation.stage().scene.world().name;
  json["planner"] = mission.planner.name;
  json["verdict"] = verdict ? to_string(verdict->kind) : "running";
  json["reason"] = verdict ? verdict->reason : "";
  json["simulated_time_s"] = simulation.time();
  json["path_length_m"] = totals.path_length;
  if (planner_needs(mission.planner.name) == PlannerNeeds::goal && mission.planner.goal_m) {
    const glm::dvec2 start(mission.start.x_m, mission.start.y_m);
    json["straight_distance_m"] = glm::distance(start, *mission.planner.goal_m);
    json["distance_to_goal_m"] = glm::distance(pose.position, *mission.planner.goal_m);
  }
  if (!mission.odometry.perfect()) {
    const Pose2& estimate = simulation.estimate();
    if (verdict && verdict->true_distance_to_goal_m) json["true_distance_to_goal_m"] = *verdict->true_distance_to_goal_m;
    json["final_estimate"] = {{"x_m", estimate.position.x}, {"y_m", estimate.position.y}, {"yaw_deg", degrees(estimate.yaw)}};
  }
  if (mission.planner.clearance_privileged) json["clearance"] = {{"m", mission.planner.clearance_m}, {"auto", true}, {"privileged", true}};
  json["minimum_clearance_m"] = number(totals.least_clearance);
  json["final_pose"] = {{"x_m", pose.position.x}, {"y_m", pose.position.y}, {"yaw_deg", degrees(pose.yaw)}};
  if (mission.vehicle.flies()) {
    json["final_pose"]["z_m"] = simulation.vehicle().z;
    const FlightModel& model = simulation.stage().flight;
    json["flight"] = {{"model", model.rigid_body ? "rigid_body" : "kinematic"}, {"because", model.reason}, {"on_floor", simulation.vehicle().on_floor}};
  }
  const RunModel model = model_of(simulation);
  json["fidelity"] = mission.fidelity;
  json["models"] = describe(model);
  json["steps"] = simulation.steps();
  json["scans"] = totals.scans;
  json["rays"] = totals.rays;
  if (mission.map.enabled) json["map"] = map_summary(simulation, score);
  json["seed"] = mission.seed;
  json["version"] = version();
  return json.dump(2) + "\n";
}

std::string timing_json(const Simulation& simulation, double wall_start_s, double wall_run_s) {
  const PhaseTimes& times = simulation.phase_times();
  Json json;
  json["wall_start_s"] = wall_start_s;
  json["wall_run_s"] = wall_run_s;
  json["simulated_time_s"] = simulation.time();
  json["realtime_factor"] = wall_run_s > 0.0 ? number(simulation.time() / wall_run_s) : Json(nullptr);
  json["phases_s"] = {{"trace", times.trace}, {"map", times.map}, {"plan", times.plan}, {"contact", times.contact},
                      {"other", wall_run_s - times.trace - times.map - times.plan - times.contact - times.sar}};
  if (const SarImage* sar = simulation.sar(); sar && sar->pixels_added() > 0) {
    json["phases_s"]["sar"] = times.sar;
    json["sar_ns_per_pixel"] = 1e9 * times.sar / static_cast<double>(sar->pixels_added());
  }
  if (const auto scans = simulation.totals().scans; simulation.mission().map.enabled && scans > 0) json["map_ms_per_scan"] = 1e3 * times.map / static_cast<double>(scans);
  if (const auto cells = simulation.map().cells_updated(); cells > 0) json["map_ns_per_cell"] = 1e9 * times.map / static_cast<double>(cells);
  return json.dump(2) + "\n";
}

Result<Done> write_outputs(const std::filesystem::path& folder, const Simulation& simulation, const Trajectory& trajectory, double wall_start_s, double wall_run_s,
                           const std::optional<RunScore>& score) {
  const OutputSpec& output = simulation.mission().output;
  const bool with_map = simulation.mission().map.enabled && simulation.map().known_cells() > 0;
  // A folder that is used again holds nothing of the run before: result.json goes first and comes last, so that where it is, the rest is complete.
  std::error_code ignored;
  std::vector<std::string> stale = {"result.json"};
  if (!output.trajectory) stale.insert(stale.end(), {"trajectory.csv", "trajectory.tum"});
  if (!output.map || !with_map) stale.insert(stale.end(), {"map.pgm", "map.yaml"});
  if (!output.picture) stale.emplace_back("map.png");
  if (!output.path_picture) stale.emplace_back("path.png");
  const auto named = map_formats(output);
  const auto wanted = [&](const MapFormat& format) { return with_map && std::ranges::find(named, format.name) != named.end(); };
  for (const MapFormat& format : further_formats())
    if (!wanted(format)) stale.insert(stale.end(), format.files.begin(), format.files.end());
  if (!score) stale.emplace_back("score.json");
  const auto sar = report_sar(simulation);  // an error is that there is nothing to report
  for (const std::string& name : sar_files())
    if (!sar || (!sar->fusion && name.starts_with("map"))) stale.push_back(name);
  for (const std::string& name : stale) std::filesystem::remove(folder / name, ignored);
  std::vector<Result<Done>> written;
  written.push_back(write_file(folder / "mission.toml", write_mission(simulation.mission())));
  if (output.trajectory) {
    written.push_back(write_file(folder / "trajectory.csv", trajectory.csv()));
    written.push_back(write_file(folder / "trajectory.tum", trajectory.tum()));
  }
  if (output.map && with_map) written.push_back(write_map_file(folder / "map", simulation.map().to_grid()));
  if (with_map && !named.empty()) {
    const ProbabilityGrid grid = simulation.map().to_probabilities();
    for (const MapFormat& format : further_formats())
      if (wanted(format)) written.push_back(format.write(folder, grid, simulation));
  }
  if (output.picture) written.push_back(write_map_picture(folder / "map.png", simulation, trajectory));
  if (output.path_picture) written.push_back(write_path_picture(folder / "path.png", simulation, trajectory));
  if (sar) written.push_back(write_sar(folder, simulation, *sar));
  if (score) written.push_back(write_file(folder / "score.json", score_json(*score)));
  written.push_back(write_file(folder / "timing.json", timing_json(simulation, wall_start_s, wall_run_s)));
  written.push_back(write_file(folder / "result.json", result_json(simulation, score)));  // last: where it is, the rest is
  for (const auto& one : written)
    if (!one) return one.error();
  return Done{};
}

}  // namespace thicket

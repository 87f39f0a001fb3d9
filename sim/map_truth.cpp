#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "thicket/sim/map_score.hpp"
#include "thicket/sim/simulation.hpp"
#include "thicket/sim/travel.hpp"

namespace thicket {
namespace {

using Json = nlohmann::ordered_json;

/// Whether a beam of the sensor comes to an end in this matter: at its surface, or not far behind.
bool stops(const SensorSpec& sensor, const Material& material) {
  const RadarSpec* radar = std::get_if<ScanningRadarSpec>(&sensor);
  if (!radar) radar = std::get_if<LobeRadarSpec>(&sensor);
  if (!radar) return material.stops_light && !material.light_medium();
  const Material there = at_frequency(material, radar->frequency_ghz);
  return there.opaque() || there.attenuation_db_per_m * solid_depth_m >= radar->penetration_budget_db;
}

enum class Role { air, penetrable, solid };
Role role_of(const Simulation& simulation, const Material& material) {
  const auto& specs = simulation.mission().sensors;
  const auto& sensors = simulation.stage().sensors;
  if (std::any_of(specs.begin(), specs.end(), [&](const SensorSpec& s) { return stops(s, material); })) return Role::solid;
  const bool noticed = material.stops_motion || std::any_of(sensors.begin(), sensors.end(), [&](const auto& s) { return s->detects(material); });
  return noticed ? Role::penetrable : Role::air;
}

/// The heights of the sensors, lowest and highest, as they are mounted on a vehicle that is level and travels.
std::pair<double, double> heights_of(const Mission& mission) {
  const auto [lowest, highest] = travel_range(mission);
  double low = infinity, high = -infinity;
  for (const SensorSpec& sensor : mission.sensors) {
    const double z = mounted(sensor).position_m.z;
    low = std::min(low, lowest + z);
    high = std::max(high, highest + z);
  }
  return {low, high};
}

/// JSON has no infinity and no NaN: what is not finite is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "-"; }
std::string fixed(double value) { return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-"; }

}  // namespace

const char* to_string(Convention convention) { return convention == Convention::cell_centre ? "cell_centre" : "any_overlap"; }

Result<MapTruth> map_truth(const Simulation& simulation, const ProbabilityGrid& map, Convention convention) {
  const World world = world_at(simulation.stage().scene.world(), simulation.time());
  const auto [z_low, z_high] = heights_of(simulation.mission());
  const double cell = map.resolution;
  MapTruth truth;
  truth.bounds = world.bounds;
  glm::dvec2 low = map.origin, high = map.origin + glm::dvec2(map.width, map.height) * cell;
  if (const auto& b = world.bounds) {
    low = glm::min(low, glm::dvec2(b->x, b->y));
    high = glm::max(high, glm::dvec2(b->z, b->w));
  }
  // On the map's own lines; a bound that lies on one of them, to rounding, makes no cells of its own.
  low = glm::floor(low / cell + 1e-6) * cell;
  high = glm::ceil(high / cell - 1e-6) * cell;

  World solid = world, matter = world;
  const auto keep = [&](World& of, Role least) {
    std::erase_if(of.solids, [&](const Solid& s) { return role_of(simulation, world.materials[s.material]) < least; });
  };
  keep(solid, Role::solid);
  keep(matter, Role::penetrable);
  auto blocked = occupancy(solid, low, high, cell, z_low, z_high, convention, false);
  if (!blocked) return blocked.error();
  truth.solid = std::move(*blocked);
  if (matter.solids.size() == solid.solids.size()) return truth;
  auto all = occupancy(matter, low, high, cell, z_low, z_high, convention, false);
  if (!all) return all.error();
  truth.penetrable = std::move(all->blocked);
  for (std::size_t i = 0; i < truth.penetrable.size(); ++i) truth.penetrable[i] = truth.penetrable[i] && !truth.solid.blocked[i];
  return truth;
}

Result<RunScore> score_run(const Simulation& simulation, Convention convention, double tolerance_m) {
  const Mission& mission = simulation.mission();
  if (!mission.map.enabled) return Error{"the mission makes no map to score; run it with --set map.enabled=true"};
  const ProbabilityGrid grid = simulation.map().to_probabilities();
  if (grid.probability.empty()) return Error{"nothing is mapped, so there is nothing to score: no sensor has scanned before the run ended"};
  const auto truth = map_truth(simulation, grid, convention);
  if (!truth) return Error{"the map cannot be scored: " + truth.error().message};
  const auto score = score_map(grid, *truth, tolerance_m);
  if (!score) return Error{"the map cannot be scored: " + score.error().message};
  const auto [z_low, z_high] = heights_of(mission);
  return RunScore{*score, convention, z_low, z_high, grid.resolution, mission.map.clamp_low, mission.map.clamp_high, simulation.map().known_cells(), simulation.map().memory_bytes(), {}};
}

std::string score_json(const RunScore& score) {
  const MapScore& m = score.map;
  Json json;
  json["truth"] = {{"convention", to_string(score.convention)}, {"height_low_m", score.height_low_m}, {"height_high_m", score.height_high_m}};
  json["map"] = {{"resolution_m", score.resolution_m}, {"clamp_low", score.clamp_low}, {"clamp_high", score.clamp_high}, {"known_cells", score.known_cells}};
  json["cells"] = {{"judged", m.judged}, {"observed", m.observed}, {"claimed", m.claimed}, {"surface", m.surface}};
  json["coverage"] = number(m.coverage);
  json["within_tolerance"] = {{"tolerance_m", m.tolerance_m}, {"f1", number(m.f1)}, {"precision", number(m.precision)}, {"recall", number(m.recall)}};
  json["strict"] = {{"f1", number(m.strict_f1)}, {"precision", number(m.strict_precision)}, {"recall", number(m.strict_recall)}};
  json["claimed_nll"] = number(m.claimed_nll);
  json["claimed_mean_p"] = number(m.claimed_mean_p);
  json["nll"] = number(m.nll);
  json["edge_error_m"] = number(m.edge_error_m);
  json["edge_error_95_m"] = number(m.edge_error_95_m);
  json["memory"] = {{"bytes", score.memory_bytes}, {"bytes_per_known_cell", number(static_cast<double>(score.memory_bytes) / static_cast<double>(score.known_cells))}};
  json["updates"] = {{"every_s", MapUpdates::every_s}, {"count", score.updates.count}, {"bytes_mean", number(score.updates.mean())}, {"bytes_most", score.updates.most}};
  return json.dump(2) + "\n";
}

std::string score_text(const RunScore& score) {
  const MapScore& m = score.map;
  const std::string heights = score.height_low_m == score.height_high_m ? fmt::format("{:g}", score.height_low_m) : fmt::format("{:g} to {:g}", score.height_low_m, score.height_high_m);
  return fmt::format("truth             {}, at {} m; cells of {:g} m, clamps {:g} and {:g}\n", to_string(score.convention), heights, score.resolution_m, score.clamp_low, score.clamp_high) +
         fmt::format("F1 within {:g} m   {}   (precision {}, recall {}; {} cells claimed, {} surface)\n", m.tolerance_m, fixed(m.f1), fixed(m.precision), fixed(m.recall), m.claimed, m.surface) +
         fmt::format("strict precision  {}   (recall {}, F1 {})\n", fixed(m.strict_precision), fixed(m.strict_recall), fixed(m.strict_f1)) +
         fmt::format("NLL of claimed    {}   (mean probability {}; NLL of all known cells {})\n", fixed(m.claimed_nll), fixed(m.claimed_mean_p), fixed(m.nll)) +
         fmt::format("coverage          {}   ({} of {} cells)\n", percent(m.coverage), m.observed, m.judged) +
         fmt::format("edge error        {} m (95 %: {} m)\n", fixed(m.edge_error_m), fixed(m.edge_error_95_m)) +
         fmt::format("memory            {:.2f} MB, {:.2f} bytes a known cell\n", static_cast<double>(score.memory_bytes) / 1e6, static_cast<double>(score.memory_bytes) / static_cast<double>(score.known_cells)) +
         fmt::format("updates           {} bytes a second (at most {}; {} of them)\n", std::isfinite(score.updates.mean()) ? fmt::format("{:.0f}", score.updates.mean()) : "-", score.updates.most, score.updates.count);
}

}  // namespace thicket

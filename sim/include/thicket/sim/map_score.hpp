// How good a map is: judged against the world itself, which no planner sees. docs/mapping.md explains every figure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"
#include "thicket/sim/map_updates.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {

class Simulation;

/// What a map is judged by: a raster of the matter that stops beams, and where there is matter that they pass.
struct MapTruth {
  TruthGrid solid;                       ///< blocked: matter that stops the beams of a sensor
  std::vector<std::uint8_t> penetrable;  ///< 1: other matter (foliage; to a lidar smoke and glass), neither free nor occupied; as `solid.blocked`, or empty: nowhere
  std::optional<glm::dvec4> bounds;      ///< x_min, y_min, x_max, y_max, m: what coverage is of; without them all of the raster
};

/// What a comparison gives. A cell is a *surface* (solid, with a cell beside it, 8 neighbours, that is not), *free*, or not judged (deep inside solid matter, or penetrable). It is *claimed* if the map
/// gives it a probability of matter above 0.5. Shares are 0...1; NaN where there is nothing to take a share or a mean of.
struct MapScore {
  double tolerance_m = 0.2;

  std::size_t judged = 0;    ///< cells that are surface or free, within the bounds
  std::size_t observed = 0;  ///< those of them that are known
  std::size_t claimed = 0;   ///< cells claimed, deep ones too, without those that penetrable matter accounts for
  std::size_t surface = 0;   ///< known surface cells
  double coverage = 0.0;     ///< observed / judged

  // Within the tolerance, between the middles of cells.
  double precision = 0.0;  ///< of the claimed cells, those near a known surface cell
  double recall = 0.0;     ///< of the known surface cells, those near a claimed one
  double f1 = 0.0;         ///< their harmonic mean: the headline; 0 if there is nothing of the one kind, NaN if of neither

  // To the cell, over known cells that are judged.
  double strict_precision = 0.0, strict_recall = 0.0, strict_f1 = 0.0;

  // How sure of what is so: mean -ln of the probability that the map gave to the truth, over known cells that are judged.
  double claimed_nll = 0.0;     ///< of claimed ones: overconfidence, where the mean over all cells hides it
  double claimed_mean_p = 0.0;  ///< mean probability of the same cells
  double nll = 0.0;             ///< of all

  // Distances of claimed cells from the nearest known surface cell, and of those from the nearest claimed one, m.
  double edge_error_m = 0.0;     ///< mean of the two means ("chamfer")
  double edge_error_95_m = 0.0;  ///< what 95 % of all of them do not exceed
};

/// Compares a map with the truth at its own cells. Claimed cells that lie within the tolerance of penetrable matter and not of a surface count neither for nor against the map: beams return from
/// there. What of the map lies outside of the truth is not judged. `tolerance_m` >= 0. Takes some 15 bytes a cell and a time proportional to the number of cells (4000 x 4000: about a second).
/// Errors: cells of another size, or not on the same lines, than those of the truth.
Result<MapScore> score_map(const ProbabilityGrid& map, const MapTruth& truth, double tolerance_m = 0.2);
/// The same where no matter is penetrable.
Result<MapScore> score_map(const ProbabilityGrid& map, const TruthGrid& truth, double tolerance_m = 0.2);

/// "cell_centre" or "any_overlap".
const char* to_string(Convention convention);

/// Depth in matter, m, within which a radar's beam must be used up if the matter is to count as solid.
inline constexpr double solid_depth_m = 0.2;

/// The truth for the map of a run: the world as it stands now, cut at the heights of the mission's sensors (from the lowest to the highest), over the map and the world's bounds together.
/// Solid is what stops the beams of at least one of the sensors: to a radar matter in which its penetration budget, at its frequency, is used up within `solid_depth_m`; to a lidar the surface of
/// what stops light. All other matter is penetrable, but for what none of the sensors gets an echo of and does not stop motion either (smoke to a radar): that is as good as air. Errors as `occupancy`.
Result<MapTruth> map_truth(const Simulation& simulation, const ProbabilityGrid& map, Convention convention);

/// The score of a run's map, and what it takes to understand it.
struct RunScore {
  MapScore map;
  Convention convention = Convention::cell_centre;
  double height_low_m = 0.0, height_high_m = 0.0;  ///< of the truth
  double resolution_m = 0.1, clamp_low = 0.0, clamp_high = 1.0;
  std::size_t known_cells = 0, memory_bytes = 0;
  MapUpdates updates;  ///< of who noted them along the run; `score_run`, which sees only its end, knows of none
};
/// Scores the map as it is now, where the map says that things are: drift of the odometry is part of it. Errors: the mission makes no map, nothing is known yet, and as `occupancy`.
Result<RunScore> score_run(const Simulation& simulation, Convention convention = Convention::cell_centre, double tolerance_m = 0.2);

/// `score.json`: all of it. The same run gives the same bytes.
std::string score_json(const RunScore& score);
/// A few lines for a person.
std::string score_text(const RunScore& score);

}  // namespace thicket

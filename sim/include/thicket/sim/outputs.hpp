// What a run leaves behind.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "thicket/base/result.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/simulation.hpp"
#include "thicket/sim/trajectory.hpp"

namespace thicket {

/// Version of the program, as in `result.json`.
const char* version();

/// `result.json`: verdict, reason, simulated time, path length, ... and of a score the headline. The same run gives the same bytes; wall times are not in it.
std::string result_json(const Simulation& simulation, const std::optional<RunScore>& score = std::nullopt);

/// `timing.json`: wall time, real-time factor, and where the time went, of the map also per scan and per cell that a scan told something of. `wall_run_s` is stepping alone, start-up and files apart.
std::string timing_json(const Simulation& simulation, double wall_start_s, double wall_run_s);

/// `map.png`: the map in the colours of Rozeboom 2012 (blue never sensed, white sensed, grey clear, black obstacle; here also what was sensed through), with path, start, goal,
/// the planner's marks and a scale bar.
Result<Done> write_map_picture(const std::filesystem::path& file, const Simulation& simulation, const Trajectory& trajectory);

/// `path.png`: the world as it is (at the end of the run, at the hull's heights), not as the robot knows it: matter, the band around it that the robot's axis cannot enter without giving up its
/// clearance, and in it the way that the robot went, coloured by what it did, with start, goal, the planner's marks, the hull at the end and a scale bar. The same run gives the same bytes.
Result<Done> write_path_picture(const std::filesystem::path& file, const Simulation& simulation, const Trajectory& trajectory);

/// Writes all of the mission's outputs into a folder, which is made if need be. `score`: of `score_run`, where there is to be one; `mission.output.score` tells whether it was asked for.
Result<Done> write_outputs(const std::filesystem::path& folder, const Simulation& simulation, const Trajectory& trajectory, double wall_start_s, double wall_run_s,
                           const std::optional<RunScore>& score = std::nullopt);

/// Share of the free area inside a region (x_min, y_min, x_max, y_max) that the map knows, judged at cell centres against the world itself, at the height
/// of the first sensor. Nothing if the region has no free cell.
std::optional<double> observed_share(const Simulation& simulation, const glm::dvec4& region);

}  // namespace thicket

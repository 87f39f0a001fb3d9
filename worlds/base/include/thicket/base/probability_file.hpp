// Maps with probabilities as files: for ROS (map_server), NumPy and OctoMap. docs/map_files.md tells what each keeps and loses.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/map_file.hpp"
#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// Where a file has only states, a cell is as sure as OctoMap's clamps let it become (Hornung et al. 2013; the same as those of [map]).
inline constexpr float sure_occupied = 0.971F, sure_free = 0.1192F;

/// No file makes a cell surer than this or its counterpart (log-odds of about 14): probabilities lie in (0, 1).
inline constexpr double least_probability = 0x1p-20;

/// The modes of map_server.
enum class MapMode { trinary, scale, raw };
/// "trinary", "scale", "raw".
const std::vector<std::string>& map_mode_names();
/// Nothing if it is none of them.
std::optional<MapMode> map_mode(const std::string& name);

/// Three-valued: occupied above 0.65, free below 0.196 unless sensed through, else unknown (as `OccupancyMap::to_grid`).
GridMap judged(const ProbabilityGrid& grid);
/// `sure_occupied`, `sure_free`, NaN. The map's yaw must be 0.
ProbabilityGrid probabilities_of(const GridMap& map);

/// Writes `stem`.yaml and its image, `stem`.pgm (trinary, raw) or `stem`.png (scale). Thresholds 0.65 and 0.196; resolution and origin with all their digits. What was sensed through is not told apart, but in trinary.
/// - trinary: `judged`.
/// - scale: grey 255 (1 - p), rounded: p to 1/510. Unknown is transparent (alpha 0; its grey, 128, lies between the thresholds).
/// - raw: p in percent, rounded: p to 0.005. Unknown is 255.
/// An error names the file and what is wrong with the grid: its size, its place, a probability outside of 0 to 1.
Result<Done> write_map_server(const std::filesystem::path& stem, const ProbabilityGrid& grid, MapMode mode);

/// Writes NumPy's format 1.0: float32, shape (height, width), C order, row 0 at the *bottom*, NaN unknown. The file holds neither resolution nor origin nor what was sensed through.
Result<Done> write_npy(const std::filesystem::path& file, const ProbabilityGrid& grid);

/// Writes OctoMap's tree of depth 16 with the one layer of voxels that holds `height`, m: as `.bt` (states only) if the name ends so, else as `.ot` (log-odds as float32). What was sensed through is unknown in a .bt unless occupied,
/// p >= 0.5 (OctoMap's own rule), and not told apart in an .ot.
/// Errors: nothing is known; the origin is not a multiple of the resolution (to a thousandth of a cell); cells or the height lie beyond 32768 cells from 0, which no tree reaches.
Result<Done> write_octomap(const std::filesystem::path& file, const ProbabilityGrid& grid, double height);

/// What a file may lack.
struct ProbabilityReading {
  std::optional<double> cell_size;   ///< m; of a .npy, which needs it; an error for others
  std::optional<glm::dvec2> origin;  ///< of a .npy: its lower-left corner, m; 0, 0 if it is not given; an error for others
  std::optional<double> height;      ///< of an .ot or .bt: the layer that holds this height, m; needed if there are several; an error for others
  std::filesystem::path image;       ///< of a map_server YAML: an image instead of the one that it names; an error for others
};

/// Reads a map_server YAML (.yaml, .yml) of any mode, .npy, .ot or .bt, told apart by their ending. Nothing is `through` in it.
/// - trinary: states by the file's thresholds, as `read_map_file` does, then `probabilities_of`.
/// - scale: p = (255 - v)/255, or v/255 when negated; a fully transparent pixel is unknown.
/// - raw: p = v/100 for v up to 100; others are unknown. In both, the ends stand for the middle of what is rounded to them: 0 percent reads as 0.0025.
/// - .npy: `read_npy`; .ot, .bt: `read_octomap`.
/// Errors: `file:line:column: what, expected`; a map that is turned (yaw other than 0).
Result<ProbabilityGrid> read_probabilities(const std::filesystem::path& file, const ProbabilityReading& reading = {});

/// Reads float32 or float64 of shape (height, width) in C order, row 0 at the bottom, NaN unknown, else 0 to 1. Format 1.0, 2.0 or 3.0.
Result<ProbabilityGrid> read_npy(const std::filesystem::path& file, double cell_size, const glm::dvec2& origin);

/// Reads one layer of OctoMap's .ot or .bt (told apart by the first line), over the block of cells that are known in it. Without a height the tree must have a single layer. In a .bt occupied is `sure_occupied`, free `sure_free`.
Result<ProbabilityGrid> read_octomap(const std::filesystem::path& file, std::optional<double> height);

}  // namespace thicket

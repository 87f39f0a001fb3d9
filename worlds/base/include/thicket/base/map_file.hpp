// Maps in the format of ROS map_server: a YAML file that names an image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"

namespace thicket {

/// What a resolution and an origin may be, read or written: whatever lies outside is a slip, and would cost the digits of everything computed with it.
inline constexpr double least_cell_m = 1e-6, largest_cell_m = 1e6, farthest_origin_m = 1e9;

/// What a map says of one cell.
enum class CellState : std::uint8_t { unknown, free, occupied };

/// A grid map as loaded: `cells[row * width + column]`, row 0 at the *bottom* (y grows with the row), so that cell (column, row)
/// covers x in [column, column + 1] * resolution and the same for y, in the map's own frame.
struct GridMap {
  int width = 0;
  int height = 0;
  double resolution = 0.05;        ///< metres a cell, > 0
  glm::dvec2 origin{0.0, 0.0};     ///< world position of the lower-left corner, m
  double origin_yaw = 0.0;         ///< rotation of the map's frame about its origin, rad, counter-clockwise
  std::vector<CellState> cells;

  CellState at(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
};

/// Reads a map_server YAML (`image`, `resolution`, `origin [x, y, yaw]`, `negate` as 0/1/true/false, `occupied_thresh`,
/// `free_thresh`, optional `mode: trinary | scale | raw`) and its image. `image` is relative to the YAML file; `image_override`, where not empty,
/// is read instead. With p = (255 - v)/255, or v/255 when negated: occupied if p > occupied_thresh, free if p < free_thresh (both strict), else unknown.
/// Mode raw: values 0...100 are percent occupancy judged by the same thresholds (in percent), others unknown. In every mode a fully transparent pixel is unknown.
/// Errors: `file:line:column: what, expected`, with the nearest valid key for a misspelt one. An image that does not exist is an error that names
/// an image of the YAML's own stem (`depot.yaml` -> `depot.pgm`, `.png`) if one lies beside it, and how to use it.
Result<GridMap> read_map_file(const std::filesystem::path& yaml, const std::filesystem::path& image_override = {});

/// Writes `stem`.yaml and `stem`.pgm (trinary: 0 occupied, 254 free, 205 unknown; thresholds 0.65 and 0.196; origin with all its digits).
Result<Done> write_map_file(const std::filesystem::path& stem, const GridMap& map);

}  // namespace thicket

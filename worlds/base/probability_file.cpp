#include "thicket/base/probability_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "map_header.hpp"
#include "probability_parts.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t raw_unknown = 255;
/// Between the thresholds, so that a reader who does not know of alpha takes it for unknown, too.
constexpr std::uint8_t scale_unknown = 128;

/// A value of `steps` + 1 as a probability; the first and the last stand for half a step only, of which this is the middle.
float of_steps(int value, double steps) { return inside(std::clamp(static_cast<double>(value), 0.25, steps - 0.25) / steps); }

std::uint8_t to_steps(float probability, double steps) { return static_cast<std::uint8_t>(std::lround(static_cast<double>(probability) * steps)); }

/// What each of the 256 greys says of a cell, in the modes scale and raw.
std::array<float, 256> probabilities_of_greys(const MapHeader& header) {
  std::array<float, 256> list{};
  for (int grey = 0; grey < 256; ++grey) {
    float& p = list[static_cast<std::size_t>(grey)];
    if (header.mode == "raw") {
      p = grey > 100 ? ProbabilityGrid::unknown : of_steps(grey, 100.0);
    } else {
      p = of_steps(header.negate ? grey : 255 - grey, 255.0);
    }
  }
  return list;
}

Result<ProbabilityGrid> read_map_server(const fs::path& yaml, const fs::path& image_override) {
  const Result<MapHeader> header = read_map_header(yaml, image_override.empty());
  if (!header) return header.error();
  if (header->origin[2] != 0.0)
    return Error{fmt::format("{}: the map is turned by {} rad (the third value of its origin), expected 0: turn the image in a picture editor and write 0 there", header->origin_place, header->origin[2])};
  if (header->mode == "trinary") {
    const Result<GridMap> map = read_map_file(yaml, image_override);
    if (!map) return map.error();
    return probabilities_of(*map);
  }
  const Result<GreyImage> image = read_map_image(yaml, *header, image_override);
  if (!image) return image.error();
  ProbabilityGrid grid{image->width, image->height, header->resolution, {header->origin[0], header->origin[1]}, {}, {}};
  grid.probability.reserve(image->pixels.size());
  const auto probabilities = probabilities_of_greys(*header);
  const auto width = static_cast<std::size_t>(grid.width);
  for (std::size_t row = static_cast<std::size_t>(grid.height); row-- > 0;) {
    for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
      const bool transparent = !image->alpha.empty() && image->alpha[pixel] == 0;
      grid.probability.push_back(transparent ? ProbabilityGrid::unknown : probabilities[image->pixels[pixel]]);
    }
  }
  return grid;
}

GreyImage to_image(const ProbabilityGrid& grid, MapMode mode) {
  GreyImage image{grid.width, grid.height, {}, {}};
  image.pixels.reserve(grid.probability.size());
  if (mode == MapMode::scale) image.alpha.reserve(grid.probability.size());
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) {
      const std::size_t cell = grid.index(column, row);
      const bool known = grid.known(cell);
      if (mode == MapMode::raw) {
        image.pixels.push_back(known ? to_steps(grid.probability[cell], 100.0) : raw_unknown);
      } else {
        image.pixels.push_back(known ? static_cast<std::uint8_t>(255 - to_steps(grid.probability[cell], 255.0)) : scale_unknown);
        image.alpha.push_back(known ? 255 : 0);
      }
    }
  }
  return image;
}

/// What is given must be of use: a value that a file has by itself is not overruled, and not passed over in silence.
std::optional<Error> misplaced(const fs::path& file, const ProbabilityReading& reading, bool is_yaml, bool is_npy, bool is_tree) {
  const auto wrong = [&](const char* what, const char* where) { return Error{fmt::format("{}: {} is given, expected that only for {}", file.string(), what, where)}; };
  if (reading.cell_size && !is_npy) return wrong("a cell size", "a .npy: this file has its own");
  if (reading.origin && !is_npy) return wrong("an origin", "a .npy: this file has its own");
  if (reading.height && !is_tree) return wrong("the height of a layer", "an .ot or .bt");
  if (!reading.image.empty() && !is_yaml) return wrong("a map image", "a map_server YAML file");
  return std::nullopt;
}

}  // namespace

const std::vector<std::string>& map_mode_names() {
  static const std::vector<std::string> names = {"trinary", "scale", "raw"};
  return names;
}

std::optional<MapMode> map_mode(const std::string& name) {
  const auto found = std::find(map_mode_names().begin(), map_mode_names().end(), name);
  if (found == map_mode_names().end()) return std::nullopt;
  return static_cast<MapMode>(found - map_mode_names().begin());
}

std::optional<Error> unwritable(const fs::path& file, const ProbabilityGrid& grid) {
  if (const auto wrong = unwritable(MapFrame{grid.width, grid.height, grid.probability.size(), grid.resolution, grid.origin, 0.0})) return Error{file.string() + ": " + *wrong};
  if (!grid.through.empty() && grid.through.size() != grid.probability.size())
    return Error{fmt::format("{}: the map has {} marks of cells sensed through, expected none or {} x {}", file.string(), grid.through.size(), grid.width, grid.height)};
  for (std::size_t i = 0; i < grid.probability.size(); ++i) {
    const float p = grid.probability[i];
    const auto width = static_cast<std::size_t>(grid.width);
    if (grid.known(i) && !(p >= 0.0F && p <= 1.0F))
      return Error{fmt::format("{}: the probability in column {}, row {} is {}, expected 0 to 1, or NaN for unknown", file.string(), i % width, i / width, p)};
  }
  return std::nullopt;
}

GridMap judged(const ProbabilityGrid& grid) {
  GridMap map{grid.width, grid.height, grid.resolution, grid.origin, 0.0, {}};
  map.cells.reserve(grid.probability.size());
  for (std::size_t i = 0; i < grid.probability.size(); ++i) {
    const auto p = static_cast<double>(grid.probability[i]);  // every (quiet) comparison with NaN is false
    map.cells.push_back(std::isgreater(p, saved_occupied_thresh) ? CellState::occupied : std::isless(p, saved_free_thresh) && !grid.sensed_through(i) ? CellState::free : CellState::unknown);
  }
  return map;
}

ProbabilityGrid probabilities_of(const GridMap& map) {
  ProbabilityGrid grid{map.width, map.height, map.resolution, map.origin, {}, {}};
  grid.probability.reserve(map.cells.size());
  for (const CellState state : map.cells) grid.probability.push_back(state == CellState::occupied ? sure_occupied : state == CellState::free ? sure_free : ProbabilityGrid::unknown);
  return grid;
}

Result<Done> write_map_server(const fs::path& stem, const ProbabilityGrid& grid, MapMode mode) {
  if (auto wrong = unwritable(stem, grid)) return *wrong;
  if (mode == MapMode::trinary) return write_map_file(stem, judged(grid));
  // The image first: a YAML that is there always has its image.
  const fs::path file = fs::path(stem) += mode == MapMode::scale ? ".png" : ".pgm";
  const GreyImage image = to_image(grid, mode);
  if (auto written = mode == MapMode::scale ? write_png(file, image) : write_pgm(file, image); !written) return written;
  return write_map_header(stem, file, map_mode_names()[static_cast<std::size_t>(mode)], {grid.width, grid.height, grid.probability.size(), grid.resolution, grid.origin, 0.0});
}

Result<ProbabilityGrid> read_probabilities(const fs::path& file, const ProbabilityReading& reading) {
  const std::string ending = file.extension().string();
  const bool is_yaml = ending == ".yaml" || ending == ".yml", is_npy = ending == ".npy", is_tree = ending == ".ot" || ending == ".bt";
  if (!is_yaml && !is_npy && !is_tree) return Error{fmt::format("{}: cannot tell the format of the map, expected a name ending in .yaml (map_server), .npy (NumPy), .ot or .bt (OctoMap)", file.string())};
  if (auto wrong = misplaced(file, reading, is_yaml, is_npy, is_tree)) return *wrong;
  if (is_yaml) return read_map_server(file, reading.image);
  if (is_tree) return read_octomap(file, reading.height);
  if (!reading.cell_size) return Error{fmt::format("{}: a .npy file does not say how large its cells are, expected a cell size: thicket convert {} map.yaml --mode raw --cell-size 0.1", file.string(), file.filename().string())};
  return read_npy(file, *reading.cell_size, reading.origin.value_or(glm::dvec2(0.0)));
}

}  // namespace thicket

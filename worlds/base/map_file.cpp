#include "thicket/base/map_file.hpp"

#include <array>
#include <string>

#include "map_header.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t saved_occupied = 0;
constexpr std::uint8_t saved_free = 254;
constexpr std::uint8_t saved_unknown = 205;

/// What each of the 256 greys says of a cell.
std::array<CellState, 256> states_of_greys(const MapHeader& header) {
  std::array<CellState, 256> states{};
  for (std::size_t grey = 0; grey < states.size(); ++grey) {
    double p = static_cast<double>(header.negate ? grey : 255 - grey) / 255.0;
    if (header.mode == "raw") {
      if (grey > 100) continue;
      p = static_cast<double>(grey) / 100.0;
    }
    if (p > header.occupied_thresh) states[grey] = CellState::occupied;
    if (p < header.free_thresh) states[grey] = CellState::free;
  }
  return states;
}

}  // namespace

Result<GridMap> read_map_file(const fs::path& yaml, const fs::path& image_override) {
  const Result<MapHeader> header = read_map_header(yaml, image_override.empty());
  if (!header) return header.error();
  const Result<GreyImage> image = read_map_image(yaml, *header, image_override);
  if (!image) return image.error();

  GridMap map;
  map.width = image->width;
  map.height = image->height;
  map.resolution = header->resolution;
  map.origin = {header->origin[0], header->origin[1]};
  map.origin_yaw = header->origin[2];
  map.cells.reserve(image->pixels.size());
  const auto states = states_of_greys(*header);
  const auto width = static_cast<std::size_t>(map.width);
  for (std::size_t row = static_cast<std::size_t>(map.height); row-- > 0;) {
    for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
      const bool transparent = !image->alpha.empty() && image->alpha[pixel] == 0;
      map.cells.push_back(transparent ? CellState::unknown : states[image->pixels[pixel]]);
    }
  }
  return map;
}

Result<Done> write_map_file(const fs::path& stem, const GridMap& map) {
  const MapFrame frame{map.width, map.height, map.cells.size(), map.resolution, map.origin, map.origin_yaw};
  if (const auto wrong = unwritable(frame)) return Error{stem.string() + ": " + *wrong};
  GreyImage image{map.width, map.height, {}, {}};
  image.pixels.reserve(map.cells.size());
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = 0; column < map.width; ++column) {
      const CellState state = map.at(column, row);
      image.pixels.push_back(state == CellState::occupied ? saved_occupied : state == CellState::free ? saved_free : saved_unknown);
    }
  }
  // The image first: a YAML that is there always has its image. The extension is added, since a dot may be part of the stem.
  const fs::path pgm = fs::path(stem) += ".pgm";
  if (auto written = write_pgm(pgm, image); !written) return written;
  return write_map_header(stem, pgm, "trinary", frame);
}

}  // namespace thicket

#include "thicket/nav/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fan.hpp"

namespace thicket {
namespace {

constexpr double units = 32.0;  // log-odds per unit of a cell's value
int to_units(double probability) { return static_cast<int>(std::lround(units * std::log(probability / (1.0 - probability)))); }
double to_probability(int value) { return 1.0 / (1.0 + std::exp(-value / units)); }

/// How far a beam has anything to say, m.
double reach_of(const Scan& scan, const Beam& beam) { return beam.echo_count > 0 ? std::max(beam.sensed_range, scan.echoes_of(beam).back().range) : beam.sensed_range; }

constexpr std::int64_t floor_tile(std::int64_t cell, int bits) { return cell >> bits; }  // arithmetic shift: floors

}  // namespace

const Section& map_section() {
  using S = MapSpec;
  static const Section section = SectionOf<S>("[map]", "the occupancy map")
                                     .key("enabled", &S::enabled, "whether a map is made at all")
                                     .key("resolution_m", &S::resolution_m, "m", between(0.001, 100.0), "edge of a cell")
                                     .key("probability_hit", &S::probability_hit, "", between(0.501, 0.98), "of matter in a cell, given an echo in it")
                                     .key("probability_miss", &S::probability_miss, "", between(0.02, 0.499), "of matter in a cell that a beam went through")
                                     .key("clamp_low", &S::clamp_low, "", between(0.02, 0.49), "no cell gets surer to be free than this")
                                     .key("clamp_high", &S::clamp_high, "", between(0.51, 0.98), "no cell gets surer to be occupied than this");
  return section;
}

OccupancyMap::OccupancyMap(const MapSpec& spec) : spec_(spec), low_(to_units(spec.clamp_low)) {
  const int hit = to_units(spec.probability_hit), miss = to_units(spec.probability_miss), high = to_units(spec.clamp_high);
  for (int state = untouched; state <= occupied; ++state) {
    for (int value = -128; value < 128; ++value) {
      const int before = value == unknown ? 0 : value;
      const int after = state == untouched ? value : std::clamp(before + (state == occupied ? hit : miss), low_, high);
      next_value_[static_cast<std::size_t>(state * 256) + static_cast<std::uint8_t>(value)] = static_cast<std::int8_t>(after);
    }
  }
}

CellIndex OccupancyMap::cell_at(const glm::dvec2& point) const {
  return {static_cast<std::int64_t>(std::floor(point.x / spec_.resolution_m)), static_cast<std::int64_t>(std::floor(point.y / spec_.resolution_m))};
}

void OccupancyMap::integrate(const Scan& scan, const Pose& vehicle) {
  const Pose sensor = vehicle * Pose{scan.mount_position, scan.mount_orientation};
  place_window(scan, glm::dvec2(sensor.position));
  const glm::dvec2 corner = glm::dvec2(static_cast<double>(window_.tile.column), static_cast<double>(window_.tile.row)) * static_cast<double>(tile_size);
  const glm::dvec2 from = glm::dvec2(sensor.position) / spec_.resolution_m - corner;
  for (const Beam& beam : scan.beams) {
    // Of a beam with an opening, thin ones that leave no cell out between them.
    for_fan(scan, beam, 0.7 * spec_.resolution_m / std::max(spec_.resolution_m, reach_of(scan, beam)), [&](const glm::dvec3& direction) {
      const glm::dvec2 along(sensor.orientation * direction);
      const double shrink = glm::length(along);  // of a beam that climbs or falls, its plan
      if (shrink > 1e-9) draw_beam(scan, beam, from, along / shrink, shrink / spec_.resolution_m);
    });
  }
  apply();
}

/// Puts the window around the sensor, on the tiles' grid, large enough for what the scan reaches.
void OccupancyMap::place_window(const Scan& scan, const glm::dvec2& sensor) {
  double reach = 0.0;
  for (const Beam& beam : scan.beams) reach = std::max(reach, reach_of(scan, beam));
  const auto half = static_cast<std::int64_t>(std::ceil(reach / spec_.resolution_m)) + 2;
  window_.tiles = (2 * half + 1) / tile_size + 2;
  const auto cells = static_cast<std::size_t>(window_.stride() * window_.tiles * tile_size);
  if (window_.states.size() < cells) window_.states.resize(cells, untouched);
  const CellIndex centre = cell_at(sensor);
  window_.tile = {floor_tile(centre.column - half, tile_bits), floor_tile(centre.row - half, tile_bits)};
}

/// Walks the cells under a beam (Amanatides & Woo 1987), in cells; `scale` is cells per metre of the beam.
void OccupancyMap::draw_beam(const Scan& scan, const Beam& beam, const glm::dvec2& from, const glm::dvec2& direction, double scale) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const std::int64_t stride = window_.stride();
  std::uint8_t* const states = window_.states.data();
  const auto echoes = scan.echoes_of(beam);

  std::int64_t cell = static_cast<std::int64_t>(from.y) * stride + static_cast<std::int64_t>(from.x);
  const std::int64_t step_column = direction.x > 0.0 ? 1 : -1, step_row = direction.y > 0.0 ? stride : -stride;
  const double step_x = direction.x != 0.0 ? std::abs(1.0 / direction.x) : never, step_y = direction.y != 0.0 ? std::abs(1.0 / direction.y) : never;
  const auto to_edge = [](double at, double towards) { return towards > 0.0 ? std::floor(at) + 1.0 - at : at - std::floor(at); };
  double next_x = direction.x != 0.0 ? to_edge(from.x, direction.x) * step_x : never;
  double next_y = direction.y != 0.0 ? to_edge(from.y, direction.y) * step_y : never;
  double at = 0.0;

  // The cell in which a stretch ends holds the echo that ends it, and occupied wins: stretches need not share it.
  const auto draw_stretch = [&](double end, State state) {
    while (at < end) {
      states[cell] = std::max<std::uint8_t>(states[cell], state);
      const bool sideways = next_x < next_y;
      at = sideways ? next_x : next_y;
      cell += sideways ? step_column : step_row;
      next_x = sideways ? next_x + step_x : next_x;
      next_y = sideways ? next_y : next_y + step_y;
    }
  };
  // A surface that lies on the border of two cells, as in worlds with round numbers, is matter in the one behind it, whatever the last bit of its range.
  constexpr double on_border = 0.01;
  bool inside = beam.starts_inside;
  for (const Echo& echo : echoes) {
    draw_stretch(echo.range * scale - on_border, inside ? through : free);
    inside = echo.edge == Edge::front || echo.edge == Edge::inner;
  }
  draw_stretch(beam.sensed_range * scale - (beam.end == BeamEnd::stopped ? on_border : 0.0), inside ? through : free);
  for (const Echo& echo : echoes) {
    const glm::dvec2 point = from + (echo.range * scale + (echo.edge == Edge::back ? -on_border : on_border)) * direction;
    states[static_cast<std::int64_t>(point.y) * stride + static_cast<std::int64_t>(point.x)] = occupied;
  }
}

/// Takes the window into the tiles and leaves it empty.
void OccupancyMap::apply() {
  for (std::int64_t row = 0; row < window_.tiles; ++row)
    for (std::int64_t column = 0; column < window_.tiles; ++column)
      apply_to_tile({window_.tile.column + column, window_.tile.row + row}, window_.states.data() + (row * window_.stride() + column) * tile_size);
}

void OccupancyMap::apply_to_tile(const CellIndex& index, std::uint8_t* states) {
  Tile* tile = nullptr;
  for (std::size_t y = 0; y < tile_size; ++y, states += window_.stride()) {
    for (std::size_t x = 0; x < tile_size; x += 8) {
      std::uint64_t eight = 0;  // most of a window is untouched: eight cells are passed over at once
      std::memcpy(&eight, states + x, 8);
      if (eight == 0) continue;
      if (!tile) {
        auto& shared = tiles_[index];
        if (!shared) {
          shared = std::make_shared<Tile>();
        } else if (shared.use_count() > 1) {
          shared = std::make_shared<Tile>(*shared);
        }
        tile = shared.get();
      }
      std::int8_t* values = tile->log_odds.data() + y * tile_size + x;
      std::uint64_t touched = 0, sensed_through = 0;
      for (std::size_t i = 0; i < 8; ++i) {
        const std::uint8_t state = states[x + i];
        values[i] = next_value_[std::size_t{state} * 256 + static_cast<std::uint8_t>(values[i])];
        touched |= std::uint64_t{state != untouched} << i;
        sensed_through |= std::uint64_t{state == through} << i;
      }
      tile->through[y] = (tile->through[y] & ~(touched << x)) | sensed_through << x;
      std::memset(states + x, 0, 8);
    }
  }
}

const OccupancyMap::Tile* OccupancyMap::tile(const CellIndex& cell) const {
  const auto found = tiles_.find({floor_tile(cell.column, tile_bits), floor_tile(cell.row, tile_bits)});
  return found == tiles_.end() ? nullptr : found->second.get();
}

CellView OccupancyMap::view(const CellIndex& cell) const {
  const Tile* t = tile(cell);
  if (!t) return {};
  const auto x = static_cast<std::size_t>(cell.column & (tile_size - 1)), y = static_cast<std::size_t>(cell.row & (tile_size - 1));
  const std::int8_t value = t->log_odds[y * tile_size + x];
  if (value == unknown) return {};
  return {true, to_probability(value), ((t->through[y] >> x) & 1) != 0};
}

bool OccupancyMap::surely_free(const CellIndex& cell) const {
  const CellView v = view(cell);
  return v.known && v.probability <= to_probability(low_);
}

std::size_t OccupancyMap::known_cells() const {
  std::size_t count = 0;
  for (const auto& [index, t] : tiles_) count += static_cast<std::size_t>(std::count_if(t->log_odds.begin(), t->log_odds.end(), [](std::int8_t v) { return v != unknown; }));
  return count;
}

std::size_t OccupancyMap::memory_bytes() const { return tiles_.size() * (sizeof(Tile) + sizeof(decltype(tiles_)::value_type) + sizeof(void*)); }

std::optional<std::pair<CellIndex, CellIndex>> OccupancyMap::extent() const {
  std::optional<std::pair<CellIndex, CellIndex>> all;
  for (const auto& [index, t] : tiles_) {
    for (int i = 0; i < tile_size * tile_size; ++i) {
      if (t->log_odds[static_cast<std::size_t>(i)] == unknown) continue;
      const CellIndex cell{index.column * tile_size + i % tile_size, index.row * tile_size + i / tile_size};
      if (!all) all = {cell, {cell.column + 1, cell.row + 1}};
      all->first = {std::min(all->first.column, cell.column), std::min(all->first.row, cell.row)};
      all->second = {std::max(all->second.column, cell.column + 1), std::max(all->second.row, cell.row + 1)};
    }
  }
  return all;
}

GridMap OccupancyMap::to_grid() const {
  GridMap grid;
  grid.resolution = spec_.resolution_m;
  const auto all = extent();
  if (!all) return grid;
  grid.width = static_cast<int>(all->second.column - all->first.column);
  grid.height = static_cast<int>(all->second.row - all->first.row);
  grid.origin = glm::dvec2(static_cast<double>(all->first.column), static_cast<double>(all->first.row)) * spec_.resolution_m;
  grid.cells.reserve(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for (std::int64_t row = all->first.row; row < all->second.row; ++row) {
    for (std::int64_t column = all->first.column; column < all->second.column; ++column) {
      const CellView v = view({column, row});
      CellState state = CellState::unknown;
      if (v.known && v.probability > 0.65) state = CellState::occupied;
      if (v.known && v.probability < 0.196 && !v.sensed_through) state = CellState::free;
      grid.cells.push_back(state);
    }
  }
  return grid;
}

ProbabilityGrid OccupancyMap::to_probabilities() const {
  ProbabilityGrid grid;
  grid.resolution = spec_.resolution_m;
  const auto all = extent();
  if (!all) return grid;
  grid.width = static_cast<int>(all->second.column - all->first.column);
  grid.height = static_cast<int>(all->second.row - all->first.row);
  grid.origin = glm::dvec2(static_cast<double>(all->first.column), static_cast<double>(all->first.row)) * spec_.resolution_m;
  const std::size_t cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  grid.probability.reserve(cells);
  grid.through.reserve(cells);
  for (std::int64_t row = all->first.row; row < all->second.row; ++row)
    for (std::int64_t column = all->first.column; column < all->second.column; ++column) {
      const CellView v = view({column, row});
      grid.probability.push_back(v.known ? static_cast<float>(v.probability) : ProbabilityGrid::unknown);
      grid.through.push_back(v.sensed_through);
    }
  return grid;
}

}  // namespace thicket

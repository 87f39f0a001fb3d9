#include "thicket/nav/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr double units = 32.0;  // log-odds per unit of a cell's value
int to_units(double probability) { return static_cast<int>(std::lround(units * std::log(probability / (1.0 - probability)))); }
double to_probability(int value) { return 1.0 / (1.0 + std::exp(-value / units)); }

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

OccupancyMap::OccupancyMap(const MapSpec& spec)
    : spec_(spec), hit_(to_units(spec.probability_hit)), miss_(to_units(spec.probability_miss)), low_(to_units(spec.clamp_low)), high_(to_units(spec.clamp_high)) {}

CellIndex OccupancyMap::cell_at(const glm::dvec2& point) const {
  return {static_cast<std::int64_t>(std::floor(point.x / spec_.resolution_m)), static_cast<std::int64_t>(std::floor(point.y / spec_.resolution_m))};
}

void OccupancyMap::integrate(const Scan& scan, const Pose& vehicle) {
  const Pose sensor = vehicle * Pose{scan.mount_position, scan.mount_orientation};
  double reach = 0.0;
  for (const Beam& beam : scan.beams) {
    reach = std::max(reach, beam.sensed_range);
    if (beam.echo_count > 0) reach = std::max(reach, scan.echoes_of(beam).back().range);
  }
  const CellIndex centre = cell_at(glm::dvec2(sensor.position));
  const auto half = static_cast<std::int64_t>(std::ceil(reach / spec_.resolution_m)) + 2;
  const auto width = static_cast<std::uint32_t>(2 * half + 1);
  if (width > window_.width) {
    window_.width = width;
    window_.stamps.assign(std::size_t{width} * width, 0);
    window_.stamp = 0;
  }
  if (++window_.stamp >= 1u << 14) {
    std::fill(window_.stamps.begin(), window_.stamps.end(), std::uint16_t{0});
    window_.stamp = 1;
  }
  window_.column = centre.column - window_.width / 2;
  window_.row = centre.row - window_.width / 2;

  const glm::dvec2 from = glm::dvec2(sensor.position) / spec_.resolution_m - glm::dvec2(static_cast<double>(window_.column), static_cast<double>(window_.row));
  for (const Beam& beam : scan.beams) {
    const double plane = std::cos(beam.elevation);
    const glm::dvec2 along(sensor.orientation * glm::dvec3(plane * std::cos(beam.azimuth), plane * std::sin(beam.azimuth), std::sin(beam.elevation)));
    const double shrink = glm::length(along);  // of a beam that climbs or falls, its plan
    if (shrink > 1e-9) draw_beam(scan, beam, from, along / shrink, shrink / spec_.resolution_m);
  }
  apply();
}

void OccupancyMap::touch(std::uint32_t index, State state) {
  std::uint16_t& cell = window_.stamps[index];
  if (cell >> 2 != window_.stamp) {
    cell = static_cast<std::uint16_t>(window_.stamp << 2 | state);
    window_.touched.push_back(index);
  } else if ((cell & 3) < state) {
    cell = static_cast<std::uint16_t>(window_.stamp << 2 | state);
  }
}

/// Walks the cells under a beam (Amanatides & Woo 1987), in cells; `scale` is cells per metre of the beam.
void OccupancyMap::draw_beam(const Scan& scan, const Beam& beam, const glm::dvec2& from, const glm::dvec2& direction, double scale) {
  const auto width = static_cast<std::int64_t>(window_.width);
  const auto echoes = scan.echoes_of(beam);
  bool inside = beam.starts_inside;
  std::size_t next = 0;
  const auto boundary = [&](std::size_t echo) { return echo < echoes.size() ? echoes[echo].range * scale : std::numeric_limits<double>::infinity(); };
  double change = boundary(0);

  auto column = static_cast<std::int64_t>(from.x), row = static_cast<std::int64_t>(from.y);
  const std::int64_t step_column = direction.x > 0.0 ? 1 : -1, step_row = direction.y > 0.0 ? 1 : -1;
  const double step_x = direction.x != 0.0 ? std::abs(1.0 / direction.x) : std::numeric_limits<double>::infinity();
  const double step_y = direction.y != 0.0 ? std::abs(1.0 / direction.y) : std::numeric_limits<double>::infinity();
  const auto to_edge = [](double at, double towards) { return towards > 0.0 ? std::floor(at) + 1.0 - at : at - std::floor(at); };
  double next_x = direction.x != 0.0 ? to_edge(from.x, direction.x) * step_x : std::numeric_limits<double>::infinity();
  double next_y = direction.y != 0.0 ? to_edge(from.y, direction.y) * step_y : std::numeric_limits<double>::infinity();

  const double end = beam.sensed_range * scale;
  for (double at = 0.0; at < end;) {
    const double leave = std::min({next_x, next_y, end});
    // A cell belongs to the stretch that its middle lies in.
    while (0.5 * (at + leave) >= change) {
      if (echoes[next].edge == Edge::front) inside = true;
      if (echoes[next].edge == Edge::back) inside = false;
      change = boundary(++next);
    }
    touch(static_cast<std::uint32_t>(row * width + column), inside ? through : free);
    at = leave;
    if (next_x < next_y) {
      next_x += step_x;
      column += step_column;
    } else {
      next_y += step_y;
      row += step_row;
    }
  }
  for (const Echo& echo : echoes) {
    const glm::dvec2 point = from + echo.range * scale * direction;
    touch(static_cast<std::uint32_t>(static_cast<std::int64_t>(point.y) * width + static_cast<std::int64_t>(point.x)), occupied);
  }
}

OccupancyMap::Tile& OccupancyMap::writable_tile(const CellIndex& index) {
  auto& tile = tiles_[index];
  if (!tile) {
    tile = std::make_shared<Tile>();
  } else if (tile.use_count() > 1) {
    tile = std::make_shared<Tile>(*tile);
  }
  return *tile;
}

void OccupancyMap::apply() {
  CellIndex current{std::numeric_limits<std::int64_t>::min(), 0};
  Tile* tile = nullptr;
  for (const std::uint32_t index : window_.touched) {
    const std::int64_t column = window_.column + index % window_.width, row = window_.row + index / window_.width;
    const CellIndex where{floor_tile(column, tile_bits), floor_tile(row, tile_bits)};
    if (!(where == current)) {
      current = where;
      tile = &writable_tile(where);
    }
    const auto x = static_cast<std::size_t>(column & (tile_size - 1)), y = static_cast<std::size_t>(row & (tile_size - 1));
    std::int8_t& cell = tile->log_odds[y * tile_size + x];
    const auto state = static_cast<State>(window_.stamps[index] & 3);
    const int before = cell == unknown ? 0 : cell;
    cell = static_cast<std::int8_t>(std::clamp(before + (state == occupied ? hit_ : miss_), low_, high_));
    const std::uint64_t bit = std::uint64_t{1} << x;
    if (state == through) {
      tile->through[y] |= bit;
    } else {
      tile->through[y] &= ~bit;
    }
  }
  window_.touched.clear();
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

}  // namespace thicket

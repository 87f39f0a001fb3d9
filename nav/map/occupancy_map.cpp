#include "thicket/nav/occupancy_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cells.hpp"
#include "sensor_model.hpp"
#include "thicket/base/probability_file.hpp"
#include "view_memory.hpp"

namespace thicket {

const Section& map_section() {
  using S = MapSpec;
  static const Section section =
      SectionOf<S>("[map]", "the occupancy map")
          .key("enabled", &S::enabled, "whether a map is made at all")
          .choice("store", &S::store, {"tiles", "dense", "quadtree"}, "where cells are kept: tiles exist only where something was seen; dense is one rectangle of all; quadtree makes one of squares of like cells, slow and frugal in large empty worlds")
          .key("cell_bits", &S::cell_bits, "", between(8, 16), "bits of a cell, 8 or 16: log-odds to 1/32 or 1/4096")
          .key("resolution_m", &S::resolution_m, "m", between(0.001, 100.0), "edge of a cell")
          .key("probability_hit", &S::probability_hit, "", between(0.501, 0.98), "of matter in a cell, given an echo in it")
          .key("probability_miss", &S::probability_miss, "", between(0.02, 0.499), "of matter in a cell that a beam went through")
          .key("probability_detection", &S::probability_detection, "", between(0.01, 0.98), "that a lobe gives an echo of matter in its opening: a silent lobe frees its opening, and each lobe what lies before its echo, by 1 - this")
          .key("lobe_share", &S::lobe_share, "", between(0.05, 1.0), "of a lobe's opening, about its axis, that is freed: a wall that the border of a lobe meets aslant gives no echo, so its silence says nothing; 1 for a sensor that sees walls however aslant")
          .key("range_sigma_m", &S::range_sigma_m, "m", at_least(0.0), "standard deviation of ranges; not given: the sensor's own range_noise_m")
          .key("clamp_low", &S::clamp_low, "", between(0.02, 0.49), "no cell gets surer to be free than this")
          .key("clamp_high", &S::clamp_high, "", between(0.51, 0.98), "no cell gets surer to be occupied than this")
          .choice("evidence", &S::evidence, {"views", "scans"}, "views: a look from where the sensor stood before is no new witness, and of such looks the median counts; scans: every scan counts")
          .key("tolerance", &S::tolerance, "", between(0.0, 0.2), "of the quadtree: how far a probability of about 1/2 may be off for cells to be merged")
          .key("initial", &S::initial, "file of a map to begin with (.yaml, .npy, .ot, .bt: docs/map_files.md), relative to the mission; empty: nothing is known");
  return section;
}

OccupancyMap::OccupancyMap(const MapSpec& spec)
    : spec_(spec), cells_(make_cells(spec)), model_(std::make_unique<SensorModel>(spec)), views_(std::make_unique<ViewMemory>()), prior_(std::make_unique<Prior>()), window_(std::make_unique<Window>()), again_(std::make_unique<Window>()) {}

OccupancyMap::OccupancyMap(const OccupancyMap& other)
    : spec_(other.spec_),
      cells_(other.cells_->clone()),
      model_(std::make_unique<SensorModel>(*other.model_)),
      views_(std::make_unique<ViewMemory>(*other.views_)),
      prior_(std::make_unique<Prior>()),
      window_(std::make_unique<Window>()),
      again_(std::make_unique<Window>()),
      cells_updated_(other.cells_updated_) {}
OccupancyMap& OccupancyMap::operator=(const OccupancyMap& other) {
  if (this != &other) *this = OccupancyMap(other);
  return *this;
}
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;
OccupancyMap::~OccupancyMap() = default;

CellIndex OccupancyMap::cell_at(const glm::dvec2& point) const {
  return {static_cast<std::int64_t>(std::floor(point.x / spec_.resolution_m)), static_cast<std::int64_t>(std::floor(point.y / spec_.resolution_m))};
}

void OccupancyMap::integrate(const Scan& scan, const Pose& vehicle) {
  if (scan.beams.empty()) return;
  const Pose sensor = vehicle * Pose{scan.mount_position, scan.mount_orientation};
  // Half a cell: from farther apart, beams meet other parts of the same cells.
  const auto views = spec_.evidence == "views" ? views_->take(scan, sensor, 0.5 * spec_.resolution_m) : ViewMemory::Views{&scan, {}};
  if (!views.fresh && views.repeated.empty()) return;
  double reach = views.fresh ? model_->reach(*views.fresh) : 0.0;
  for (const ViewMemory::Part& part : views.repeated) reach = std::max(reach, model_->reach(part.scan));
  const CellIndex centre = cell_at(glm::dvec2(sensor.position));
  const auto cells = static_cast<std::int64_t>(std::ceil(reach / spec_.resolution_m)) + 3;
  window_->place(centre, cells);
  prior_->place(*cells_, *window_);
  if (views.fresh) model_->draw(*views.fresh, sensor, *prior_, *window_);
  if (!views.repeated.empty()) {
    again_->place(centre, cells);
    for (const ViewMemory::Part& part : views.repeated) model_->draw(part.scan, part.sensor, *prior_, *again_);
    if (views.fresh) again_->take_from(*window_);
    cells_updated_ += cells_->take(*again_, true, scan.time);
  }
  if (views.fresh) cells_updated_ += cells_->take(*window_, false, scan.time);
}

CellView OccupancyMap::view(const CellIndex& cell) const { return cells_->view(cell); }
bool OccupancyMap::surely_free(const CellIndex& cell) const { return cells_->surely_free(cell); }
std::size_t OccupancyMap::known_cells() const { return cells_->known(); }
std::size_t OccupancyMap::memory_bytes() const { return cells_->memory_bytes(); }
std::optional<std::pair<CellIndex, CellIndex>> OccupancyMap::extent() const { return cells_->extent(); }

ProbabilityGrid OccupancyMap::to_probabilities() const {
  ProbabilityGrid grid;
  grid.resolution = spec_.resolution_m;
  const auto all = extent();
  if (!all) return grid;
  const CellIndex low = all->first;
  grid.width = static_cast<int>(all->second.column - low.column);
  grid.height = static_cast<int>(all->second.row - low.row);
  grid.origin = glm::dvec2(static_cast<double>(low.column), static_cast<double>(low.row)) * spec_.resolution_m;
  const std::size_t cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  grid.probability.assign(cells, ProbabilityGrid::unknown);
  grid.through.assign(cells, 0);
  cells_->each(nullptr, [&](const CellIndex& cell, const CellView& view) {
    const std::size_t i = grid.index(static_cast<int>(cell.column - low.column), static_cast<int>(cell.row - low.row));
    grid.probability[i] = static_cast<float>(view.probability);
    grid.through[i] = view.sensed_through;
  });
  return grid;
}

GridMap OccupancyMap::to_grid() const { return judged(to_probabilities()); }

Result<Done> OccupancyMap::start_from(const ProbabilityGrid& grid) {
  if (std::abs(grid.resolution - spec_.resolution_m) > 1e-9 * spec_.resolution_m)
    return Error{fmt::format("the map to begin with has cells of {} m, expected map.resolution_m = {}", grid.resolution, spec_.resolution_m)};
  const glm::dvec2 corner = grid.origin / spec_.resolution_m;
  const CellIndex low{std::llround(corner.x), std::llround(corner.y)};
  if (std::abs(corner.x - static_cast<double>(low.column)) > 1e-3 || std::abs(corner.y - static_cast<double>(low.row)) > 1e-3)
    return Error{fmt::format("the map to begin with has its corner at ({}, {}) m, expected a multiple of its cells of {} m", grid.origin.x, grid.origin.y, grid.resolution)};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const std::size_t i = grid.index(column, row); grid.known(i)) cells_->put({low.column + column, low.row + row}, grid.probability[i], grid.sensed_through(i), 0.0);
  return Done{};
}

}  // namespace thicket

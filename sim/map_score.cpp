#include "thicket/sim/map_score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "distance_rows.hpp"

namespace thicket {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
double ratio(double part, std::size_t of) { return of > 0 ? part / static_cast<double>(of) : nothing; }
double share(std::size_t part, std::size_t of) { return ratio(static_cast<double>(part), of); }

/// With nothing claimed, or nothing to be found, there is no harmonic mean, but the map is as wrong as can be; with neither there is nothing to judge.
double harmonic_mean(double precision, double recall) {
  if (std::isnan(precision) && std::isnan(recall)) return nothing;
  return std::isgreater(precision, 0.0) && std::isgreater(recall, 0.0) ? 2.0 * precision * recall / (precision + recall) : 0.0;
}

enum Kind : std::uint8_t { free_cell, surface, deep, penetrable };

/// What the cells of a truth are.
std::vector<std::uint8_t> kinds_of(const MapTruth& truth) {
  const int width = truth.solid.width, height = truth.solid.height;
  const auto index = [width](int column, int row) { return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column); };
  std::vector<std::uint8_t> kinds(truth.solid.blocked.size());
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const std::size_t i = index(column, row);
      if (!truth.solid.blocked[i]) {
        kinds[i] = !truth.penetrable.empty() && truth.penetrable[i] != 0 ? penetrable : free_cell;
        continue;
      }
      bool beside = false;
      for (int y = std::max(0, row - 1); y <= std::min(height - 1, row + 1) && !beside; ++y)
        for (int x = std::max(0, column - 1); x <= std::min(width - 1, column + 1) && !beside; ++x) beside = truth.solid.blocked[index(x, y)] == 0;
      kinds[i] = beside ? surface : deep;
    }
  }
  return kinds;
}

/// The map on the cells of the truth; NaN outside of it.
Result<std::vector<float>> on_cells_of(const TruthGrid& truth, const ProbabilityGrid& map) {
  const glm::dvec2 shift = (map.origin - truth.low) / truth.resolution;
  const auto column = std::llround(shift.x), row = std::llround(shift.y);
  constexpr double slack = 1e-3;  // of a cell: origins far away have lost some digits
  if (std::abs(map.resolution - truth.resolution) > 1e-9 * truth.resolution)
    return Error{fmt::format("the map has cells of {} m and the truth of {} m, expected the same", map.resolution, truth.resolution)};
  if (!map.probability.empty() && (std::abs(shift.x - static_cast<double>(column)) > slack || std::abs(shift.y - static_cast<double>(row)) > slack))
    return Error{fmt::format("the map begins {} and {} cells from the truth, expected whole numbers: take the truth from a corner of the map's own cells", shift.x, shift.y)};
  std::vector<float> cells(truth.blocked.size(), ProbabilityGrid::unknown);
  for (int y = 0; y < map.height; ++y) {
    const auto to_row = y + row, first = std::max<long long>(0, -column), last = std::min<long long>(map.width, truth.width - column);
    if (to_row < 0 || to_row >= truth.height || first >= last) continue;
    const auto from = map.probability.begin() + static_cast<std::ptrdiff_t>(map.index(static_cast<int>(first), y));
    std::copy(from, from + (last - first), cells.begin() + static_cast<std::ptrdiff_t>(to_row * truth.width + first + column));
  }
  return cells;
}

/// Distances of cells from marked ones.
struct Distances {
  std::size_t within = 0;  ///< so many within the tolerance
  double sum = 0.0;        ///< cells
  std::vector<float> all;  ///< cells; empty if none is marked
};
Distances distances(const std::vector<std::uint8_t>& of, const std::vector<std::uint8_t>& from, const TruthGrid& grid, double tolerance_cells) {
  DistanceRows rows(from, grid.width, grid.height);
  Distances result;
  const double most = tolerance_cells * tolerance_cells;
  for (int row = 0; row < grid.height; ++row) {
    const std::uint8_t* const wanted = of.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width);
    if (std::find(wanted, wanted + grid.width, 1) == wanted + grid.width) continue;
    const auto squares = rows.squares(row);
    for (int column = 0; column < grid.width; ++column) {
      const std::int64_t square = squares[static_cast<std::size_t>(column)];
      if (!wanted[column] || square == DistanceRows::none) continue;
      const double distance = std::sqrt(static_cast<double>(square));
      result.within += static_cast<double>(square) <= most;
      result.sum += distance;
      result.all.push_back(static_cast<float>(distance));
    }
  }
  return result;
}

/// Takes out claims that penetrable matter accounts for: those within the tolerance of it, and not of a known surface.
void forgive(std::vector<std::uint8_t>& claimed, const std::vector<std::uint8_t>& kinds, const std::vector<std::uint8_t>& surfaces, const TruthGrid& grid, double tolerance_cells) {
  std::vector<std::uint8_t> matter(kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) matter[i] = kinds[i] == penetrable;
  if (std::find(matter.begin(), matter.end(), 1) == matter.end()) return;
  DistanceRows from_matter(matter, grid.width, grid.height), from_surface(surfaces, grid.width, grid.height);
  const double most = tolerance_cells * tolerance_cells;
  for (int row = 0; row < grid.height; ++row) {
    const auto soft = from_matter.squares(row), hard = from_surface.squares(row);
    std::uint8_t* const claims = claimed.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width);
    for (std::size_t column = 0; column < soft.size(); ++column) {
      const bool near_surface = hard[column] != DistanceRows::none && static_cast<double>(hard[column]) <= most;
      if (static_cast<double>(soft[column]) <= most && !near_surface) claims[column] = 0;
    }
  }
}

void judge_edges(const std::vector<float>& cells, const std::vector<std::uint8_t>& kinds, const TruthGrid& grid, MapScore& score) {
  std::vector<std::uint8_t> claimed(cells.size()), surfaces(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    claimed[i] = std::isgreater(cells[i], 0.5f);  // (not for NaN)
    surfaces[i] = kinds[i] == surface && !std::isnan(cells[i]);
  }
  // Cells at exactly the tolerance are within it, whatever 0.2 / 0.1 is in binary.
  const double tolerance_cells = score.tolerance_m / grid.resolution + 1e-6;
  forgive(claimed, kinds, surfaces, grid, tolerance_cells);
  score.claimed = static_cast<std::size_t>(std::count(claimed.begin(), claimed.end(), 1));
  score.surface = static_cast<std::size_t>(std::count(surfaces.begin(), surfaces.end(), 1));
  Distances out = distances(claimed, surfaces, grid, tolerance_cells), back = distances(surfaces, claimed, grid, tolerance_cells);
  score.precision = share(out.within, score.claimed);
  score.recall = share(back.within, score.surface);
  score.f1 = harmonic_mean(score.precision, score.recall);
  score.edge_error_m = 0.5 * grid.resolution * (ratio(out.sum, out.all.size()) + ratio(back.sum, back.all.size()));
  std::vector<float>& all = out.all;
  all.insert(all.end(), back.all.begin(), back.all.end());
  score.edge_error_95_m = nothing;
  if (all.empty()) return;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(all.size()))) - 1;
  std::nth_element(all.begin(), all.begin() + rank, all.end());
  score.edge_error_95_m = grid.resolution * static_cast<double>(all[static_cast<std::size_t>(rank)]);
}

void judge_cells(const std::vector<float>& cells, const std::vector<std::uint8_t>& kinds, const MapTruth& truth, MapScore& score) {
  std::size_t known = 0, claims = 0, right = 0, surfaces = 0;
  double nll = 0.0, claimed_nll = 0.0, claimed_p = 0.0;
  const auto width = static_cast<std::size_t>(truth.solid.width);
  const auto within_bounds = [&](std::size_t i) {
    if (!truth.bounds) return true;
    const glm::dvec2 at = truth.solid.centre(static_cast<int>(i % width), static_cast<int>(i / width));
    return at.x >= truth.bounds->x && at.y >= truth.bounds->y && at.x <= truth.bounds->z && at.y <= truth.bounds->w;
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (kinds[i] != free_cell && kinds[i] != surface) continue;
    const bool seen = !std::isnan(cells[i]), matter = kinds[i] == surface;
    if (within_bounds(i)) {
      ++score.judged;
      score.observed += seen;
    }
    if (!seen) continue;
    const double p = std::clamp(static_cast<double>(cells[i]), 1e-6, 1.0 - 1e-6), loss = -std::log(matter ? p : 1.0 - p);
    ++known;
    surfaces += matter;
    nll += loss;
    if (cells[i] <= 0.5f) continue;
    ++claims;
    right += matter;
    claimed_nll += loss;
    claimed_p += p;
  }
  score.coverage = share(score.observed, score.judged);
  score.strict_precision = share(right, claims);
  score.strict_recall = share(right, surfaces);
  score.strict_f1 = harmonic_mean(score.strict_precision, score.strict_recall);
  score.claimed_nll = ratio(claimed_nll, claims);
  score.claimed_mean_p = ratio(claimed_p, claims);
  score.nll = ratio(nll, known);
}

}  // namespace

Result<MapScore> score_map(const ProbabilityGrid& map, const MapTruth& truth, double tolerance_m) {
  const auto cells = on_cells_of(truth.solid, map);
  if (!cells) return cells.error();
  MapScore score;
  score.tolerance_m = tolerance_m;
  const std::vector<std::uint8_t> kinds = kinds_of(truth);
  judge_cells(*cells, kinds, truth, score);
  judge_edges(*cells, kinds, truth.solid, score);
  return score;
}

Result<MapScore> score_map(const ProbabilityGrid& map, const TruthGrid& truth, double tolerance_m) { return score_map(map, MapTruth{truth, {}, {}}, tolerance_m); }

}  // namespace thicket

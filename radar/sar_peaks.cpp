// What stands out of an image of synthetic aperture.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/radar/sar.hpp"

namespace thicket {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// The image between the middles of its pixels: a cubic through four of them along either axis. NaN where it has not so many.
double amplitude_at(const SarGrid& grid, const glm::dvec2& point) {
  const glm::dvec2 place = (point - grid.origin) / grid.resolution - 0.5;
  const int column = static_cast<int>(std::floor(place.x)), row = static_cast<int>(std::floor(place.y));
  if (column < 1 || row < 1 || column + 2 >= grid.width || row + 2 >= grid.height) return missing;
  const auto weights = [](double t) {
    return std::array{-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
  };
  const auto across = weights(place.x - column), upward = weights(place.y - row);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) sum += across[static_cast<std::size_t>(i)] * upward[static_cast<std::size_t>(j)] * static_cast<double>(grid.amplitude[grid.index(column + i - 1, row + j - 1)]);
  return sum;
}

/// Where a step away from the peak the amplitude falls below half the power, m; NaN if the image ends before.
double half_power_distance(const SarGrid& grid, const glm::dvec2& peak, const glm::dvec2& way, double top) {
  const double step = 0.1 * grid.resolution, level = top * std::sqrt(0.5);
  double before = top;
  for (int i = 1; i < 100000; ++i) {
    const double here = amplitude_at(grid, peak + (i * step) * way);
    if (std::isnan(here)) return missing;
    if (here < level) return (i - 1 + (before - level) / (before - here)) * step;
    before = here;
  }
  return missing;
}

/// Its summit between pixels: the top of a parabola along either axis.
glm::dvec2 summit(const SarGrid& grid, int column, int row) {
  const auto offset = [](float before, float here, float after) {
    const double curve = static_cast<double>(before) - 2.0 * static_cast<double>(here) + static_cast<double>(after);
    return curve < 0.0 ? std::clamp(0.5 * (static_cast<double>(before) - static_cast<double>(after)) / curve, -0.5, 0.5) : 0.0;
  };
  const auto at = [&](int i, int j) { return grid.amplitude[grid.index(i, j)]; };
  glm::dvec2 point = grid.centre(column, row);
  if (column > 0 && column + 1 < grid.width) point.x += grid.resolution * offset(at(column - 1, row), at(column, row), at(column + 1, row));
  if (row > 0 && row + 1 < grid.height) point.y += grid.resolution * offset(at(column, row - 1), at(column, row), at(column, row + 1));
  return point;
}

/// Brighter than all pixels within so many of it; of equal ones the first.
bool stands_out(const SarGrid& grid, int column, int row, int reach) {
  const std::size_t own = grid.index(column, row);
  const float here = grid.amplitude[own];
  for (int j = std::max(0, row - reach); j <= std::min(grid.height - 1, row + reach); ++j) {
    for (int i = std::max(0, column - reach); i <= std::min(grid.width - 1, column + reach); ++i) {
      const std::size_t other = grid.index(i, j);
      if (grid.amplitude[other] > here || (grid.amplitude[other] == here && other < own)) return false;
    }
  }
  return true;
}

}  // namespace

float SarGrid::brightest() const { return amplitude.empty() ? 0.0f : *std::max_element(amplitude.begin(), amplitude.end()); }

std::vector<SarPeak> sar_peaks(const SarGrid& grid, double floor_db, double distance, std::size_t most) {
  std::vector<SarPeak> peaks;
  const double brightest = static_cast<double>(grid.brightest());
  if (!(brightest > 0.0)) return peaks;
  const auto floor = static_cast<float>(brightest * std::pow(10.0, floor_db / 20.0));
  const int reach = std::max(1, static_cast<int>(std::ceil(distance / grid.resolution)));
  struct Found {
    float amplitude;
    int column, row;
  };
  std::vector<Found> found;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const float a = grid.amplitude[grid.index(column, row)]; a >= floor && stands_out(grid, column, row, 1) && stands_out(grid, column, row, reach)) found.push_back({a, column, row});
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.amplitude > b.amplitude; });
  if (found.size() > most) found.resize(most);
  for (const Found& f : found) {
    SarPeak peak;
    peak.position = summit(grid, f.column, f.row);
    peak.db = 20.0 * std::log10(static_cast<double>(f.amplitude) / brightest);
    const double between = amplitude_at(grid, peak.position), top = std::isnan(between) ? static_cast<double>(f.amplitude) : between;
    const glm::dvec2 along = direction(static_cast<double>(grid.bearing[grid.index(f.column, f.row)])), across(-along.y, along.x);
    peak.range_width = half_power_distance(grid, peak.position, along, top) + half_power_distance(grid, peak.position, -along, top);
    peak.azimuth_width = half_power_distance(grid, peak.position, across, top) + half_power_distance(grid, peak.position, -across, top);
    peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace thicket

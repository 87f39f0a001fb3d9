// What an image of synthetic aperture tells of a map: where it saw well and nothing returned, there is nothing.
#include <algorithm>
#include <cmath>

#include "thicket/sim/sar.hpp"

namespace thicket {
namespace {

/// m: how far from a cell its return may seem to be: half of what the X4M05's pulse is wide, and the drift of a position between pixels.
constexpr double margin = 0.05;

/// The mean return of pixels, amplitude by looks; 0 where the image has no say.
struct Returns {
  const SarGrid& grid;
  double aperture;  ///< rad, that a pixel must have been seen over

  bool sees(std::size_t i) const { return grid.looks[i] > 0.0f && static_cast<double>(grid.aperture[i]) >= aperture; }
  double of(std::size_t i) const { return sees(i) ? static_cast<double>(grid.amplitude[i]) / static_cast<double>(grid.looks[i]) : 0.0; }
};

struct Around {
  double strongest = 0.0;
  bool all_seen = true;
};

/// The pixels within a radius of a point.
Around around(const Returns& returns, const glm::dvec2& point, double radius) {
  const SarGrid& grid = returns.grid;
  const glm::dvec2 low = (point - radius - grid.origin) / grid.resolution, high = (point + radius - grid.origin) / grid.resolution;
  const auto pixel = [](double place) { return static_cast<std::int64_t>(std::floor(place)); };
  Around result;
  result.all_seen = pixel(low.x) >= 0 && pixel(low.y) >= 0 && pixel(high.x) < grid.width && pixel(high.y) < grid.height;
  for (std::int64_t row = std::max<std::int64_t>(0, pixel(low.y)); row <= std::min<std::int64_t>(grid.height - 1, pixel(high.y)); ++row) {
    for (std::int64_t column = std::max<std::int64_t>(0, pixel(low.x)); column <= std::min<std::int64_t>(grid.width - 1, pixel(high.x)); ++column) {
      const glm::dvec2 d = grid.centre(static_cast<int>(column), static_cast<int>(row)) - point;
      if (d.x * d.x + d.y * d.y > radius * radius) continue;
      const std::size_t i = grid.index(static_cast<int>(column), static_cast<int>(row));
      result.all_seen = result.all_seen && returns.sees(i);
      result.strongest = std::max(result.strongest, returns.of(i));
    }
  }
  return result;
}

}  // namespace

SarFusion fuse_sar(const ProbabilityGrid& map, const SarImage& image) {
  const SarSpec& spec = image.spec();
  SarFusion fusion;
  fusion.map = map;
  const SarGrid grid = image.grid();
  const Returns returns{grid, radians(spec.fuse_aperture_deg)};
  const double reach = std::sqrt(0.5) * map.resolution + margin, threshold = std::pow(10.0, spec.fuse_threshold_db / 20.0);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const std::size_t cell = map.index(column, row);
      if (!map.known(cell) || map.probability[cell] <= 0.5f) continue;
      ++fusion.claimed;
      const glm::dvec2 centre = image.from_world(map.origin + map.resolution * glm::dvec2(column + 0.5, row + 0.5));
      const Around own = around(returns, centre, reach);
      if (!own.all_seen || grid.width == 0) continue;
      ++fusion.judged;
      if (own.strongest >= threshold * around(returns, centre, spec.fuse_radius_m).strongest) continue;
      ++fusion.removed;
      fusion.map.probability[cell] = 0.5f;
    }
  }
  return fusion;
}

}  // namespace thicket

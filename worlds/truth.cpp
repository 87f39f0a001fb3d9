#include "thicket/worlds/truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket {
namespace {

constexpr double touch = 1e-6;  // of a cell

struct Span {
  double low = INFINITY, high = -INFINITY;
  void hold(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// The x that a piece, all of it widened to a radius, has between two heights y. Its outermost points there lie on arcs about corners or on edges moved outward;
/// the edges moved inward lie within.
Span across(const std::vector<glm::dvec2>& corners, double radius, double y_low, double y_high) {
  Span span;
  for (const glm::dvec2& c : corners) {
    const double dy = std::max({0.0, y_low - c.y, c.y - y_high});
    if (dy > radius) continue;
    const double half = std::sqrt((radius - dy) * (radius + dy));
    span.hold(c.x - half);
    span.hold(c.x + half);
  }
  for (std::size_t i = 0; i < corners.size() && corners.size() > 1; ++i) {
    const glm::dvec2 p = corners[i], q = corners[(i + 1) % corners.size()], along = q - p;
    const double length = glm::length(along);
    if (length == 0.0 || std::min(p.y, q.y) - radius > y_high || std::max(p.y, q.y) + radius < y_low) continue;
    for (const double side : {radius, -radius}) {
      const glm::dvec2 offset = glm::dvec2(along.y, -along.x) * (side / length), a = p + offset, b = q + offset;
      if (std::max(a.y, b.y) < y_low || std::min(a.y, b.y) > y_high) continue;
      for (const glm::dvec2& end : {a, b}) {
        const double y = std::clamp(end.y, y_low, y_high);
        span.hold(y == end.y ? end.x : a.x + along.x * ((y - a.y) / along.y));
      }
      if (radius == 0.0) break;
    }
  }
  return span;
}

double distance(const glm::dvec2& p, const std::vector<glm::dvec2>& corners) {
  if (corners.size() == 1) return std::hypot(p.x - corners[0].x, p.y - corners[0].y);
  bool in = corners.size() > 2;
  double least = INFINITY;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 a = corners[i], along = corners[(i + 1) % corners.size()] - a, d = p - a;
    in = in && along.x * d.y - along.y * d.x >= 0.0;
    const double square = glm::dot(along, along), t = square > 0.0 ? std::clamp(glm::dot(d, along) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, std::hypot(d.x - t * along.x, d.y - t * along.y));
  }
  return in ? 0.0 : least;
}

/// Blocks cells of a grid, row by row.
class Raster {
 public:
  explicit Raster(TruthGrid& grid) : grid_(grid) {}

  /// Cells of which a square of half side `half` about the centre meets the piece.
  void fill_squares(const plan::Piece& piece, double half) {
    each_row(piece, piece.radius + half, [&](int row, double y) {
      const Span span = across(piece.corners, piece.radius, y - half, y + half);
      block(row, std::ceil(column_of(span.low - half)), std::floor(column_of(span.high + half)));
    });
  }

  /// Cells whose centre is nearer to the piece than `grow`.
  void fill_near(const plan::Piece& piece, double grow) {
    const double radius = piece.radius + grow;
    each_row(piece, radius, [&](int row, double y) {
      const Span span = across(piece.corners, radius, y, y);
      // Nearer than the radius, not as near: a row that only touches the widened piece has none, and where the piece ends at a centre, to rounding, the distance decides.
      const auto near_x = [&](double x) { return distance({x, y}, piece.corners) < radius; };
      const auto near = [&](double column) { return near_x(grid_.low.x + (column + 0.5) * grid_.resolution); };
      if (!(span.low <= span.high) || !near_x(0.5 * (span.low + span.high))) return;
      double first = std::ceil(column_of(span.low) - touch), last = std::floor(column_of(span.high) + touch);
      if (first <= column_of(span.low) + touch && !near(first)) ++first;
      if (last >= column_of(span.high) - touch && !near(last)) --last;
      block(row, first, last);
    });
  }

  /// Notes where an edge of a section passes the rows' middles.
  void pass(const glm::dvec2& from, const glm::dvec2& to) {
    const bool up = from.y < to.y;
    const glm::dvec2 &a = up ? from : to, &b = up ? to : from;
    const auto first = std::max(0.0, std::ceil(row_of(a.y)) - 1.0), last = std::min(grid_.height - 1.0, std::floor(row_of(b.y)) + 1.0);
    for (double row = first; row <= last; ++row) {
      const double y = grid_.centre(0, static_cast<int>(row)).y;
      if (!(a.y <= y && y < b.y)) continue;
      if (passes_.empty()) passes_.resize(static_cast<std::size_t>(grid_.height));
      passes_[static_cast<std::size_t>(row)].emplace_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)), up ? 1 : -1);
    }
  }
  /// Blocks what the edges enclose, and forgets them.
  void fill_section() {
    for (std::size_t row = 0; row < passes_.size(); ++row) {
      auto& list = passes_[row];
      std::sort(list.begin(), list.end());
      int winding = 0;
      for (std::size_t i = 0; i + 1 < list.size(); ++i) {
        winding += list[i].second;
        if (winding != 0) block(static_cast<int>(row), std::ceil(column_of(list[i].first)), std::floor(column_of(list[i + 1].first)));
      }
    }
    passes_.clear();
  }

 private:
  double column_of(double x) const { return (x - grid_.low.x) / grid_.resolution - 0.5; }
  double row_of(double y) const { return (y - grid_.low.y) / grid_.resolution - 0.5; }

  template <class Do>
  void each_row(const plan::Piece& piece, double reach, const Do& act) const {
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const glm::dvec2& c : piece.corners) {
      low = glm::min(low, c);
      high = glm::max(high, c);
    }
    if (column_of(high.x + reach) < -1.0 || column_of(low.x - reach) > grid_.width) return;
    const double first = std::max(0.0, std::ceil(row_of(low.y - reach)) - 1.0), last = std::min(grid_.height - 1.0, std::floor(row_of(high.y + reach)) + 1.0);
    for (double row = first; row <= last; ++row) act(static_cast<int>(row), grid_.centre(0, static_cast<int>(row)).y);
  }

  void block(int row, double first, double last) {
    first = std::max(first, 0.0);
    last = std::min(last, grid_.width - 1.0);
    if (!(first <= last)) return;
    const auto begin = grid_.blocked.begin() + static_cast<std::ptrdiff_t>(row) * grid_.width;
    std::fill(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last) + 1, std::uint8_t{1});
  }

  TruthGrid& grid_;
  std::vector<std::vector<std::pair<double, int>>> passes_;  ///< by row: x, and 1 for an edge that goes up, -1 for one that goes down
};

Result<TruthGrid> empty_grid(const glm::dvec2& low, const glm::dvec2& high, double resolution, double z_low, double z_high) {
  if (!std::isfinite(resolution) || resolution <= 0.0) return Error{fmt::format("the resolution is {} m, expected a finite number greater than 0", resolution)};
  const bool finite = std::isfinite(low.x) && std::isfinite(low.y) && std::isfinite(high.x) && std::isfinite(high.y);
  if (!finite || !(low.x < high.x && low.y < high.y))
    return Error{fmt::format("the bounds are {}, {} to {}, {} m, expected finite numbers, the first smaller than the second", low.x, low.y, high.x, high.y)};
  if (!std::isfinite(z_low) || !std::isfinite(z_high) || z_low > z_high)
    return Error{fmt::format("the heights are {} to {} m, expected finite numbers, the first not greater than the second", z_low, z_high)};
  // In extended precision first: there may be more columns and rows than a double can count.
  using Long = long double;
  const Long wide = (Long(high.x) - Long(low.x)) / Long(resolution), tall = (Long(high.y) - Long(low.y)) / Long(resolution);
  if (std::max(wide, tall) > 1e100L) return Error{fmt::format("the grid would be more than 1e100 cells long or wide, expected at most {:.0f} in all: take a larger resolution or smaller bounds", max_truth_cells)};
  // A last cell of no more than a rounding error is none.
  const double columns = std::max(1.0, std::ceil((high.x - low.x) / resolution - touch)), rows = std::max(1.0, std::ceil((high.y - low.y) / resolution - touch));
  if (!(columns * rows <= max_truth_cells))
    return Error{fmt::format("the grid would be {:.0f} x {:.0f} cells, expected at most {:.0f} in all: take a larger resolution or smaller bounds", columns, rows, max_truth_cells)};
  TruthGrid grid;
  grid.low = low;
  grid.resolution = resolution;
  grid.width = static_cast<int>(columns);
  grid.height = static_cast<int>(rows);
  grid.blocked.assign(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height), 0);
  return grid;
}

struct Cost {
  int straight = 0, diagonal = 0;  ///< steps: sums stay exact, so that ways of the same length tie
  double cells() const { return straight + diagonal * std::sqrt(2.0); }
};

}  // namespace

bool TruthGrid::contains(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low) / resolution;
  return p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height;
}

std::size_t TruthGrid::index_at(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low) / resolution;
  return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(p.x);
}

Result<TruthGrid> occupancy(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double z_low, double z_high,
                            Convention convention, bool only_stops_motion) {
  auto grid = empty_grid(low, high, resolution, z_low, z_high);
  if (!grid) return grid;
  Raster raster(*grid);
  const double half = (convention == Convention::cell_centre ? touch : 0.5 - touch) * resolution;
  for (const Solid& solid : world.solids) {
    if (only_stops_motion && !world.materials[solid.material].stops_motion) continue;
    plan::visit(solid, z_low, z_high,
                {[&](const plan::Piece& piece) { raster.fill_squares(piece, half); }, [&](const glm::dvec2& a, const glm::dvec2& b) { raster.pass(a, b); }});
    raster.fill_section();
  }
  return grid;
}

Result<TruthGrid> grown_obstacles(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low, double z_high) {
  if (!std::isfinite(grow) || grow < 0.0) return Error{fmt::format("obstacles are to grow by {} m, expected a finite number, 0 or more", grow)};
  auto grid = empty_grid(low, high, resolution, z_low, z_high);
  if (!grid || grow == 0.0) return grid;
  Raster raster(*grid);
  for (const Solid& solid : world.solids) {
    if (!world.materials[solid.material].stops_motion) continue;
    plan::visit(solid, z_low, z_high,
                {[&](const plan::Piece& piece) { raster.fill_near(piece, grow); }, [&](const glm::dvec2& a, const glm::dvec2& b) { raster.pass(a, b); }});
    raster.fill_section();
  }
  return grid;
}

bool connected(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to) {
  if (!grid.contains(from) || !grid.contains(to)) return false;
  const std::size_t start = grid.index_at(from), goal = grid.index_at(to);
  if (grid.blocked[start] || grid.blocked[goal]) return false;
  std::vector<std::uint8_t> seen = grid.blocked;
  std::vector<std::size_t> open = {start};
  seen[start] = 1;
  const auto width = static_cast<std::size_t>(grid.width);
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (at == goal) return true;
    const std::size_t column = at % width;
    const auto visit = [&](bool exists, std::size_t next) {
      if (!exists || seen[next]) return;
      seen[next] = 1;
      open.push_back(next);
    };
    visit(column > 0, at - 1);
    visit(column + 1 < width, at + 1);
    visit(at >= width, at - width);
    visit(at + width < seen.size(), at + width);
  }
  return false;
}

std::optional<GridPath> shortest_path(const TruthGrid& grid, const glm::dvec2& from, const glm::dvec2& to) {
  if (!grid.contains(from) || !grid.contains(to)) return std::nullopt;
  const auto width = static_cast<std::size_t>(grid.width);
  const std::size_t start = grid.index_at(from), goal = grid.index_at(to);
  const auto free = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.width && row < grid.height &&
           !grid.blocked[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
  };
  const auto column_of = [&](std::size_t cell) { return static_cast<int>(cell % width); };
  const auto row_of = [&](std::size_t cell) { return static_cast<int>(cell / width); };
  if (!free(column_of(start), row_of(start)) || !free(column_of(goal), row_of(goal))) return std::nullopt;

  const auto estimate = [&](std::size_t cell, const Cost& so_far) {
    const int dx = std::abs(column_of(cell) - column_of(goal)), dy = std::abs(row_of(cell) - row_of(goal));
    return Cost{so_far.straight + std::abs(dx - dy), so_far.diagonal + std::min(dx, dy)}.cells();
  };
  struct Open {
    double estimate;
    Cost cost;
    std::size_t cell;
    /// The heap has the least in front: the least estimate, then the farthest on, then the lowest index.
    bool operator<(const Open& other) const {
      if (estimate != other.estimate) return estimate > other.estimate;
      if (cost.cells() != other.cost.cells()) return cost.cells() < other.cost.cells();
      return cell > other.cell;
    }
  };
  constexpr std::array<std::array<int, 2>, 8> steps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  constexpr std::uint8_t unseen = 255, first = 254;
  std::vector<Cost> best(grid.blocked.size());
  std::vector<std::uint8_t> came(grid.blocked.size(), unseen);  // by which step
  std::priority_queue<Open> open;
  came[start] = first;
  open.push({estimate(start, {}), {}, start});
  while (!open.empty()) {
    const Open at = open.top();
    open.pop();
    if (at.cell == goal) break;
    if (best[at.cell].cells() < at.cost.cells()) continue;  // found again, by a shorter way
    const int column = column_of(at.cell), row = row_of(at.cell);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const auto [dx, dy] = steps[i];
      const bool diagonal = i >= 4;
      if (!free(column + dx, row + dy) || (diagonal && (!free(column + dx, row) || !free(column, row + dy)))) continue;
      const std::size_t next = static_cast<std::size_t>(row + dy) * width + static_cast<std::size_t>(column + dx);
      const Cost cost{at.cost.straight + !diagonal, at.cost.diagonal + diagonal};
      if (came[next] != unseen && best[next].cells() <= cost.cells()) continue;
      best[next] = cost;
      came[next] = static_cast<std::uint8_t>(i);
      open.push({estimate(next, cost), cost, next});
    }
  }
  if (came[goal] == unseen) return std::nullopt;
  GridPath path;
  path.length_m = best[goal].cells() * grid.resolution;
  for (std::size_t cell = goal;;) {
    path.points.push_back(grid.centre(column_of(cell), row_of(cell)));
    if (came[cell] == first) break;
    const auto [dx, dy] = steps[came[cell]];
    cell = static_cast<std::size_t>(row_of(cell) - dy) * width + static_cast<std::size_t>(column_of(cell) - dx);
  }
  std::reverse(path.points.begin(), path.points.end());
  return path;
}

}  // namespace thicket

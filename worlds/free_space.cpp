#include "thicket/worlds/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket {
namespace {

/// A convex piece whose edges are measured once and not at every node.
class Measured {
 public:
  explicit Measured(const plan::Piece& piece) : radius_(piece.radius) {
    for (std::size_t i = 0; i < piece.corners.size(); ++i) {
      const glm::dvec2 a = piece.corners[i], along = piece.corners[(i + 1) % piece.corners.size()] - a;
      const double square = glm::dot(along, along);
      low_ = glm::min(low_, a);
      high_ = glm::max(high_, a);
      if (square > 0.0 || piece.corners.size() == 1) edges_.push_back({a, along, square > 0.0 ? 1.0 / square : 0.0});
    }
    if (edges_.empty()) edges_.push_back({piece.corners[0], {0.0, 0.0}, 0.0});
  }

  glm::dvec2 low() const { return low_ - radius_; }
  glm::dvec2 high() const { return high_ + radius_; }

  double distance(const glm::dvec2& p) const {
    bool in = edges_.size() > 2;
    double least = INFINITY;
    for (const Edge& e : edges_) {
      const glm::dvec2 d = p - e.from;
      in = in && e.along.x * d.y - e.along.y * d.x >= 0.0;
      const glm::dvec2 off = d - std::clamp(glm::dot(d, e.along) * e.inverse_square, 0.0, 1.0) * e.along;
      least = std::min(least, glm::dot(off, off));
    }
    return in ? 0.0 : std::max(0.0, std::sqrt(least) - radius_);
  }

 private:
  struct Edge {
    glm::dvec2 from, along;
    double inverse_square;
  };
  std::vector<Edge> edges_;
  double radius_;
  glm::dvec2 low_{INFINITY}, high_{-INFINITY};
};

/// Lowers the distances of a grid, solid by solid.
class Measurer {
 public:
  explicit Measurer(DistanceGrid& grid) : grid_(grid) {}

  void take(const plan::Piece& piece) {
    const Measured measured(piece);
    const glm::dvec2 low = (measured.low() - grid_.limit - grid_.low) / grid_.resolution - 0.5, high = (measured.high() + grid_.limit - grid_.low) / grid_.resolution - 0.5;
    const auto [first_column, last_column] = within(low.x, high.x, grid_.width);
    const auto [first_row, last_row] = within(low.y, high.y, grid_.height);
    for (int row = first_row; row <= last_row; ++row) {
      float* line = grid_.distance.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width);
      for (int column = first_column; column <= last_column; ++column)
        if (line[column] > 0.0f) line[column] = std::min(line[column], static_cast<float>(measured.distance(grid_.node(column, row))));
    }
  }

  /// Notes where an edge of a section passes the rows' nodes.
  void pass(const glm::dvec2& from, const glm::dvec2& to) {
    const bool up = from.y < to.y;
    const glm::dvec2 &a = up ? from : to, &b = up ? to : from;
    const auto [first, last] = within((a.y - grid_.low.y) / grid_.resolution - 1.5, (b.y - grid_.low.y) / grid_.resolution + 0.5, grid_.height);
    for (int row = first; row <= last; ++row) {
      const double y = grid_.node(0, row).y;
      if (!(a.y <= y && y < b.y)) continue;
      passes_.resize(static_cast<std::size_t>(grid_.height));
      passes_[static_cast<std::size_t>(row)].emplace_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)), up ? 1 : -1);
    }
  }
  /// What the edges enclose is matter; forgets them.
  void fill_section() {
    for (std::size_t row = 0; row < passes_.size(); ++row) {
      auto& list = passes_[row];
      std::sort(list.begin(), list.end());
      int winding = 0;
      for (std::size_t i = 0; i + 1 < list.size(); ++i) {
        winding += list[i].second;
        if (winding == 0) continue;
        const auto [first, last] = within(std::ceil((list[i].first - grid_.low.x) / grid_.resolution - 0.5), std::floor((list[i + 1].first - grid_.low.x) / grid_.resolution - 0.5), grid_.width);
        for (int column = first; column <= last; ++column) grid_.distance[row * static_cast<std::size_t>(grid_.width) + static_cast<std::size_t>(column)] = 0.0f;
      }
    }
    passes_.clear();
  }

 private:
  /// The nodes from one place of a row or column to another, as first and last; none if the first is greater.
  static std::pair<int, int> within(double low, double high, int count) {
    const double first = std::max(0.0, std::ceil(low)), last = std::min(count - 1.0, std::floor(high));
    return first <= last ? std::pair(static_cast<int>(first), static_cast<int>(last)) : std::pair(0, -1);
  }

  DistanceGrid& grid_;
  std::vector<std::vector<std::pair<double, int>>> passes_;  ///< by row: x, and 1 for an edge that goes up, -1 for one that goes down
};

}  // namespace

bool DistanceGrid::contains(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low) / resolution;
  return p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height;
}

double DistanceGrid::at(const glm::dvec2& point) const {
  if (!contains(point)) return limit;
  const glm::dvec2 p = (point - low) / resolution;
  return static_cast<double>(distance[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(p.x)]);
}

Result<DistanceGrid> distance_to_matter(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double limit, double z_low, double z_high) {
  if (!(limit > 0.0) || !std::isfinite(limit)) return Error{fmt::format("distances are to be measured up to {} m, expected a finite number greater than 0", limit)};
  // The same cells, and the same complaints, as those of a map of the truth.
  const auto cells = grown_obstacles(World{}, low, high, resolution, 0.0, z_low, z_high);
  if (!cells) return cells.error();
  DistanceGrid grid{low, resolution, cells->width, cells->height, limit, std::vector<float>(cells->blocked.size(), static_cast<float>(limit))};
  Measurer measurer(grid);
  for (const Solid& solid : world.solids) {
    if (!world.materials[solid.material].stops_motion) continue;
    plan::visit(solid, z_low, z_high, {[&](const plan::Piece& piece) { measurer.take(piece); }, [&](const glm::dvec2& a, const glm::dvec2& b) { measurer.pass(a, b); }});
    measurer.fill_section();
  }
  return grid;
}

FreeSpace::FreeSpace(const DistanceGrid& distances, double grow)
    : low_(distances.low), resolution_(distances.resolution), grow_(std::clamp(grow, 0.0, distances.limit)), width_(distances.width), height_(distances.height) {
  constexpr std::uint32_t unlabelled = 0xffffffffu;
  labels_.assign(stride() * (static_cast<std::size_t>(height_) + 2), unlabelled);
  for (int row = 0; row < height_; ++row)
    for (int column = 0; column < width_; ++column)
      if (static_cast<double>(distances.distance[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)]) < grow_)
        labels_[static_cast<std::size_t>(row + 1) * stride() + static_cast<std::size_t>(column + 1)] = 0;
  label();
  trace(distances);
}

void FreeSpace::label() {
  constexpr std::uint32_t unlabelled = 0xffffffffu;
  const std::size_t width = stride(), count = labels_.size();
  std::uint32_t next = 0;
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < count; ++first) {
    if (labels_[first] != unlabelled) continue;
    ++next;
    const auto visit = [&](std::size_t node) {
      if (labels_[node] != unlabelled) return;
      labels_[node] = next;
      open.push_back(node);
    };
    visit(first);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      if (at % width > 0) visit(at - 1);
      if (at % width + 1 < width) visit(at + 1);
      if (at >= width) visit(at - width);
      if (at + width < count) visit(at + width);
    }
  }
}

std::uint32_t FreeSpace::component_at(const glm::dvec2& point) const {
  const glm::dvec2 p = (point - low_) / resolution_;
  if (!(p.x >= 0.0 && p.y >= 0.0 && p.x < width_ && p.y < height_)) return outside();
  return component_at(static_cast<int>(p.x), static_cast<int>(p.y));
}

TruthGrid FreeSpace::grid() const {
  TruthGrid grid;
  grid.low = low_;
  grid.resolution = resolution_;
  grid.width = width_;
  grid.height = height_;
  grid.blocked.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int row = 0; row < height_; ++row)
    for (int column = 0; column < width_; ++column) grid.blocked.push_back(component_at(column, row) == 0);
  return grid;
}

}  // namespace thicket

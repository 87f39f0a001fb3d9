// Marching squares over the distances from matter, and what lines are asked for.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/worlds/free_space.hpp"

namespace thicket {
namespace {

/// Sides of a square of four nodes, and its corners: both counter-clockwise, side i from corner i to corner i + 1. Corner 0 is the lower left.
enum Side { bottom, right, top, left };

/// For each pattern of blocked corners (bit i: corner i) and each side by which the line comes in: the side by which it goes out, free space on its left. -1: none.
/// Where two blocked corners lie crosswise, they are joined and the free ones are apart.
int way_out(unsigned blocked, int in) {
  // The line comes in over a side whose corners differ. It turns about the free corners: it runs with them on its left, over the sides between free ones, to the next
  // side whose corners differ. In by side i: seen from within, corner i + 1 is on the right and corner i on the left, so that corner i is free.
  for (int step = 1; step < 4; ++step) {
    const int side = (in + 4 - step) % 4;  // clockwise from the side of entry: about corner i, then i - 1, ...
    const bool from = blocked >> side & 1u, to = blocked >> ((side + 1) % 4) & 1u;
    if (from != to) return side;
  }
  return -1;
}

}  // namespace

void FreeSpace::trace(const DistanceGrid& distances) {
  const int columns = width_ + 2, rows = height_ + 2;  // of nodes, with the rim
  const auto label = [&](int column, int row) { return labels_[static_cast<std::size_t>(row) * stride() + static_cast<std::size_t>(column)]; };
  const auto value = [&](int column, int row) {
    if (column == 0 || row == 0 || column == columns - 1 || row == rows - 1) return distances.limit;
    return static_cast<double>(distances.distance[static_cast<std::size_t>(row - 1) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column - 1)]);
  };
  constexpr std::array<std::array<int, 2>, 4> corners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, steps = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  // A line is begun at an upright edge of two nodes that it passes downward or upward; each is passed once, by one line.
  std::vector<std::uint8_t> passed(labels_.size(), 0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      // A level edge whose left node is free and right one blocked or the other way round: entered from below or above, with the free node on the left.
      const bool here = label(column, row) != 0, there = label(column + 1, row) != 0;
      if (here == there || passed[static_cast<std::size_t>(row) * stride() + static_cast<std::size_t>(column)]) continue;
      // Into the square above by its bottom if the left node is free, else into the square below by its top.
      int x = column, y = here ? row : row - 1, in = here ? bottom : top;
      GrownContour contour;
      contour.component = here ? label(column, row) : label(column + 1, row);
      for (;;) {
        const auto [ax, ay] = corners[static_cast<std::size_t>(in)];
        const auto [bx, by] = corners[static_cast<std::size_t>((in + 1) % 4)];
        if (in == bottom || in == top) {
          std::uint8_t& mark = passed[static_cast<std::size_t>(y + (in == top)) * stride() + static_cast<std::size_t>(x)];
          if (mark) break;  // round
          mark = 1;
        }
        const double a = value(x + ax, y + ay), b = value(x + bx, y + by);
        const double t = a == b ? 0.5 : std::clamp((grow_ - a) / (b - a), 0.0, 1.0);
        const glm::dvec2 at(x + ax + t * (bx - ax) - 0.5, y + ay + t * (by - ay) - 0.5);
        contour.points.push_back(low_ + at * resolution_);
        unsigned blocked = 0;
        for (unsigned i = 0; i < 4; ++i)
          if (label(x + corners[i][0], y + corners[i][1]) == 0) blocked |= 1u << i;
        const int out = way_out(blocked, in);
        x += steps[static_cast<std::size_t>(out)][0];
        y += steps[static_cast<std::size_t>(out)][1];
        in = (out + 2) % 4;
      }
      for (std::size_t i = 0; i < contour.points.size(); ++i) contour.length_m += glm::distance(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
      contours_.push_back(std::move(contour));
    }
  }
}

Result<std::vector<GrownContour>> grown_contours(const World& world, const glm::dvec2& low, const glm::dvec2& high, double resolution, double grow, double z_low,
                                                 double z_high, const glm::dvec2& from) {
  // Two cells farther than the growth, so that a line lies between two true distances.
  const auto distances = distance_to_matter(world, low, high, resolution, grow + 2.0 * resolution, z_low, z_high);
  if (!distances) return distances.error();
  const FreeSpace space(*distances, grow);
  const std::uint32_t component = space.component_at(from);
  std::vector<GrownContour> contours;
  for (const GrownContour& contour : space.contours())
    if (component != 0 && contour.component == component) contours.push_back(contour);
  return contours;
}

std::size_t crossings(const GrownContour& contour, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const auto side = [&](const glm::dvec2& p) { return along.x * (p.y - a.y) - along.y * (p.x - a.x); };
  std::size_t count = 0;
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    const glm::dvec2 p = contour.points[i], q = contour.points[(i + 1) % contour.points.size()];
    const double from = side(p), to = side(q);
    if ((from < 0.0) == (to < 0.0)) continue;
    const double share = glm::dot(p + (from / (from - to)) * (q - p) - a, along);
    count += share >= 0.0 && share < glm::dot(along, along);
  }
  return count;
}

double distance_from(const GrownContour& contour, const glm::dvec2& point) {
  double least = INFINITY;
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    const glm::dvec2 p = contour.points[i], along = contour.points[(i + 1) % contour.points.size()] - p;
    const double square = glm::dot(along, along);
    least = std::min(least, glm::distance(point, p + (square > 0.0 ? std::clamp(glm::dot(point - p, along) / square, 0.0, 1.0) : 0.0) * along));
  }
  return least;
}

std::size_t local_minima(const GrownContour& contour, const glm::dvec2& point, double depth) {
  const std::size_t count = contour.points.size();
  std::size_t farthest = 0;
  std::vector<double> distance(count);
  for (std::size_t i = 0; i < count; ++i) {
    distance[i] = glm::distance(contour.points[i], point);
    if (distance[i] > distance[farthest]) farthest = i;
  }
  // Once round from the farthest point: down by the depth and up again by the depth is a minimum.
  std::size_t minima = 0;
  bool down = false;
  double extreme = count > 0 ? distance[farthest] : 0.0;  // the highest on the way down to the next minimum, the lowest on the way up
  for (std::size_t i = 1; i <= count; ++i) {
    const double d = distance[(farthest + i) % count];
    if (!down) {
      extreme = std::max(extreme, d);
      if (d < extreme - depth) down = true, extreme = d;
    } else {
      extreme = std::min(extreme, d);
      if (d > extreme + depth) down = false, extreme = d, ++minima;
    }
  }
  return std::max<std::size_t>(minima, 1);
}

}  // namespace thicket

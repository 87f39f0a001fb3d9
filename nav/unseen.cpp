#include "unseen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr float open_range = std::numeric_limits<float>::infinity();

/// Bearing to 0.3 degrees, in a fraction of the time of atan2: enough to tell bins of half a degree from gaps of many.
double rough_bearing(const glm::dvec2& v) {
  const double ax = std::abs(v.x), ay = std::abs(v.y), z = std::min(ax, ay) / std::max({ax, ay, 1e-12});
  double angle = z * (0.25 * pi + 0.273 * (1.0 - z));
  if (ay > ax) angle = 0.5 * pi - angle;
  if (v.x < 0.0) angle = pi - angle;
  return v.y < 0.0 ? -angle : angle;
}

}  // namespace

Unseen::Unseen(double reach, double cell, double memory)
    : reach_(reach),
      cell_(cell),
      memory_(memory),
      edge_(2 * static_cast<std::int32_t>(std::ceil(reach / cell)) + 2),
      ranges_(static_cast<std::size_t>(Coverage::bins), open_range) {}

Unseen::Index Unseen::index_of(const glm::dvec2& position) const {
  return {static_cast<std::int32_t>(std::floor(position.x / cell_)), static_cast<std::int32_t>(std::floor(position.y / cell_))};
}

Unseen::Spot& Unseen::slot(Index index) {
  const auto wrapped = [this](std::int32_t i) { return (i % edge_ + edge_) % edge_; };
  Spot& spot = window_[static_cast<std::size_t>(wrapped(index.row) * edge_ + wrapped(index.column))];
  if (spot.column != index.column || spot.row != index.row) {
    spot = {};
    spot.column = index.column;
    spot.row = index.row;
  }
  return spot;
}

const Unseen::Spot* Unseen::find(Index index) const {
  if (window_.empty()) return nullptr;
  const auto wrapped = [this](std::int32_t i) { return (i % edge_ + edge_) % edge_; };
  const Spot& spot = window_[static_cast<std::size_t>(wrapped(index.row) * edge_ + wrapped(index.column))];
  return spot.column == index.column && spot.row == index.row ? &spot : nullptr;
}

void Unseen::fill_ranges(const Contour& contour) {
  constexpr float untold = -1.0F;
  std::fill(ranges_.begin(), ranges_.end(), untold);
  for (const ContourPoint& point : contour) {
    float& range = ranges_[static_cast<std::size_t>(Coverage::bin_of(point.bearing))];
    const auto distance = static_cast<float>(point.distance);
    range = range == untold ? distance : std::min(range, distance);
  }
  // Bearings between two beams are told by the nearer of their ranges; once around and a bit, for the beginning has its neighbour at the end.
  const auto bins = static_cast<std::size_t>(Coverage::bins);
  std::size_t last = bins;
  for (std::size_t k = 0; k < 2 * bins; ++k) {
    const std::size_t i = k % bins;
    if (ranges_[i] == untold) continue;
    if (last != bins && k > last + 1)
      for (std::size_t j = last + 1; j < k; ++j) ranges_[j % bins] = std::min(ranges_[last % bins], ranges_[i]);
    last = k;
  }
  if (last == bins) std::fill(ranges_.begin(), ranges_.end(), open_range);
}

void Unseen::look(const Contour& contour, const Pose2& pose, double time) {
  coverage_.read(contour);
  pose_ = pose;
  time_ = time;
  if (!has_gaps()) return;
  if (window_.empty()) window_.resize(static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_));
  fill_ranges(contour);
  const glm::dvec2 forward = direction(pose.yaw);
  const Index low = index_of(pose.position - reach_), high = index_of(pose.position + reach_);
  for (std::int32_t row = low.row; row <= high.row; ++row) {
    for (std::int32_t column = low.column; column <= high.column; ++column) {
      const glm::dvec2 offset = centre_of({column, row}) - pose.position;
      const double square = glm::dot(offset, offset);
      if (square > reach_ * reach_) continue;
      const double at = rough_bearing({forward.x * offset.x + forward.y * offset.y, forward.x * offset.y - forward.y * offset.x});
      if (!coverage_.covers(at)) continue;
      Spot& spot = slot({column, row});
      spot.seen = time;
      // A beam that goes on behind it met nothing there.
      if (std::sqrt(square) + cell_ < static_cast<double>(ranges_[static_cast<std::size_t>(Coverage::bin_of(at))])) spot.met = -1e300;
    }
  }
  for (const ContourPoint& point : contour) {
    if (point.distance > reach_ - cell_) continue;
    const glm::dvec2 matter = pose.to_outer(point.position);
    Spot& spot = slot(index_of(matter));
    spot.seen = spot.met = time;
    spot.matter = matter;
  }
}

void Unseen::complete(Contour& contour) const {
  if (!has_gaps()) return;
  for (const Spot& spot : window_) {
    if (time_ - spot.met > memory_ || spot.met == time_) continue;
    const glm::dvec2 at = pose_.to_inner(spot.matter);
    const double distance = glm::length(at), toward = bearing(at);
    if (distance <= reach_ && !coverage_.covers(toward)) contour.push_back({at, distance, toward, no_arc - 1});
  }
}

std::optional<double> Unseen::turn_to_see(double heading, double half_width, double hull, double length) const {
  if (!has_gaps()) return std::nullopt;
  /// What must be turned to see the unseen spots in a gap: into one direction its one side passes over them, into the other its other.
  struct Need {
    double least = infinite, most = 0.0;
    void add(double turn) {
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
  };
  Need nearest;
  double sense = 0.0;
  std::vector<std::array<Need, 2>> needs(coverage_.gaps().size());
  const glm::dvec2 along = direction(pose_.yaw + heading), left(-along.y, along.x);
  const double end = std::min(length, reach_ - half_width), step = 0.9 * cell_;
  // All spots of the rectangle that the robot comes over, and of the half disc at its end.
  for (double s = 0.0; s <= end + half_width; s += step) {
    const double beyond = std::max(0.0, s - end), width = beyond < half_width ? std::sqrt(half_width * half_width - beyond * beyond) : 0.0;
    for (double t = -std::floor(width / step) * step; t <= width; t += step) {
      if (s * s + t * t < (hull + cell_) * (hull + cell_) || in_view(find(index_of(pose_.position + s * along + t * left)))) continue;
      const double toward = heading + std::atan2(t, s);
      for (std::size_t g = 0; g < needs.size(); ++g) {
        const Coverage::Gap& gap = coverage_.gaps()[g];
        const double into = gap.width < 2.0 * pi ? std::remainder(toward - gap.from - 0.5 * gap.width, 2.0 * pi) + 0.5 * gap.width : pi;
        if (into <= 0.0 || into >= gap.width) continue;
        needs[g][0].add(into);
        needs[g][1].add(gap.width - into);
      }
    }
  }
  for (const auto& [counter_clockwise, clockwise] : needs) {
    if (counter_clockwise.least < nearest.least) nearest = counter_clockwise, sense = 1.0;
    if (clockwise.least < nearest.least) nearest = clockwise, sense = -1.0;
  }
  if (sense == 0.0) return std::nullopt;
  return sense * nearest.most;
}

}  // namespace thicket

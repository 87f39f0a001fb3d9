// How others make maps, in a few lines each, on the hall of map_work.hpp: what Thicket's map is held against. Grids hold the whole hall from the start.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <glm/common.hpp>

#include "map_work.hpp"
#include "thicket/base/probability_grid.hpp"

#ifdef THICKET_OCTOMAP
#include <octomap/octomap.h>
#endif

namespace thicket::map_work {

/// The cells of the hall.
struct Raster {
  explicit Raster(double cell_m) : cells(static_cast<int>(std::lround(2.0 * half_side / cell_m))), per_metre(1.0 / cell_m), resolution(cell_m) {}

  int cells;  ///< along an edge
  double per_metre, resolution;

  std::size_t count() const { return static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells); }
  int cell(double x) const { return std::clamp(static_cast<int>((x + half_side) * per_metre), 0, cells - 1); }
  double centre(int cell) const { return (cell + 0.5) * resolution - half_side; }
  int index(int column, int row) const { return row * cells + column; }

  /// Calls `visit(index)` for every cell of a line (Bresenham), both ends included, and returns the last one.
  template <class Visit>
  int walk(const glm::dvec2& from, const Reading& ray, Visit&& visit) const {
    const int column = cell(from.x), row = cell(from.y), to_column = cell(from.x + ray.range * std::cos(ray.bearing)), to_row = cell(from.y + ray.range * std::sin(ray.bearing));
    int at = index(column, row);
    const int columns = std::abs(to_column - column), rows = std::abs(to_row - row), sideways = to_column > column ? 1 : -1, upward = to_row > row ? cells : -cells;
    const bool flat = columns >= rows;
    const int many = flat ? columns : rows, few = flat ? rows : columns, step = flat ? sideways : upward, other = flat ? upward : sideways;
    for (int i = 0, error = many / 2; i < many; ++i) {
      visit(at);
      at += step;
      error += few;
      if (error >= many) {
        at += other;
        error -= many;
      }
    }
    visit(at);
    return at;
  }
  int end_of(const glm::dvec2& from, const Reading& ray) const { return index(cell(from.x + ray.range * std::cos(ray.bearing)), cell(from.y + ray.range * std::sin(ray.bearing))); }
};

/// Distinct cells under the rays of each step, added up: what times are stated per.
inline double distinct_cells(const std::vector<Step>& steps, double resolution) {
  const Raster raster(resolution);
  std::vector<int> seen(raster.count(), -1);
  double count = 0.0;
  for (int k = 0; k < static_cast<int>(steps.size()); ++k)
    for (const Reading& ray : steps[static_cast<std::size_t>(k)].rays)
      raster.walk(steps[static_cast<std::size_t>(k)].pose.position, ray, [&](int i) {
        int& last = seen[static_cast<std::size_t>(i)];
        count += last != k;
        last = k;
      });
  return count;
}

/// A lobe with one range, for mappers that know only rays: a fan of them, a degree apart.
inline Step as_fans(const Step& step, double width) {
  Step fans{step.pose, {}, {}};
  const int rays = static_cast<int>(std::lround(degrees(width)));
  for (const Reading& lobe : step.rays)
    for (int i = 0; i < rays; ++i) fans.rays.push_back({lobe.bearing + (i + 0.5) / rays * width - width / 2.0, lobe.range, lobe.hit});
  return fans;
}

/// As the obstacle layer of nav2: a byte a cell, overwritten by the last scan, first free along the rays and then occupied at their ends.
class OverwriteGrid {
 public:
  explicit OverwriteGrid(double resolution) : raster_(resolution), cells_(raster_.count(), 255) {}
  void integrate(const Step& step) {
    for (const Reading& ray : step.rays) raster_.walk(step.pose.position, ray, [this](int i) { cells_[static_cast<std::size_t>(i)] = 0; });
    for (const Reading& ray : step.rays)
      if (ray.hit) cells_[static_cast<std::size_t>(raster_.end_of(step.pose.position, ray))] = 254;
  }

 private:
  Raster raster_;
  std::vector<std::uint8_t> cells_;
};

/// Log-odds in a byte (units of 0.05) and a byte that tells in which scan the cell was last updated, so that a scan updates it once; occupied wins.
class EpochGrid {
 public:
  explicit EpochGrid(double resolution) : raster_(resolution), cells_(raster_.count()) {}
  void integrate(const Step& step) {
    if (++epoch_ == 0) {
      for (Cell& cell : cells_) cell.epoch = 0;
      epoch_ = 1;
    }
    for (const Reading& ray : step.rays)
      if (ray.hit) update(raster_.end_of(step.pose.position, ray), 17);
    for (const Reading& ray : step.rays) raster_.walk(step.pose.position, ray, [this](int i) { update(i, -8); });
  }

 private:
  struct Cell {
    std::int8_t log_odds = 0;
    std::uint8_t epoch = 0;
  };
  void update(int index, int change) {
    Cell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.epoch == epoch_) return;
    cell.epoch = epoch_;
    cell.log_odds = static_cast<std::int8_t>(std::clamp(cell.log_odds + change, -40, 70));
  }
  Raster raster_;
  std::uint8_t epoch_ = 0;
  std::vector<Cell> cells_;
};

/// What maps with probabilities have in common: log-odds in floats, for judgements and not for speed.
class LogOddsGrid {
 public:
  explicit LogOddsGrid(double resolution) : raster_(resolution), log_odds_(raster_.count()), known_(raster_.count()), scan_of_(raster_.count(), -1) {}

  /// Plain log-odds with OctoMap's numbers (0.7, 0.4, clamps 0.1192 and 0.971): each cell once a scan, occupied wins.
  void integrate(const Step& step) {
    ++scan_;
    for (const Reading& ray : step.rays)
      if (ray.hit) update(raster_.end_of(step.pose.position, ray), hit, -2.0f, 3.5f);
    for (const Reading& ray : step.rays) raster_.walk(step.pose.position, ray, [this](int i) { update(i, miss, -2.0f, 3.5f); });
  }

  /// The rule of Billdal 2018, as plain as can be: of every cell in a lobe, +17 within 2 sigma of the range at its azimuth and -8 before it, in units of 0.05, between -40 and 70. `naive` on purpose: an
  /// arc tangent a cell. `rays` are the lobe's, over `width` about `axis`. Returns how many cells it touched.
  std::size_t integrate_lobe(const glm::dvec2& from, double axis, double width, const Reading* rays, int ray_count, double range_max, double sigma) {
    ++scan_;
    // The rectangle that holds the sector as far as it says anything.
    double reach = 0.0;
    for (int i = 0; i < ray_count; ++i) reach = std::max(reach, std::min(range_max, rays[i].range + 2.0 * sigma));
    glm::dvec2 low = from, high = from;
    const auto hold = [&](double bearing) {
      low = glm::min(low, from + reach * direction(bearing));
      high = glm::max(high, from + reach * direction(bearing));
    };
    hold(axis - width / 2.0);
    hold(axis + width / 2.0);
    for (int i = 0; i < 4; ++i)
      if (std::abs(std::remainder(i * pi / 2.0 - axis, 2.0 * pi)) < width / 2.0) hold(i * pi / 2.0);
    const float half_turn = static_cast<float>(pi), axis_at = static_cast<float>(std::remainder(axis, 2.0 * pi)), half_width = static_cast<float>(width / 2.0), range_most = static_cast<float>(range_max);
    const float per_radian = static_cast<float>(ray_count) / static_cast<float>(width) * 0.999999f;
    std::size_t touched = 0;
    for (int row = raster_.cell(low.y); row <= raster_.cell(high.y); ++row)
      for (int column = raster_.cell(low.x); column <= raster_.cell(high.x); ++column) {
        const float x = static_cast<float>(raster_.centre(column) - from.x), y = static_cast<float>(raster_.centre(row) - from.y), range = std::sqrt(x * x + y * y);
        if (range > range_most) continue;
        float off = std::atan2(y, x) - axis_at;
        off = off > half_turn ? off - 2.0f * half_turn : off < -half_turn ? off + 2.0f * half_turn : off;
        if (std::abs(off) >= half_width) continue;
        const Reading& ray = rays[static_cast<int>((off + half_width) * per_radian)];
        if (range < ray.range - 2.0 * sigma) {
          update(raster_.index(column, row), -0.4f, -2.0f, 3.5f);
        } else if (ray.hit && range <= ray.range + 2.0 * sigma) {
          update(raster_.index(column, row), 0.85f, -2.0f, 3.5f);
        } else {
          continue;
        }
        ++touched;
      }
    return touched;
  }
  /// The same for all lobes of a step, which may have one range or a range for each azimuth.
  std::size_t integrate_lobes(const Step& step, const Instrument& instrument) {
    const int per_lobe = instrument.one_range ? 1 : instrument.rays;
    std::size_t touched = 0;
    for (int lobe = 0; lobe < instrument.lobes; ++lobe)
      touched += integrate_lobe(step.pose.position, step.pose.yaw + lobe * pi / 2.0, instrument.width, step.rays.data() + lobe * per_lobe, per_lobe, instrument.range_max, instrument.sigma);
    return touched;
  }

  ProbabilityGrid to_probabilities() const {
    ProbabilityGrid grid{raster_.cells, raster_.cells, raster_.resolution, {-half_side, -half_side}, {}, {}};
    for (std::size_t i = 0; i < log_odds_.size(); ++i) grid.probability.push_back(known_[i] ? 1.0f / (1.0f + std::exp(-log_odds_[i])) : ProbabilityGrid::unknown);
    return grid;
  }

 private:
  static inline const float hit = std::log(0.7f / 0.3f), miss = std::log(0.4f / 0.6f);
  void update(int index, float change, float low, float high) {
    const auto i = static_cast<std::size_t>(index);
    if (scan_of_[i] == scan_) return;
    scan_of_[i] = scan_;
    known_[i] = 1;
    log_odds_[i] = std::clamp(log_odds_[i] + change, low, high);
  }
  Raster raster_;
  std::vector<float> log_odds_;
  std::vector<std::uint8_t> known_;
  std::vector<int> scan_of_;
  int scan_ = -1;
};

#ifdef THICKET_OCTOMAP
/// OctoMap itself, in the plane z = 0, with its own defaults.
class OctoMapPeer {
 public:
  explicit OctoMapPeer(double resolution, double range_max) : tree_(resolution), range_max_(range_max), resolution_(resolution) {}
  void integrate(const Step& step) {
    octomap::Pointcloud cloud;
    const glm::dvec2 at = step.pose.position;
    for (const Reading& ray : step.rays) {
      const double range = ray.hit ? ray.range : 1.01 * range_max_;  // past the range it is only free
      cloud.push_back(static_cast<float>(at.x + range * std::cos(ray.bearing)), static_cast<float>(at.y + range * std::sin(ray.bearing)), 0.0f);
    }
    tree_.insertPointCloud(cloud, octomap::point3d(static_cast<float>(at.x), static_cast<float>(at.y), 0.0f), range_max_);
  }
  ProbabilityGrid to_probabilities() const {
    const Raster raster(resolution_);
    ProbabilityGrid grid{raster.cells, raster.cells, resolution_, {-half_side, -half_side}, {}, {}};
    for (int row = 0; row < raster.cells; ++row)
      for (int column = 0; column < raster.cells; ++column) {
        const octomap::OcTreeNode* node = tree_.search(raster.centre(column), raster.centre(row), 0.5 * resolution_);
        grid.probability.push_back(node ? static_cast<float>(node->getOccupancy()) : ProbabilityGrid::unknown);
      }
    return grid;
  }

 private:
  octomap::OcTree tree_;
  double range_max_, resolution_;
};
#endif

}  // namespace thicket::map_work

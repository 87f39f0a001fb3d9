// What one scan says of a map's cells, slowly and in the plainest way: for every beam every cell of a rectangle is asked what the beam says of it, by the formula that docs/mapping.md and the comments of
// nav/map/sensor_model.hpp state. The map's own integrators, which are made to be fast, are held against it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "thicket/nav/occupancy_map.hpp"

namespace thicket {

/// What a scan says of a cell, in 1/32 nat. Where the plain rule has a step (a corner of a cell that a beam hardly meets, evidence that is just enough to be told), either side of it will do: from `low` to `high`.
struct Said {
  static constexpr int nothing = -1000;
  int low = nothing, high = nothing;
  int least = 1000;              ///< the least that any beam may say, nothing apart
  bool through = false;          ///< a beam passed it inside of matter
  bool perhaps_through = false;  ///< or just touched it there

  bool sure() const { return low == high && through == perhaps_through; }
  /// Where several beams say something the greatest counts.
  void say(int lower, int upper) {
    low = std::max(low, lower);
    high = std::max(high, upper);
    least = std::min(least, lower != nothing ? lower : upper);
  }
  void say(int evidence, bool sure) { say(sure ? evidence : nothing, evidence); }
};

class SlowScan {
 public:
  /// `before`: the map before the scan.
  SlowScan(const MapSpec& spec, const Scan& scan, const Pose& vehicle, const OccupancyMap& before)
      : spec_(spec), before_(before), hit_(units(spec.probability_hit)), miss_(units(spec.probability_miss)), unseen_(static_cast<int>(std::lround(32.0 * std::log(1.0 - spec.probability_detection)))) {
    const Pose sensor = vehicle * Pose{scan.mount_position, scan.mount_orientation};
    const double sigma = spec.range_sigma_m.value_or(scan.range_noise);
    double reach = 0.0;
    for (const Beam& beam : scan.beams) {
      reach = std::max(reach, beam.sensed_range);
      for (const Echo& echo : scan.echoes_of(beam)) reach = std::max(reach, echo.range);
    }
    reach += 2.0 * sigma + 3.0 * spec.resolution_m;
    low = before.cell_at(glm::dvec2(sensor.position) - reach);
    high = before.cell_at(glm::dvec2(sensor.position) + reach);
    width_ = high.column - low.column + 1;
    said_.resize(static_cast<std::size_t>(width_ * (high.row - low.row + 1)));
    from_ = glm::dvec2(sensor.position) / spec.resolution_m - glm::dvec2(static_cast<double>(low.column), static_cast<double>(low.row));
    sigma_ = sigma / spec.resolution_m;
    for (const Beam& beam : scan.beams) {
      const glm::dvec2 along(sensor.orientation * beam.direction);  // of a beam that climbs or falls, its plan
      along_ = glm::normalize(along);
      std::vector<Echo> echoes(scan.echoes_of(beam).begin(), scan.echoes_of(beam).end());
      for (Echo& echo : echoes) echo.range *= glm::length(along) / spec.resolution_m;
      Beam plan = beam;
      plan.sensed_range *= glm::length(along) / spec.resolution_m;
      if (scan.azimuth_opening > 0.0) lobe(plan, echoes, scan.azimuth_opening);
      else thin_beam(plan, echoes);
    }
  }

  CellIndex low, high;  ///< all that the scan may say anything of lies between, both included
  const Said& at(const CellIndex& cell) const { return said_[static_cast<std::size_t>((cell.row - low.row) * width_ + cell.column - low.column)]; }

 private:
  // Distances are in cells from here on.
  static constexpr double on_border = 0.01;  // a face this near to a border of cells is matter in the cell behind it
  static constexpr double touch = 1e-5;      // shorter than this a beam hardly meets a cell
  static constexpr double told = 0.33;       // so far off may a logarithm be where evidence is just enough, ...
  static constexpr double small = 0.03;     // ... or just not nothing
  static constexpr double table = 0.07;     // ... by a table of logarithms that is good to a sixteenth of a unit

  static int units(double probability) { return static_cast<int>(std::lround(32.0 * std::log(probability / (1.0 - probability)))); }

  template <class Use>
  void for_cells(Use&& use) {
    for (std::int64_t row = 0; row <= high.row - low.row; ++row)
      for (std::int64_t column = 0; column < width_; ++column) use(column, row, said_[static_cast<std::size_t>(row * width_ + column)]);
  }
  double odds(std::int64_t column, std::int64_t row) const {
    const CellView view = before_.view({low.column + column, low.row + row});
    return view.known ? view.probability / (1.0 - view.probability) : 1.0;
  }

  struct Chord {
    double enters, leaves;
    double length() const { return leaves - enters; }
  };
  /// The part from `begin` to `end` of the beam that lies in a cell: between two lines across and between two lines along.
  std::optional<Chord> chord(std::int64_t column, std::int64_t row, double begin, double end) const {
    Chord c{begin, end};
    const double corner[] = {static_cast<double>(column), static_cast<double>(row)}, at[] = {from_.x, from_.y}, d[] = {along_.x, along_.y};
    for (int k = 0; k < 2; ++k) {
      const double first = (corner[k] - at[k]) / d[k], second = (corner[k] + 1.0 - at[k]) / d[k];
      c.enters = std::max(c.enters, std::min(first, second));
      c.leaves = std::min(c.leaves, std::max(first, second));
    }
    // A little less than nothing is told too: a corner that is just missed.
    return c.length() > -touch ? std::optional(c) : std::nullopt;
  }
  void say_along(double begin, double end, int evidence, bool through) {
    if (end <= begin) return;
    for_cells([&](std::int64_t column, std::int64_t row, Said& said) {
      const auto c = chord(column, row, begin, end);
      if (!c) return;
      const bool sure = c->length() > touch;
      said.say(evidence, sure);
      said.perhaps_through |= through;
      said.through |= through && sure;
    });
  }

  void thin_beam(const Beam& beam, const std::vector<Echo>& echoes) {
    const bool sure = sigma_ < 0.5;  // then an echo is in its cell
    const double end = beam.sensed_range - (beam.end == BeamEnd::stopped ? on_border : 0.0);
    bool inside = beam.starts_inside;
    for (std::size_t i = 0; i <= echoes.size(); ++i) {
      // Before each echo, and to the end: through the open or through matter.
      const double begin = i == 0 ? 0.0 : echoes[i - 1].range + (sure || inside ? on_border : 0.0);
      if (i == echoes.size()) {
        say_along(begin, end, miss_, inside);
        return;
      }
      const double at = echoes[i].range;
      say_along(begin, sure || inside ? at - on_border : at - 2.0 * sigma_, miss_, inside);
      inside = echoes[i].edge == Edge::front || echoes[i].edge == Edge::inner;
      if (!sure) {
        unsure(at);
      } else if (inside) {
        // Half a cell behind its face there is matter too, unless the next face comes first.
        const double most = i + 1 < echoes.size() ? std::min(at + 0.5, echoes[i + 1].range - on_border) : at + 0.5;
        say_along(at + on_border, std::max(most, at + 2.0 * on_border), hit_, false);
      } else {
        const double point = echoes[i].edge == Edge::back ? at - on_border : at + on_border;
        say_along(point - 0.9 * touch, point + 0.9 * touch, hit_, false);
      }
    }
  }

  /// An echo that may come from any cell of the beam within two sigma.
  void unsure(double at) {
    struct Cell {
      Said* said;
      Chord chord;
      double odds, here;
    };
    std::vector<Cell> cells;
    for_cells([&](std::int64_t column, std::int64_t row, Said& said) {
      if (const auto c = chord(column, row, std::max(0.0, at - 2.0 * sigma_), at + 2.0 * sigma_)) cells.push_back({&said, *c, odds(column, row), 0.0});
    });
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.chord.enters < b.chord.enters; });
    double all = 0.0;
    for (Cell& c : cells) {
      const double off = (0.5 * (c.chord.enters + c.chord.leaves) - at) / sigma_;
      c.here = std::max(0.0, c.chord.length()) * c.odds * std::exp(-0.5 * off * off);
      all += c.here;
    }
    double nearer = 0.0;
    for (Cell& c : cells) {
      c.here /= all;
      // It is this one; or the echo is from farther on, and the beam went through; or it is from nearer, and nothing is said.
      const double farther = std::max(0.0, 1.0 - c.here - nearer), as_before = c.odds / (1.0 + c.odds), missed_odds = c.odds * std::exp(miss_ / 32.0), missed = missed_odds / (1.0 + missed_odds);
      const double after = std::min(c.here + farther * missed + nearer * as_before, 1.0 - 1e-12);
      const double evidence = std::clamp(32.0 * (std::log(after / (1.0 - after)) - std::log(c.odds)), static_cast<double>(miss_), static_cast<double>(hit_));
      // (The map takes what was known to 1/32 nat, of 16 bits too: shares may be off by a hundredth.)
      // Half a nat and more counts, as a third of one; less is only known to be no more free than it was, if the echo is as likely to come from here or farther on.
      const int much = 10, little = nearer < 0.5 ? 0 : Said::nothing, whole = static_cast<int>(std::lround(evidence));
      const int now = whole >= 16 ? much : whole < 0 ? whole : little;
      int least = now, most = now;
      const auto or_also = [&](int other) { least = std::min(least, other), most = std::max(most, other); };
      if (std::abs(evidence - 15.5) < told) or_also(much), or_also(little);
      if (std::abs(evidence + 0.5) < table) or_also(-1), or_also(little);
      if (std::abs(nearer - 0.5) < 0.01 && whole > -1 && whole < 16) or_also(0), or_also(Said::nothing);
      if (c.chord.length() < touch) or_also(Said::nothing);
      c.said->say(least, most);
      nearer += c.here;
    }
  }

  void lobe(const Beam& beam, const std::vector<Echo>& echoes, double opening) {
    const double spread = std::max(0.5, sigma_), axis = std::atan2(along_.y, along_.x);
    const double echo = echoes.empty() ? INFINITY : echoes.front().range, clear = std::min(beam.sensed_range, echo - 2.0 * spread);
    struct Cell {
      Said* said;
      double odds, likelihood;
      bool sure;
    };
    std::vector<Cell> arc;
    double all = 0.0;
    for_cells([&](std::int64_t column, std::int64_t row, Said& said) {
      const glm::dvec2 off = glm::dvec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5) - from_;
      const double distance = glm::length(off), aside = std::abs(std::remainder(std::atan2(off.y, off.x) - axis, 2.0 * pi)) - 0.5 * opening;
      if (aside * distance > touch) return;
      const bool at_side = std::abs(aside) * distance < touch, at_clear = std::abs(distance - clear) < touch, at_end = std::abs(std::abs(distance - echo) - 2.0 * spread) < 1e-3 * spread;
      const bool sure = !at_side && !at_clear && !at_end;
      // Free is what lies before the echo, in the share of the opening whose silence counts.
      const double aside_of_share = (aside + 0.5 * opening - 0.5 * spec_.lobe_share * opening) * distance;
      if (distance <= clear + touch && aside_of_share < touch) said.say(unseen_, sure && aside_of_share < -touch);
      const double sigmas = (distance - echo) / spread;
      if (distance <= clear - touch || std::abs(sigmas) > 2.0 + touch) return;
      const double before = odds(column, row);
      arc.push_back({&said, before, before * std::exp(-0.5 * sigmas * sigmas), sure});
      all += arc.back().likelihood;
    });
    for (const Cell& c : arc) {
      // It is the one that gave the echo, or else it is what it was.
      const double is_it = std::min(c.likelihood / all, 1.0 - 1e-12), as_before = c.odds / (1.0 + c.odds), after = is_it + (1.0 - is_it) * as_before;
      const double evidence = std::min(32.0 * (std::log(after / (1.0 - after)) - std::log(c.odds)), static_cast<double>(hit_));
      const int whole = static_cast<int>(std::lround(evidence));
      // What is less than half of the least that counts is not told.
      if (std::abs(evidence - 0.5) < small) c.said->say(Said::nothing, 1);
      else if (whole > 0) c.said->say(whole, c.sure);
    }
  }

  MapSpec spec_;
  const OccupancyMap& before_;
  int hit_, miss_, unseen_;
  std::int64_t width_ = 0;
  std::vector<Said> said_;
  glm::dvec2 from_{0.0}, along_{1.0, 0.0};
  double sigma_ = 0.0;
};

}  // namespace thicket

// The work that mappers are measured on, ours and others: a hall of 50 x 50 m with four walls and 18 boxes, a way of 141 m through it, and what sensors tell along it. Every number is drawn as in
// the programs that measured the peers (docs/mapping.md), so that figures can be laid side by side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::map_work {

inline constexpr double half_side = 25.0;  // m, of the hall
inline constexpr int pose_count = 200;

struct Block {
  double x0, y0, x1, y1;  ///< m
  /// Of a point outside; 0 inside.
  double distance(const glm::dvec2& p) const { return std::hypot(std::max({x0 - p.x, 0.0, p.x - x1}), std::max({y0 - p.y, 0.0, p.y - y1})); }
};

/// A figure of eight.
inline std::vector<Pose2> way(int count = pose_count) {
  std::vector<Pose2> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 2.0 * pi * i / count;
    poses.push_back({{18.0 * std::sin(t) + 0.0123, 14.0 * std::sin(2.0 * t) + 0.0077}, std::atan2(28.0 * std::cos(2.0 * t), 18.0 * std::cos(t))});
  }
  return poses;
}

struct Hall {
  std::vector<Block> blocks;

  /// Range of the nearest block, m; infinite if there is none. The sensor stands in the open.
  double cast(const glm::dvec2& from, double bearing) const {
    const double c = std::cos(bearing), s = std::sin(bearing);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Block& b : blocks) {
      const auto [x_in, x_out] = std::minmax({(b.x0 - from.x) / c, (b.x1 - from.x) / c});
      const auto [y_in, y_out] = std::minmax({(b.y0 - from.y) / s, (b.y1 - from.y) / s});
      const double in = std::max(x_in, y_in), out = std::min(x_out, y_out);
      if (in <= out && in > 0.0) nearest = std::min(nearest, in);
    }
    return nearest;
  }
  double distance(const glm::dvec2& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Block& b : blocks) least = std::min(least, b.distance(p));
    return least;
  }
  /// The same in Thicket's own terms.
  World world() const {
    World world;
    world.materials.push_back({"wall", 0.5, std::numeric_limits<double>::infinity(), 1.0, true, true});
    for (const Block& b : blocks) world.solids.push_back({"block", 0, {0.5 * (b.x0 + b.x1), 0.5 * (b.y0 + b.y1), 1.0}, 0.0, Box{{b.x1 - b.x0, b.y1 - b.y0, 2.0}}});
    return world;
  }
  Result<TruthGrid> truth(double resolution, Convention convention) const {
    return occupancy(world(), {-half_side, -half_side}, {half_side, half_side}, resolution, 1.0, 1.0, convention, false);
  }
};

inline Hall hall() {
  constexpr double inner = 24.6, outer = half_side, free_way = 0.8;
  Hall hall{{{-outer, -outer, outer, -inner}, {-outer, inner, outer, outer}, {-outer, -outer, -inner, outer}, {inner, -outer, outer, outer}}};
  const std::vector<Pose2> fine_way = way(2000);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> place(-22.0, 22.0), size(0.4, 4.0);
  while (hall.blocks.size() < 4 + 18) {
    const double x = place(engine), y = place(engine), half_x = size(engine) / 2.0, half_y = size(engine) / 2.0;
    const Block b{x - half_x, y - half_y, x + half_x, y + half_y};
    const bool in_the_way = std::any_of(fine_way.begin(), fine_way.end(), [&](const Pose2& p) {
      return p.position.x > b.x0 - free_way && p.position.x < b.x1 + free_way && p.position.y > b.y0 - free_way && p.position.y < b.y1 + free_way;
    });
    if (!in_the_way) hall.blocks.push_back(b);
  }
  return hall;
}

/// What is measured with.
struct Instrument {
  std::string name;
  int lobes;         ///< a right angle apart, the first one looks ahead
  int rays;          ///< of each lobe
  double width;      ///< rad, of a lobe
  double range_max;  ///< m
  double sigma;      ///< m, of ranges
  bool one_range = false;  ///< a lobe tells only the range of the nearest thing in it; `rays` is how finely it is looked for

  static Instrument radar4x58() { return {"radar4x58", 4, 58, radians(58.0), 20.0, 0.15}; }
  static Instrument lidar360() { return {"lidar360", 1, 360, 2.0 * pi, 10.0, 0.02}; }
  static Instrument lidar1440() { return {"lidar1440", 1, 1440, 2.0 * pi, 30.0, 0.02}; }
  /// Four lobes as Billdal 2018 flew them: 65 degrees, 10 m, one range each.
  static Instrument lobe2018() { return {"lobe2018", 4, 260, radians(65.0), 10.0, 0.15, true}; }
  /// Of the opening and range of radar4x58, for the time that an area takes.
  static Instrument lobe58() { return {"lobe58", 4, 232, radians(58.0), 20.0, 0.15, true}; }
};

/// A range in a direction; of an instrument with one range, of a lobe about that direction.
struct Reading {
  double bearing;  ///< rad, in the world
  double range;    ///< m; of a ray without a return the range of the instrument
  bool hit;
};

/// What an instrument tells at a pose. As rays for peers, as scans for Thicket's map: one of all rays, or one a lobe where lobes have one range.
struct Step {
  Pose2 pose;
  std::vector<Reading> rays;
  std::vector<Scan> scans;

  Pose pose_in_space() const { return Pose::planar(pose.position.x, pose.position.y, 1.0, pose.yaw); }
};

struct Trial {
  bool still = false;      ///< all scans from the first pose of the way
  bool identical = false;  ///< the noise (and clutter) of the first scan in all others
  double clutter = 0.0;    ///< chance of a ray of a false return at any range, nearer than the true one
};

/// Makes one step after another, for ever; on the way round and round.
class Source {
 public:
  Source(Instrument instrument, Trial trial) : Source(std::move(instrument), trial, map_work::hall(), map_work::way()) {}
  /// In another hall, on another way.
  Source(Instrument instrument, Trial trial, Hall place, std::vector<Pose2> way) : hall(std::move(place)), instrument_(std::move(instrument)), trial_(trial), way_(std::move(way)), noise_(0.0, instrument_.sigma) {}

  Hall hall;  ///< may be changed between steps, with `changed`
  const Instrument& instrument() const { return instrument_; }
  void changed() { true_ranges_.clear(); }

  Step next() {
    Step step;
    step.pose = way_[trial_.still ? 0 : count_ % way_.size()];
    const int told = instrument_.lobes * (instrument_.one_range ? 1 : instrument_.rays);
    if (!trial_.still || true_ranges_.empty()) look(step.pose);
    const bool first = count_ == 0;
    for (int i = 0; i < told; ++i) {
      const auto at = static_cast<std::size_t>(i);
      double noise = noise_(noise_engine_), chance = 1.0, place = 0.0;
      if (trial_.clutter > 0.0) {
        chance = unit_(clutter_engine_);
        place = unit_(clutter_engine_);
      }
      if (trial_.identical && first) frozen_.push_back({noise, chance, place});
      if (trial_.identical) noise = frozen_[at].noise, chance = frozen_[at].chance, place = frozen_[at].place;
      double range = true_ranges_[at] + noise;
      if (chance < trial_.clutter) range = std::min(range, 0.5 + place * (instrument_.range_max - 0.5));
      const bool hit = range <= instrument_.range_max;
      step.rays.push_back({std::remainder(step.pose.yaw + azimuth(i), 2.0 * pi), hit ? std::max(0.05, range) : instrument_.range_max, hit});
    }
    add_scans(step);
    ++count_;
    return step;
  }

 private:
  struct Frozen {
    double noise, chance, place;
  };
  double axis(int lobe) const { return lobe * pi / 2.0; }
  double in_lobe(int ray) const { return (ray + 0.5) / instrument_.rays * instrument_.width - instrument_.width / 2.0; }
  double azimuth(int told) const { return instrument_.one_range ? axis(told) : axis(told / instrument_.rays) + in_lobe(told % instrument_.rays); }

  void look(const Pose2& pose) {
    true_ranges_.clear();
    for (int lobe = 0; lobe < instrument_.lobes; ++lobe) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int ray = 0; ray < instrument_.rays; ++ray) {
        const double range = hall.cast(pose.position, std::remainder(pose.yaw + axis(lobe) + in_lobe(ray), 2.0 * pi));
        if (!instrument_.one_range) true_ranges_.push_back(range);
        nearest = std::min(nearest, range);
      }
      if (instrument_.one_range) true_ranges_.push_back(nearest);
    }
  }

  void add_scans(Step& step) const {
    for (int i = 0; i < static_cast<int>(step.rays.size()); ++i) {
      if (step.scans.empty() || instrument_.one_range) {
        Scan scan;
        scan.number = count_;
        scan.time = 0.1 * static_cast<double>(count_);
        scan.range_max = instrument_.range_max;
        scan.range_noise = instrument_.sigma;
        if (instrument_.one_range) {
          scan.sensor = static_cast<std::uint16_t>(i);
          scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, azimuth(i)).orientation;
          scan.azimuth_opening = instrument_.width;
        }
        step.scans.push_back(std::move(scan));
      }
      const Reading& ray = step.rays[static_cast<std::size_t>(i)];
      Scan& scan = step.scans.back();
      Beam beam;
      beam.azimuth = instrument_.one_range ? 0.0 : azimuth(i);
      beam.direction = {std::cos(beam.azimuth), std::sin(beam.azimuth), 0.0};
      beam.sensed_range = ray.range;
      beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
      beam.echo_count = ray.hit;
      beam.end = ray.hit ? BeamEnd::stopped : BeamEnd::open;
      scan.beams.push_back(beam);
      if (ray.hit) scan.echoes.push_back({.range = ray.range, .amplitude = 1.0f});
    }
  }

  Instrument instrument_;
  Trial trial_;
  std::vector<Pose2> way_;
  std::mt19937 noise_engine_{11}, clutter_engine_{99};
  std::normal_distribution<double> noise_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  std::vector<double> true_ranges_;
  std::vector<Frozen> frozen_;
  std::uint64_t count_ = 0;
};

/// Once along the whole way.
inline std::vector<Step> steps(const Instrument& instrument) {
  Source source(instrument, {});
  std::vector<Step> list;
  for (int i = 0; i < pose_count; ++i) list.push_back(source.next());
  return list;
}

}  // namespace thicket::map_work

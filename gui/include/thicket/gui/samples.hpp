// A run's numbers over time: the trail in the plan, and the plots.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "thicket/sim/simulation.hpp"

namespace thicket::gui {

/// One step of a run.
struct Sample {
  std::uint64_t step = 0;
  double time = 0.0;  ///< s
  Pose2 pose, estimate;
  double speed = 0.0, turn_rate = 0.0;  ///< m/s, rad/s
  double clearance = std::numeric_limits<double>::infinity();       ///< m, as last looked for
  double nearest_bumper = std::numeric_limits<double>::infinity();  ///< m
  double goal_distance = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN without a goal
  double path_length = 0.0;                                         ///< m
};
Sample sample_of(const Simulation& simulation);

/// A number that can be plotted.
struct Channel {
  const char* name;
  const char* unit;
  double (*of)(const Sample&);
};
std::span<const Channel> channels();

/// Samples by increasing step. A copy shares all full chunks.
class Samples {
 public:
  static constexpr std::size_t chunk_size = 1024;

  void add(const Sample& sample);
  /// Forgets those after a step.
  void keep_until(std::uint64_t step);
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Sample& operator[](std::size_t i) const { return (*chunks_[i / chunk_size])[i % chunk_size]; }
  /// Samples i * chunk_size and those after it. Once it is full it never changes: other samples are in another chunk, for as long as somebody holds this one.
  std::shared_ptr<const std::vector<Sample>> chunk(std::size_t i) const { return chunks_[i]; }
  const Sample& back() const { return (*this)[size_ - 1]; }
  /// How many have a step up to this.
  std::size_t count_until(std::uint64_t step) const;

 private:
  using Chunk = std::vector<Sample>;
  std::vector<std::shared_ptr<Chunk>> chunks_;  ///< the last may be shared by copies, which do not look past their own size
  std::size_t size_ = 0;
};

}  // namespace thicket::gui

// The least and the most of a channel in every column of a plot, without looking at every sample each time. Private to the room.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "axes.hpp"

namespace thicket::gui {

/// Of one channel. Chunks of samples never change once they are full, so what is known of them is kept until they are others.
class Extremes {
 public:
  explicit Extremes(double (*of)(const Sample&)) : of_(of) {}

  /// Of samples first ... last - 1; empty if none is finite.
  Range between(const Samples& samples, std::size_t first, std::size_t last);

 private:
  static constexpr std::size_t block = 16;
  struct Chunk {
    std::shared_ptr<const std::vector<Sample>> samples;  ///< that the ranges are of
    std::array<Range, Samples::chunk_size / block> ranges;
    Range all;
  };
  const Chunk* full_chunk(const Samples& samples, std::size_t number);

  double (*of_)(const Sample&);
  std::vector<Chunk> chunks_;
};

/// The first sample at or after a time, looked for from one that is before it; found the faster the nearer that is.
std::size_t first_at(const Samples& samples, double time, std::size_t from = 0);

}  // namespace thicket::gui

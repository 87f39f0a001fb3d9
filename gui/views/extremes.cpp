#include "extremes.hpp"

#include <algorithm>

namespace thicket::gui {
namespace {

void join(Range& range, const Range& other) {
  range.low = std::min(range.low, other.low);
  range.high = std::max(range.high, other.high);
}

}  // namespace

const Extremes::Chunk* Extremes::full_chunk(const Samples& samples, std::size_t number) {
  if ((number + 1) * Samples::chunk_size > samples.size()) return nullptr;
  if (chunks_.size() <= number) chunks_.resize(number + 1);
  Chunk& chunk = chunks_[number];
  if (auto now = samples.chunk(number); chunk.samples != now) {
    chunk.samples = std::move(now);
    chunk.all = Range();
    for (std::size_t b = 0; b < chunk.ranges.size(); ++b) {
      chunk.ranges[b] = Range();
      for (std::size_t i = b * block; i < (b + 1) * block; ++i) chunk.ranges[b].hold(of_((*chunk.samples)[i]));
      join(chunk.all, chunk.ranges[b]);
    }
  }
  return &chunk;
}

Range Extremes::between(const Samples& samples, std::size_t first, std::size_t last) {
  Range range;
  last = std::min(last, samples.size());
  for (std::size_t i = first; i < last;) {
    const std::size_t number = i / Samples::chunk_size, begin = number * Samples::chunk_size, end = std::min(last, begin + Samples::chunk_size);
    const Chunk* chunk = end - i >= block ? full_chunk(samples, number) : nullptr;
    if (chunk && end - i == Samples::chunk_size) {
      join(range, chunk->all);
      i = end;
    }
    while (i < end) {
      if (chunk && i % block == 0 && i + block <= end) {
        join(range, chunk->ranges[(i - begin) / block]);
        i += block;
      } else {
        range.hold(of_(samples[i++]));
      }
    }
  }
  return range;
}

std::size_t first_at(const Samples& samples, double time, std::size_t from) {
  std::size_t low = std::min(from, samples.size()), high = low;
  for (std::size_t stride = 1; high < samples.size() && samples[high].time < time; stride *= 2) {
    low = high + 1;
    high = std::min(samples.size(), high + stride);
  }
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (samples[middle].time < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

}  // namespace thicket::gui

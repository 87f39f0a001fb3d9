#include "thicket/gui/samples.hpp"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

namespace thicket::gui {

Sample sample_of(const Simulation& s) {
  Sample sample;
  sample.step = s.steps();
  sample.time = s.time();
  sample.pose = s.vehicle().pose;
  sample.estimate = s.estimate();
  sample.speed = s.vehicle().speed;
  sample.turn_rate = s.vehicle().turn_rate;
  sample.clearance = s.clearance().distance;
  sample.nearest_bumper = s.bumpers().nearest();
  if (const auto& goal = s.mission().planner.goal_m) sample.goal_distance = glm::distance(sample.pose.position, *goal);
  sample.path_length = s.totals().path_length;
  return sample;
}

std::span<const Channel> channels() {
  static constexpr std::array list{
      Channel{"speed", "m/s", [](const Sample& s) { return s.speed; }},
      Channel{"turn rate", "deg/s", [](const Sample& s) { return degrees(s.turn_rate); }},
      Channel{"clearance", "m", [](const Sample& s) { return s.clearance; }},
      Channel{"nearest bumper", "m", [](const Sample& s) { return s.nearest_bumper; }},
      Channel{"distance to goal", "m", [](const Sample& s) { return s.goal_distance; }},
      Channel{"path length", "m", [](const Sample& s) { return s.path_length; }},
      Channel{"x", "m", [](const Sample& s) { return s.pose.position.x; }},
      Channel{"y", "m", [](const Sample& s) { return s.pose.position.y; }},
      Channel{"heading", "deg", [](const Sample& s) { return degrees(s.pose.yaw); }},
      Channel{"error of the estimate", "m", [](const Sample& s) { return glm::distance(s.pose.position, s.estimate.position); }},
  };
  return list;
}

void Samples::add(const Sample& sample) {
  const std::size_t at = size_ % chunk_size;
  if (at == 0) {
    chunks_.resize(size_ / chunk_size);
    chunks_.push_back(std::make_shared<Chunk>());
    chunks_.back()->reserve(chunk_size);
  } else if (chunks_.back()->size() != at || chunks_.back().use_count() > 1) {
    // A copy reads it in another thread, or wrote on in its own way.
    auto own = std::make_shared<Chunk>();
    own->reserve(chunk_size);
    own->assign(chunks_.back()->begin(), chunks_.back()->begin() + static_cast<std::ptrdiff_t>(at));
    chunks_.back() = std::move(own);
  }
  chunks_.back()->push_back(sample);
  ++size_;
}

void Samples::keep_until(std::uint64_t step) {
  size_ = count_until(step);
  chunks_.resize((size_ + chunk_size - 1) / chunk_size);
}

std::size_t Samples::count_until(std::uint64_t step) const {
  std::size_t low = 0, high = size_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if ((*this)[middle].step <= step) low = middle + 1;
    else high = middle;
  }
  return low;
}

}  // namespace thicket::gui

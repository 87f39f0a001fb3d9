#include "surroundings.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr std::uint16_t none = 0xffff;
constexpr double memory = 5.0;       // s
constexpr double most_weight = 20.0; // of an average: it follows a robot whose own pose drifts
constexpr double shut_radius = 0.15; // of keep: hidden in the corner that two grown discs make, but for passages that are open by a finger's breadth
constexpr double one_passage = 0.8;  // of keep: gates nearer together than this are of one passage: where it is narrowest another look finds a little elsewhere
constexpr double borderline = 1.5;   // of keep: discs farther apart than this can be on two sides of a passage that another look finds open
constexpr double least_radius = 0.93; // of keep: as much narrower a passage may turn out to be than it was when it was found open; a limit, or the robot would creep into every notch

double squared(const glm::dvec2& v) { return v.x * v.x + v.y * v.y; }

}  // namespace

Surroundings::Surroundings(double keep) : keep_(keep), grain_(std::max(0.02, 0.12 * keep)), cells_(side * side, none) {}

std::uint16_t Surroundings::find(const glm::dvec2& position) const {
  const auto column = static_cast<std::int64_t>(std::floor(position.x / grain_)), row = static_cast<std::int64_t>(std::floor(position.y / grain_));
  std::uint16_t best = none;
  double least = grain_ * grain_;
  for (std::int64_t r = row - 1; r <= row + 1; ++r)
    for (std::int64_t c = column - 1; c <= column + 1; ++c)
      for (std::uint16_t i = cells_[slot(c, r)]; i != none; i = next_[i])
        if (const double d = squared(matter_[i].position - position); d < least) {
          least = d;
          best = i;
        }
  return best;
}

void Surroundings::place(std::uint16_t index) {
  const glm::dvec2& p = matter_[index].position;
  std::uint16_t& cell = cells_[slot(static_cast<std::int64_t>(std::floor(p.x / grain_)), static_cast<std::int64_t>(std::floor(p.y / grain_)))];
  next_[index] = cell;
  cell = index;
}

void Surroundings::unplace(std::uint16_t index) {
  const glm::dvec2& p = matter_[index].position;
  std::uint16_t* at = &cells_[slot(static_cast<std::int64_t>(std::floor(p.x / grain_)), static_cast<std::int64_t>(std::floor(p.y / grain_)))];
  while (*at != index) at = &next_[*at];
  *at = next_[index];
}

void Surroundings::take(const glm::dvec2& position, double time) {
  if (const std::uint16_t i = find(position); i != none) {
    Place& known = matter_[i];
    known.weight = std::min(known.weight + 1.0, most_weight);
    known.seen = time;
    const glm::dvec2 moved = known.position + (position - known.position) / known.weight;
    const bool same_cell = glm::floor(moved / grain_) == glm::floor(known.position / grain_);
    if (!same_cell) unplace(i);
    known.position = moved;
    if (!same_cell) place(i);
    return;
  }
  if (matter_.size() >= none) return;
  matter_.push_back({position, 1.0, time});
  next_.push_back(none);
  place(static_cast<std::uint16_t>(matter_.size() - 1));
}

void Surroundings::forget(double time, const glm::dvec2& robot) {
  const double far = 0.45 * static_cast<double>(side) * grain_;
  for (std::size_t i = 0; i < matter_.size();) {
    if (time - matter_[i].seen <= memory && squared(matter_[i].position - robot) < far * far) {
      ++i;
      continue;
    }
    unplace(static_cast<std::uint16_t>(i));
    const std::size_t last = matter_.size() - 1;
    if (i != last) {
      unplace(static_cast<std::uint16_t>(last));
      matter_[i] = matter_[last];
      place(static_cast<std::uint16_t>(i));
    }
    matter_.pop_back();
    next_.pop_back();
  }
}

void Surroundings::look(const Contour& contour, const BumperRing& bumpers, const Pose2& pose, double time, double reach) {
  const glm::dvec2& robot = pose.position;
  forget(time, robot);
  discs_.clear();
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  if (bumpers.any_pressed())
    for (const ContourPoint& point : contour) {
      if (!(point.distance <= reach) || (point.arc == no_arc && !bumpers.at(point.bearing).pressed)) continue;
      const glm::dvec2 at = robot + glm::dvec2(c * point.position.x - s * point.position.y, s * point.position.x + c * point.position.y);
      if (point.arc == no_arc) take(at, time);
      else discs_.push_back({at, keep_});
    }
  for (const Place& place : matter_)
    if (squared(place.position - robot) < reach * reach && !stray(place)) discs_.push_back({place.position, keep_});
  note_squeeze(robot);
  for (const glm::dvec2& place : been_) {
    if (squared(place - robot) > 4.0 * reach * reach) continue;
    for (GrownDisc& disc : discs_)
      if (const double square = squared(place - disc.centre); square < 1.03 * keep_ * keep_) disc.radius = std::min(disc.radius, std::max(least_radius * keep_, std::sqrt(square) - 0.01 * keep_));
  }
  for (const glm::dvec2& gate : shut_)
    if (squared(gate - robot) < reach * reach) discs_.push_back({gate, shut_radius * keep_, true});
}

bool Surroundings::stray(const Place& place) const {
  if (place.weight >= 3.0) return false;
  return std::any_of(matter_.begin(), matter_.end(), [&](const Place& other) { return other.weight >= 5.0 && squared(other.position - place.position) < 4.0 * grain_ * grain_; });
}

void Surroundings::note_squeeze(const glm::dvec2& robot) {
  // Matter close by on both sides: a passage, and the robot is in it.
  const double close = 1.15 * keep_;
  sides_.clear();
  for (const GrownDisc& disc : discs_) {
    const glm::dvec2 a = disc.centre - robot;
    if (const double square = squared(a); square <= close * close && square > 0.0) sides_.push_back(a / std::sqrt(square));
  }
  bool squeezed = false;
  for (std::size_t i = 1; i < sides_.size() && !squeezed; ++i)
    squeezed = std::any_of(sides_.begin(), sides_.begin() + static_cast<std::ptrdiff_t>(i), [&](const glm::dvec2& b) { return glm::dot(sides_[i], b) < -0.5; });
  if (!squeezed) return;
  const auto near = [&](double distance) { return [&robot, distance](const glm::dvec2& p) { return squared(p - robot) < distance * distance; }; };
  if (std::any_of(shut_.begin(), shut_.end(), near(0.4 * keep_)) || std::any_of(been_.begin(), been_.end(), near(0.06 * keep_))) return;
  been_.push_back(robot);
}

void Surroundings::shut(const GrownDisc& a, const GrownDisc& b) {
  if (glm::distance(a.centre, b.centre) < borderline * keep_ || a.gate || b.gate) return;
  const glm::dvec2 middle = 0.5 * (a.centre + b.centre);
  const auto within = [&](double distance) { return [&middle, distance](const glm::dvec2& p) { return squared(p - middle) < distance * distance; }; };
  // One gate a passage, for the robot could come to stand between two. Where it has been there is no gate.
  if (std::any_of(shut_.begin(), shut_.end(), within(one_passage * keep_)) || std::any_of(been_.begin(), been_.end(), within(0.3 * keep_))) return;
  shut_.push_back(middle);
}

}  // namespace thicket
